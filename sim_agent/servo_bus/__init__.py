"""Dynamixel servos that are not there: their registers, their bytes, their timing and their ways to fail."""

from sim_agent.servo_bus.bus import EmulatedBus, Reply
from sim_agent.servo_bus.servo import EmulatedServo

__all__ = ["EmulatedBus", "EmulatedServo", "Reply"]
