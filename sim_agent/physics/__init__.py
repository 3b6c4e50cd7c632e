"""Rigid bodies: PyBullet and what is read from it."""

from sim_agent.physics.contacts import ContactSensor
from sim_agent.physics.engine import RATE, Engine

__all__ = ["RATE", "ContactSensor", "Engine"]
