"""What every servo is asked each cycle, gathered by its indirect addresses into one block of 17 bytes.

The order is a check of its own. The last byte is known, and the two before it are nothing but the velocity's sign: an
answer from which bytes were lost, or into which some came, has them in another place. The CRC goes over the line low
byte first, so that against bursts which reach into it, it is weak; no value that is measured stands so near to it. The
one burst up to 16 bits that it misses elsewhere, 80 83 03 over three bytes, always meets a value that refuses it.

A servo that has lost power in between has lost its indirect addresses with it and answers zeros. Its id, which would
tell that too, is in EEPROM, and indirect addresses reach RAM alone (e-manual, MX-64(2.0) and MX-106(2.0)).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.servos.registers import (
    ANSWERS_ALL,
    BUS_WATCHDOG,
    COUNTS_PER_TURN,
    GOAL_CURRENT,
    GOAL_POSITION,
    HARDWARE_ERROR,
    INDIRECT_DATA,
    PRESENT_CURRENT,
    PRESENT_POSITION,
    PRESENT_TEMPERATURE,
    PRESENT_VELOCITY,
    PRESENT_VOLTAGE,
    STATUS_RETURN_LEVEL,
    TORQUE_ENABLE,
    Register,
)

READ: tuple[Register, ...] = (
    TORQUE_ENABLE,
    HARDWARE_ERROR,
    BUS_WATCHDOG,
    PRESENT_TEMPERATURE,
    PRESENT_VOLTAGE,
    PRESENT_CURRENT,
    PRESENT_POSITION,
    PRESENT_VELOCITY,
    STATUS_RETURN_LEVEL,
)
WRITTEN: tuple[Register, ...] = (GOAL_CURRENT, GOAL_POSITION)

READ_TYPE = np.dtype(
    [
        ("torque_on", "u1"),
        ("hardware_error", "u1"),
        ("watchdog", "i1"),
        ("temperature", "u1"),
        ("voltage", "<u2"),
        ("current", "<i2"),
        ("position", "<i4"),
        ("velocity", "<i4"),
        ("return_level", "u1"),
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
POSITIONS = (-COUNTS_PER_TURN, 2 * COUNTS_PER_TURN)
"""Of a joint within one turn, which a servo that counts turns may have begun a turn off."""


def indirect_addresses() -> bytes:
    """What to write to the indirect addresses so that the two blocks follow each other."""
    places = [register.address + byte for register in READ + WRITTEN for byte in range(register.size)]
    return np.array(places, dtype="<u2").tobytes()


def plausible(block: NDArray[np.void]) -> NDArray[np.bool_]:
    """Which blocks (n,) of READ_TYPE can be answers of servos that were made ready, as far as their values tell."""
    errors = np.uint8(sum(HARDWARE_ERRORS))
    result: NDArray[np.bool_] = (
        (block["return_level"] == ANSWERS_ALL)
        & (block["torque_on"] <= 1)
        & (block["hardware_error"] & ~errors == 0)
        & (block["watchdog"] >= -1)
        & (np.abs(block["current"].astype(np.int32)) <= HIGHEST_CURRENT)
        & (np.abs(block["velocity"].astype(np.int64)) <= HIGHEST_VELOCITY)
        & (block["position"] >= POSITIONS[0])
        & (block["position"] < POSITIONS[1])
        & (block["voltage"] >= VOLTAGES[0])
        & (block["voltage"] <= VOLTAGES[1])
        & (block["temperature"] <= HIGHEST_TEMPERATURE)
    )
    return result
