"""Makes one servo ready: the right model, settings that last, and the blocks of the cyclic exchange.

A servo that is already ready is left as it is, torque included: after a crash of this program the robot stands on
servos that hold, and goes on from there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from dynamixel_sdk import COMM_SUCCESS, Protocol2PacketHandler

from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.servos.health_block import HARDWARE_ERRORS, indirect_addresses
from robot_agent.hardware.servos.packet import ALERT
from robot_agent.hardware.servos.port import PortLostError
from robot_agent.hardware.servos.registers import Model, Register
from weaver_shared.clock import Clock
from weaver_shared.errors import ResourceError

TRIES = 8
REBOOT_NS = 600_000_000
LATE_MS = 50.0
SNAPSHOT = r.PRESENT_TEMPERATURE.address + 1
"""Bytes of the control table from its beginning to the last reading."""
ANYTHING = 1024
"""Bytes, more than an answer has."""
OPERATING_MODES = {"position": 3, "current_position": 5}
SHUTDOWN_MASK = 52
"""Overload, electrical shock, overheating: the factory's."""

_sdk = Protocol2PacketHandler()


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """What a servo has to be: `stops` are the least and greatest count of its joint."""

    joint: str
    id: int
    model: Model
    stops: tuple[int, int]
    operating_mode: int


class Preparation:
    """Talks to one servo at a time through the SDK, on one of its ports.

    Raises ResourceError that names the joint and says what to do.
    """

    def __init__(self, port: Any, place: Place) -> None:
        self._port = port
        self._place = place

    def run(self) -> None:
        found = self.look()
        self._check(found)
        self._settle_eeprom(found)
        if found(r.STATUS_RETURN_LEVEL) != r.ANSWERS_ALL:
            self.write(r.STATUS_RETURN_LEVEL, r.ANSWERS_ALL)
        if found(r.BUS_WATCHDOG):
            # A tripped watchdog holds the goals fast; the servo stays where it stopped.
            self.write(r.BUS_WATCHDOG, 0)
        if found(r.TORQUE_ENABLE):
            self.write(r.GOAL_POSITION, found(r.PRESENT_POSITION))
        self._gather_blocks()

    def reboot(self, clock: Clock) -> None:
        """The only way out of a shutdown; waits until the servo is back."""
        self.begin_reboot()
        clock.sleep_until(clock.now_ns() + REBOOT_NS)

    def begin_reboot(self) -> None:
        """It will not answer for a while, and then have lost its settings."""
        self._tried(lambda: (0, *_sdk.reboot(self._port, self._place.id)))

    def write(self, register: Register, value: int) -> None:
        send = {1: _sdk.write1ByteTxRx, 2: _sdk.write2ByteTxRx, 4: _sdk.write4ByteTxRx}[register.size]
        raw = value & (1 << 8 * register.size) - 1
        self._obeyed(lambda: send(self._port, self._place.id, register.address, raw), value, register.address)

    def look(self) -> Callable[[Register], int]:
        """Value by register, all of them read at once; nothing is written."""
        servo, port = self._place.id, self._port
        raw, _ = self._tried(lambda: _sdk.readTxRx(port, servo, 0, SNAPSHOT))
        table = bytes(raw)

        def value(register: Register) -> int:
            part = table[register.address : register.address + register.size]
            return int.from_bytes(part, "little", signed=register.signed or register is r.PRESENT_POSITION)

        return value

    def _check(self, found: Callable[[Register], int]) -> None:
        model, expected = found(r.MODEL_NUMBER), self._place.model
        if model != expected.number:
            known = r.MODELS.get(model)
            name = known.name if known else f"model {model}"
            raise self._trouble(f"is {name} where the robot has {expected.name}: check the wiring file and the ids")
        if found(r.FIRMWARE) < r.LEAST_FIRMWARE:
            raise self._trouble(f"has firmware {found(r.FIRMWARE)}; update it to {r.LEAST_FIRMWARE} or newer")
        if errors := found(r.HARDWARE_ERROR):
            names = ", ".join(name for bit, name in HARDWARE_ERRORS.items() if errors & bit)
            raise self._trouble(f"reports {names or errors}: let it cool or free it, then reboot it")

    def _settle_eeprom(self, found: Callable[[Register], int]) -> None:
        least, greatest = self._place.stops
        wanted = {
            r.RETURN_DELAY: 0,
            r.DRIVE_MODE: 0,
            r.OPERATING_MODE: self._place.operating_mode,
            r.HOMING_OFFSET: 0,
            r.CURRENT_LIMIT: self._place.model.current_limit,
            r.MAX_POSITION: greatest,
            r.MIN_POSITION: least,
            r.SHUTDOWN: SHUTDOWN_MASK,
        }
        wrong = {register: value for register, value in wanted.items() if found(register) != value}
        if wrong and found(r.TORQUE_ENABLE):
            raise self._trouble("has other settings and holds with torque: let the robot down and switch it off first")
        for register, value in wrong.items():
            self.write(register, value)

    def _gather_blocks(self) -> None:
        places = list(indirect_addresses())
        servo, port = self._place.id, self._port
        found, _ = self._tried(lambda: _sdk.readTxRx(port, servo, r.INDIRECT_ADDRESSES, len(places)))
        if list(found) != places:
            self._obeyed(
                lambda: _sdk.writeTxRx(port, servo, r.INDIRECT_ADDRESSES, len(places), places),
                "the places of its answer",
                r.INDIRECT_ADDRESSES,
            )

    def _obeyed(self, tell: Callable[[], tuple[int, int]], value: object, address: int) -> None:
        _, error = self._tried(lambda: (0, *tell()))
        if error & ~ALERT:
            raise self._trouble(f"refuses {value} at address {address} (error {error & ~ALERT})")

    def _tried(self, ask: Callable[[], tuple[Any, int, int]]) -> tuple[Any, int]:
        """Value and error byte of a question, asked again when no sound answer came."""
        try:
            for _ in range(TRIES):
                value, result, error = ask()
                if result == COMM_SUCCESS:
                    return value, error
                self._let_pass()
        except PortLostError as error:
            self._port.is_using = False
            raise self._trouble(f"can not be asked: {error}") from error
        raise self._trouble("does not answer: check its cable, its id and its baud rate")

    def _let_pass(self) -> None:
        """An answer that comes late must not be taken for that of the next question: the SDK could not tell."""
        self._port.setPacketTimeoutMillis(LATE_MS)
        while not self._port.isPacketTimeout():
            self._port.readPort(ANYTHING)

    def _trouble(self, what: str) -> ResourceError:
        return ResourceError(f"servo {self._place.id} of {self._place.joint} on {self._port.port_name} {what}")
