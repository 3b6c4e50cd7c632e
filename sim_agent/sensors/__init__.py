"""Sensors that feel rather than see."""

from sim_agent.sensors.inertial import InertialSensor

__all__ = ["InertialSensor"]
