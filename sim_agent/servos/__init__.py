"""Servos and the power that feeds them."""

from sim_agent.servos.bank import ServoBank, encoder_position, encoder_velocity
from sim_agent.servos.battery import Battery

__all__ = ["Battery", "ServoBank", "encoder_position", "encoder_velocity"]
