"""One emulated servo: what it is told, what it feels, its watchdog, its shutdowns and its restarts."""

from __future__ import annotations

from dataclasses import dataclass

from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.servos.packet import ALERT, Fault
from robot_agent.hardware.servos.registers import Model
from sim_agent.servo_bus.control_table import POSITION_MODE, ControlTable

FIRMWARE = 45
REBOOT_NS = 300_000_000
"""How long a servo is deaf after a reboot (assumed)."""
OVERHEATED, OVERLOADED = 4, 32
_NS = 1_000_000_000
_CURRENT_MODES = (0, 5)
_POSITION_MODES = (POSITION_MODE, 4, 5)


@dataclass(frozen=True, slots=True)
class Order:
    """What a servo tries to do, in its own counts and units turned to SI."""

    torque_on: bool
    position: float  # rad from the middle of its turn
    current_limit: float  # A


class EmulatedServo:
    """The face of a servo on the bus. What turns it is elsewhere and calls `feel`; time comes with every call."""

    def __init__(self, servo: int, model: Model, *, firmware: int = FIRMWARE) -> None:
        self.table = ControlTable(servo, model, firmware)
        self.alive = True
        """False: unplugged, or dead."""
        self.temperature = 25.0  # degrees Celsius
        self.voltage = 14.8
        self.slipped = 0
        """Counts by which the encoder is wrong."""
        self.jammed_at: float | None = None
        """Where something holds the shaft fast, rad from the middle."""
        self._deaf_until_ns = 0
        self._fed_ns = 0
        self._started_ns = 0
        self._registered: tuple[int, bytes] | None = None
        self._position = 0.0

    @property
    def id(self) -> int:
        return self.table[r.ID]

    def order(self) -> Order:
        table = self.table
        limit = table[r.CURRENT_LIMIT]
        if table[r.OPERATING_MODE] in _CURRENT_MODES:
            limit = min(limit, abs(table[r.GOAL_CURRENT]))
        if self.jammed_at is not None:
            return Order(torque_on=True, position=self.jammed_at, current_limit=table[r.CURRENT_LIMIT] * r.CURRENT_UNIT)
        return Order(
            torque_on=bool(table[r.TORQUE_ENABLE]),
            position=(table[r.GOAL_POSITION] - r.CENTRE) * r.RAD_PER_COUNT,
            current_limit=limit * r.CURRENT_UNIT,
        )

    def start_at(self, position: float) -> None:
        """Power comes on with the shaft at `position` (rad from the middle): the goal is where it is."""
        self.feel(position=position, velocity=0.0, current=0.0)
        self.table[r.GOAL_POSITION] = self.table[r.PRESENT_POSITION]

    def feel(self, *, position: float, velocity: float, current: float) -> None:
        """Where the shaft is (rad from the middle), how it moves (rad/s) and what the motor draws (A)."""
        table = self.table
        self._position = position
        table[r.PRESENT_POSITION] = round(position / r.RAD_PER_COUNT) + r.CENTRE + self.slipped
        table[r.PRESENT_VELOCITY] = round(velocity / r.VELOCITY_UNIT)
        table[r.PRESENT_CURRENT] = self._pushing() if self.jammed_at is not None else round(current / r.CURRENT_UNIT)
        table[r.MOVING] = int(abs(table[r.PRESENT_VELOCITY]) > table[r.MOVING_THRESHOLD])

    def jam(self) -> None:
        """From now on something holds the shaft where it is."""
        self.jammed_at = self._position

    def _pushing(self) -> int:
        """Current units of a motor that pulls at a jammed shaft, all that it may from 20 degrees on."""
        table = self.table
        error = table[r.GOAL_POSITION] - table[r.PRESENT_POSITION]
        limit = min(table[r.CURRENT_LIMIT], abs(table[r.GOAL_CURRENT])) if table[r.TORQUE_ENABLE] else 0
        return max(min(error * limit // 228, limit), -limit)

    def elapse(self, now_ns: int) -> None:
        """Let the time up to `now_ns` pass: the clock, the watchdog, heat and voltage."""
        table = self.table
        table[r.REALTIME_TICK] = (now_ns - self._started_ns) // 1_000_000 % 32768
        table[r.PRESENT_VOLTAGE] = round(self.voltage / r.VOLTAGE_UNIT)
        table[r.PRESENT_TEMPERATURE] = round(self.temperature)
        if self.temperature > table[r.TEMPERATURE_LIMIT] and not table[r.HARDWARE_ERROR] & OVERHEATED:
            self.fail(OVERHEATED)
        watchdog = table[r.BUS_WATCHDOG]
        if watchdog > 0 and table[r.TORQUE_ENABLE] and now_ns - self._fed_ns > watchdog * r.WATCHDOG_UNIT * _NS:
            # It brakes and keeps its torque: the goal is where it stopped.
            table[r.BUS_WATCHDOG] = r.WATCHDOG_TRIPPED
            table[r.GOAL_POSITION] = table[r.PRESENT_POSITION]

    def fed(self, now_ns: int) -> None:
        """An instruction packet was on the bus."""
        self._fed_ns = now_ns

    def hears(self, now_ns: int) -> bool:
        return self.alive and now_ns >= self._deaf_until_ns

    def fail(self, bit: int) -> None:
        """Raise a hardware error (bit of the register); the shutdown mask decides whether torque goes."""
        self.table[r.HARDWARE_ERROR] |= bit
        if bit & self.table[r.SHUTDOWN]:
            self.table[r.TORQUE_ENABLE] = 0

    def restart(self, now_ns: int) -> None:
        """Reboot, or lose power for a moment: RAM is the factory's again, torque is off, a while of silence."""
        self.table.power_up()
        self._started_ns = now_ns
        self._registered = None
        self._deaf_until_ns = now_ns + REBOOT_NS
        self.start_at(self._position)

    def error(self, fault: Fault = Fault.NONE) -> int:
        """The error byte of a status packet."""
        return fault | (ALERT if self.table[r.HARDWARE_ERROR] else 0)

    def answers(self, *, reading: bool) -> bool:
        """Whether its status return level lets it answer a read, or anything else but a ping."""
        return self.table[r.STATUS_RETURN_LEVEL] >= (1 if reading else 2)

    def read(self, address: int, length: int) -> tuple[Fault, bytes]:
        return self.table.read(address, length)

    def write(self, address: int, data: bytes) -> Fault:
        mode, torque = self.table[r.OPERATING_MODE], self.table[r.TORQUE_ENABLE]
        fault, written = self.table.write(address, data)
        if r.TORQUE_ENABLE in written and self.table[r.HARDWARE_ERROR] & self.table[r.SHUTDOWN]:
            self.table[r.TORQUE_ENABLE] = 0
            return Fault.RESULT_FAIL
        if r.OPERATING_MODE in written and self.table[r.OPERATING_MODE] != mode:
            self.table.reset_goals()
            if self.table[r.OPERATING_MODE] in _POSITION_MODES:
                self.table[r.GOAL_POSITION] = self.table[r.PRESENT_POSITION]
        if r.TORQUE_ENABLE in written and self.table[r.TORQUE_ENABLE] and not torque:
            self._position_within_a_turn()
        return fault

    def register_write(self, parameters: bytes) -> Fault:
        self._registered = (int.from_bytes(parameters[:2], "little"), parameters[2:])
        self.table[r.REGISTERED] = 1
        return Fault.NONE

    def act(self) -> Fault:
        if self._registered is None:
            return Fault.INSTRUCTION
        (address, data), self._registered = self._registered, None
        self.table[r.REGISTERED] = 0
        return self.write(address, data)

    def clear(self, parameters: bytes) -> Fault:
        """Forget whole turns; only standing still (e-manual)."""
        if parameters != b"\x01\x44\x58\x4c\x22":
            return Fault.INSTRUCTION
        if self.table[r.MOVING]:
            return Fault.RESULT_FAIL
        self._position_within_a_turn()
        return Fault.NONE

    def factory_reset(self, option: int, now_ns: int) -> Fault:
        if option not in (0x01, 0x02, 0xFF):
            return Fault.DATA_RANGE
        kept = {0x01: (r.ID,), 0x02: (r.ID, r.BAUD_RATE), 0xFF: ()}[option]
        values = [(register, self.table[register]) for register in kept]
        self.table.factory_reset()
        for register, value in values:
            self.table[register] = value
        self.restart(now_ns)
        return Fault.NONE

    def _position_within_a_turn(self) -> None:
        if self.table[r.OPERATING_MODE] == POSITION_MODE:
            self.table[r.PRESENT_POSITION] = self.table[r.PRESENT_POSITION] % r.COUNTS_PER_TURN
