"""Registers of MX-64 and MX-106 servos with Protocol 2.0, and their units (e-manual, MX-64(2.0) and MX-106(2.0))."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

COUNTS_PER_TURN = 4096
RAD_PER_COUNT = 2.0 * pi / COUNTS_PER_TURN
CENTRE = 2048
"""Counts at the middle of the servo's turn."""
CURRENT_UNIT = 3.36e-3  # A
VELOCITY_UNIT = 0.229 * 2.0 * pi / 60.0  # rad/s
VOLTAGE_UNIT = 0.1  # V
WATCHDOG_UNIT = 0.020  # s
RETURN_DELAY_UNIT = 2e-6  # s
WATCHDOG_TRIPPED = -1
ANSWERS_ALL = 2
"""Status return level with which a servo answers every instruction; any power-up makes it so."""
RAM_BEGINS = 64
"""Registers below keep their values without power and can not be written while torque is on."""
FACTORY_RETURN_DELAY = 250
LEAST_FIRMWARE = 42
"""Below 39 the servo speaks Protocol 1.0, below 38 it has no bus watchdog, below 42 no clear instruction."""


@dataclass(frozen=True, slots=True, eq=False)
class Register:
    """One entry of the control table; there is one object for each, so they are told apart by identity."""

    address: int
    size: int
    writable: bool = False
    lowest: int | None = None  # where the manual states a range; also tells that the value has a sign
    highest: int | None = None
    default: int = 0

    @property
    def signed(self) -> bool:
        return self.lowest is not None and self.lowest < 0


@dataclass(frozen=True, slots=True)
class Model:
    """What differs from servo to servo."""

    name: str
    number: int
    current_limit: int  # highest and factory value, 3.36 mA
    velocity_limit: int  # factory value, 0.229 rpm


MODELS = {
    model.number: model
    for model in (
        Model(name="MX-64", number=311, current_limit=1941, velocity_limit=435),
        Model(name="MX-106", number=321, current_limit=2047, velocity_limit=360),
    )
}

BAUD_RATES = (9600, 57_600, 115_200, 1_000_000, 2_000_000, 3_000_000, 4_000_000, 4_500_000)
"""bit/s by the value of the register."""

MODEL_NUMBER = Register(0, 2)
FIRMWARE = Register(6, 1)
ID = Register(7, 1, True, 0, 252, 1)
BAUD_RATE = Register(8, 1, True, 0, 7, 1)
RETURN_DELAY = Register(9, 1, True, 0, 254, FACTORY_RETURN_DELAY)
DRIVE_MODE = Register(10, 1, True, 0, 13)
OPERATING_MODE = Register(11, 1, True, 0, 16, 3)
SHADOW_ID = Register(12, 1, True, 0, 255, 255)
PROTOCOL = Register(13, 1, True, 1, 2, 2)
HOMING_OFFSET = Register(20, 4, True, -1_044_479, 1_044_479)
MOVING_THRESHOLD = Register(24, 4, True, 0, 1023, 10)
TEMPERATURE_LIMIT = Register(31, 1, True, 0, 100, 80)
MAX_VOLTAGE = Register(32, 2, True, 95, 160, 160)
MIN_VOLTAGE = Register(34, 2, True, 95, 160, 95)
PWM_LIMIT = Register(36, 2, True, 0, 885, 885)
CURRENT_LIMIT = Register(38, 2, True, 0, 2047, 2047)
ACCELERATION_LIMIT = Register(40, 4, True, 0, 32767, 32767)
VELOCITY_LIMIT = Register(44, 4, True, 0, 1023, 360)
MAX_POSITION = Register(48, 4, True, 0, 4095, 4095)
MIN_POSITION = Register(52, 4, True, 0, 4095, 0)
SHUTDOWN = Register(63, 1, True, 0, 255, 52)
TORQUE_ENABLE = Register(64, 1, True, 0, 1)
LED = Register(65, 1, True, 0, 1)
STATUS_RETURN_LEVEL = Register(68, 1, True, 0, 2, ANSWERS_ALL)
REGISTERED = Register(69, 1)
HARDWARE_ERROR = Register(70, 1)
VELOCITY_I_GAIN = Register(76, 2, True, 0, 16383, 1920)
VELOCITY_P_GAIN = Register(78, 2, True, 0, 16383, 100)
POSITION_D_GAIN = Register(80, 2, True, 0, 16383)
POSITION_I_GAIN = Register(82, 2, True, 0, 16383)
POSITION_P_GAIN = Register(84, 2, True, 0, 16383, 850)
FEEDFORWARD_2 = Register(88, 2, True, 0, 16383)
FEEDFORWARD_1 = Register(90, 2, True, 0, 16383)
BUS_WATCHDOG = Register(98, 1, True, -1, 127)
GOAL_PWM = Register(100, 2, True, -885, 885, 885)
GOAL_CURRENT = Register(102, 2, True, -2047, 2047, 2047)
GOAL_VELOCITY = Register(104, 4, True, -1023, 1023)
PROFILE_ACCELERATION = Register(108, 4, True, 0, 32767)
PROFILE_VELOCITY = Register(112, 4, True, 0, 32767)
GOAL_POSITION = Register(116, 4, True, -1_048_575, 1_048_575)
REALTIME_TICK = Register(120, 2)
MOVING = Register(122, 1)
MOVING_STATUS = Register(123, 1)
PRESENT_PWM = Register(124, 2)
PRESENT_CURRENT = Register(126, 2)
PRESENT_VELOCITY = Register(128, 4)
PRESENT_POSITION = Register(132, 4)
VELOCITY_TRAJECTORY = Register(136, 4)
POSITION_TRAJECTORY = Register(140, 4)
PRESENT_VOLTAGE = Register(144, 2)
PRESENT_TEMPERATURE = Register(146, 1)

INDIRECT_ADDRESSES = 168
"""Address of the first of 28 registers (2 bytes each) that say which byte of RAM those at INDIRECT_DATA show."""
INDIRECT_DATA = 224
INDIRECT_COUNT = 28
"""Of each of the two banks."""
INDIRECT_ADDRESSES_2 = 578
INDIRECT_DATA_2 = 634
END = 662
"""Of the control table."""

REGISTERS = tuple(value for value in list(globals().values()) if isinstance(value, Register))
