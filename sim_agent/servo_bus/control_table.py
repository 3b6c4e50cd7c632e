"""A servo's memory and who may read and write what of it (e-manual, MX-64(2.0) and MX-106(2.0))."""

from __future__ import annotations

from dataclasses import dataclass
from struct import Struct

from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.servos.packet import Fault
from robot_agent.hardware.servos.registers import REGISTERS, Model, Register

GOALS = (r.GOAL_PWM, r.GOAL_CURRENT, r.GOAL_VELOCITY, r.GOAL_POSITION)
POSITION_MODE = 3
_SIGNED_READINGS = frozenset(
    {r.PRESENT_PWM, r.PRESENT_CURRENT, r.PRESENT_VELOCITY, r.PRESENT_POSITION, r.VELOCITY_TRAJECTORY}
)
_FORMATS = {
    register: Struct("<" + ("bhi" if register.signed or register in _SIGNED_READINGS else "BHI")[register.size // 2])
    for register in REGISTERS
}
_BEGINS = {register.address: register for register in REGISTERS}
_COVERED = {register.address + byte for register in REGISTERS for byte in range(register.size)}
_BANKS = (
    (r.INDIRECT_ADDRESSES, r.INDIRECT_DATA),
    (r.INDIRECT_ADDRESSES_2, r.INDIRECT_DATA_2),
)


@dataclass(frozen=True, slots=True)
class _Plan:
    """What a write of so many bytes to an address touches: the same as long as indirect addresses stay."""

    cells: list[int]
    registers: list[Register]
    places: list[list[int]]  # of each register's bytes among those written
    points: bool  # it sets indirect addresses
    fault: Fault  # of its shape, whatever the values


class ControlTable:
    """Values by register. EEPROM is what `factory_reset` makes it; RAM begins anew with every `power_up`."""

    def __init__(self, servo: int, model: Model, firmware: int) -> None:
        self.model = model
        self._firmware = firmware
        self._bytes = bytearray(r.END)
        self._meant = list(range(r.END))
        self._plans: dict[tuple[int, int], _Plan] = {}
        self.factory_reset()
        self[r.ID] = servo

    def __getitem__(self, register: Register) -> int:
        value: int = _FORMATS[register].unpack_from(self._bytes, register.address)[0]
        return value

    def __setitem__(self, register: Register, value: int) -> None:
        """Set from inside the servo: no rule applies."""
        _FORMATS[register].pack_into(self._bytes, register.address, value)

    def factory_reset(self) -> None:
        for register in REGISTERS:
            if register.address < r.RAM_BEGINS:
                self[register] = register.default
        self[r.MODEL_NUMBER] = self.model.number
        self[r.FIRMWARE] = self._firmware
        self[r.CURRENT_LIMIT] = self.model.current_limit
        self[r.VELOCITY_LIMIT] = self.model.velocity_limit
        self.power_up()

    def power_up(self) -> None:
        """RAM as after switching on: gains, goals and indirect addresses are the factory's again."""
        self._bytes[r.RAM_BEGINS :] = bytes(r.END - r.RAM_BEGINS)
        for register in REGISTERS:
            if register.address >= r.RAM_BEGINS:
                self[register] = register.default
        self.reset_goals()
        for addresses, data in _BANKS:
            for index in range(r.INDIRECT_COUNT):
                place = addresses + 2 * index
                self._bytes[place : place + 2] = (data + index).to_bytes(2, "little")
        self._point()

    def reset_goals(self) -> None:
        """Gains, profile and goals as a change of the operating mode leaves them."""
        for register in (r.POSITION_D_GAIN, r.POSITION_I_GAIN, r.POSITION_P_GAIN, r.FEEDFORWARD_1, r.FEEDFORWARD_2):
            self[register] = register.default
        self[r.PROFILE_ACCELERATION] = self[r.PROFILE_VELOCITY] = 0
        self[r.GOAL_PWM] = self[r.PWM_LIMIT]
        self[r.GOAL_CURRENT] = self[r.CURRENT_LIMIT]
        self[r.GOAL_VELOCITY] = 0

    def read(self, address: int, length: int) -> tuple[Fault, bytes]:
        if length == 0 or address + length > r.END:
            return Fault.ACCESS, b""
        if address + length <= r.INDIRECT_DATA:
            return Fault.NONE, bytes(self._bytes[address : address + length])
        return Fault.NONE, bytes(self._bytes[place] for place in self._meant[address : address + length])

    def write(self, address: int, data: bytes) -> tuple[Fault, list[Register]]:
        """Write all of it or nothing; returns the registers that were written."""
        if not data or address + len(data) > r.END:
            return Fault.ACCESS, []
        plan = self._plans.get((address, len(data)))
        if plan is None:
            plan = self._plans[address, len(data)] = _plan(self._meant[address : address + len(data)])
        if plan.points:
            if not self._reaches_ram(plan, data):
                return Fault.DATA_RANGE, []
            self._store(plan, data)
            self._point()
            return Fault.NONE, []
        fault = plan.fault or self._fault_of_values(plan, data)
        if fault is Fault.NONE:
            self._store(plan, data)
        return fault, plan.registers

    def _fault_of_values(self, plan: _Plan, data: bytes) -> Fault:
        for register, places in zip(plan.registers, plan.places, strict=True):
            raw = bytes([data[place] for place in places])
            fault = self._fault_of_value(register, int.from_bytes(raw, "little", signed=register.signed))
            if fault is not Fault.NONE:
                return fault
        return Fault.NONE

    def _fault_of_value(self, register: Register, value: int) -> Fault:
        locked = register.address < r.RAM_BEGINS and self[r.TORQUE_ENABLE]
        if not register.writable or locked:
            return Fault.ACCESS
        if register in GOALS and self[r.BUS_WATCHDOG] == r.WATCHDOG_TRIPPED:
            return Fault.DATA_RANGE
        if register.lowest is None or register.highest is None or not register.lowest <= value <= register.highest:
            return Fault.DATA_RANGE
        lowest, highest = self._limits(register)
        return Fault.NONE if lowest <= value <= highest else Fault.DATA_LIMIT

    def _limits(self, register: Register) -> tuple[int, int]:
        """What the limits in EEPROM allow, within the register's range."""
        if register is r.GOAL_POSITION and self[r.OPERATING_MODE] == POSITION_MODE:
            return self[r.MIN_POSITION], self[r.MAX_POSITION]
        for goal, limit in (
            (r.GOAL_CURRENT, r.CURRENT_LIMIT),
            (r.GOAL_VELOCITY, r.VELOCITY_LIMIT),
            (r.GOAL_PWM, r.PWM_LIMIT),
        ):
            if register is goal:
                return -self[limit], self[limit]
        highest = self.model.current_limit if register is r.CURRENT_LIMIT else register.highest
        return register.lowest or 0, highest or 0

    def _reaches_ram(self, plan: _Plan, data: bytes) -> bool:
        """Indirect addresses range from 64 to 661: EEPROM can not be shown elsewhere (e-manual)."""
        written = dict(zip(plan.cells, data, strict=True))
        for low in {cell & ~1 for cell in plan.cells}:
            target = written.get(low, self._bytes[low]) | written.get(low + 1, self._bytes[low + 1]) << 8
            if not r.RAM_BEGINS <= target < r.END:
                return False
        return True

    def _store(self, plan: _Plan, data: bytes) -> None:
        for cell, value in zip(plan.cells, data, strict=True):
            self._bytes[cell] = value

    def _point(self) -> None:
        """Find the byte that each indirect one stands for: itself when it points at no direct one."""
        self._plans.clear()
        for addresses, data in _BANKS:
            for index in range(r.INDIRECT_COUNT):
                at = addresses + 2 * index
                target = int.from_bytes(self._bytes[at : at + 2], "little")
                self._meant[data + index] = target if target < r.INDIRECT_ADDRESSES else data + index


def _plan(cells: list[int]) -> _Plan:
    registers = [_BEGINS[cell] for cell in sorted(set(cells)) if cell in _BEGINS]
    whole = [[register.address + byte for byte in range(register.size)] for register in registers]
    fault = Fault.NONE
    if any(cell not in _COVERED for cell in cells):
        fault = Fault.ACCESS
    elif {cell for register in whole for cell in register} != set(cells):
        fault = Fault.DATA_LENGTH
    # Of a cell that is written twice the last value stays.
    last = {cell: place for place, cell in enumerate(cells)}
    places = [[last[cell] for cell in register] for register in whole] if fault is Fault.NONE else []
    return _Plan(cells, registers, places, all(_is_indirect_address(cell) for cell in cells), fault)


def _is_indirect_address(cell: int) -> bool:
    return any(addresses <= cell < addresses + 2 * r.INDIRECT_COUNT for addresses, _ in _BANKS)
