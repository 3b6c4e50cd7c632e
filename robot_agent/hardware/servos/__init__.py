"""Dynamixel servos: their bytes, their registers and the buses they hang on."""
