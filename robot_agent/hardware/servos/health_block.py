"""What every servo is asked each cycle, gathered by its indirect addresses into one block of 17 bytes.

The servo's own id comes first. A servo that has lost power in between has lost its indirect addresses with it and
answers zeros: without the id that would pass for a joint at its lower stop.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.servos.registers import (
    BUS_WATCHDOG,
    GOAL_CURRENT,
    GOAL_POSITION,
    HARDWARE_ERROR,
    ID,
    INDIRECT_DATA,
    PRESENT_CURRENT,
    PRESENT_POSITION,
    PRESENT_TEMPERATURE,
    PRESENT_VELOCITY,
    PRESENT_VOLTAGE,
    TORQUE_ENABLE,
    Register,
)

READ: tuple[Register, ...] = (
    ID,
    TORQUE_ENABLE,
    HARDWARE_ERROR,
    BUS_WATCHDOG,
    PRESENT_CURRENT,
    PRESENT_VELOCITY,
    PRESENT_POSITION,
    PRESENT_VOLTAGE,
    PRESENT_TEMPERATURE,
)
WRITTEN: tuple[Register, ...] = (GOAL_CURRENT, GOAL_POSITION)

READ_TYPE = np.dtype(
    [
        ("id", "u1"),
        ("torque_on", "u1"),
        ("hardware_error", "u1"),
        ("watchdog", "i1"),
        ("current", "<i2"),
        ("velocity", "<i4"),
        ("position", "<i4"),
        ("voltage", "<u2"),
        ("temperature", "u1"),
    ]
)
WRITTEN_TYPE = np.dtype([("current", "<i2"), ("position", "<i4")])

READ_ADDRESS = INDIRECT_DATA
WRITTEN_ADDRESS = INDIRECT_DATA + READ_TYPE.itemsize

HARDWARE_ERRORS = {1: "voltage", 4: "overheating", 8: "encoder", 16: "electrical shock", 32: "overload"}
HIGHEST_CURRENT = 2500  # 3.36 mA; stall of an MX-106 at 14.8 V is 1950
HIGHEST_VELOCITY = 1023  # 0.229 rpm
VOLTAGES = (50, 250)  # 0.1 V; a servo outside has no power to answer with
HIGHEST_TEMPERATURE = 125  # degrees Celsius


def indirect_addresses() -> bytes:
    """What to write to the indirect addresses so that the two blocks follow each other."""
    places = [register.address + byte for register in READ + WRITTEN for byte in range(register.size)]
    return np.array(places, dtype="<u2").tobytes()


def plausible(block: NDArray[np.void], ids: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Which blocks (n,) of READ_TYPE can be the answers of the servos `ids` (n,) as far as their values tell."""
    errors = np.uint8(sum(HARDWARE_ERRORS))
    result: NDArray[np.bool_] = (
        (block["id"] == ids)
        & (block["torque_on"] <= 1)
        & (block["hardware_error"] & ~errors == 0)
        & (block["watchdog"] >= -1)
        & (np.abs(block["current"].astype(np.int32)) <= HIGHEST_CURRENT)
        & (np.abs(block["velocity"].astype(np.int64)) <= HIGHEST_VELOCITY)
        & (block["voltage"] >= VOLTAGES[0])
        & (block["voltage"] <= VOLTAGES[1])
        & (block["temperature"] <= HIGHEST_TEMPERATURE)
    )
    return result
