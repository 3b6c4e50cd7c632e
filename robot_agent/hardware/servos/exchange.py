"""The cyclic talk with all servos: every bus is asked before the first answer is awaited, one thread for all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.servos.group_answer import GroupAnswer
from robot_agent.hardware.servos.health_block import READ_ADDRESS, READ_TYPE, WRITTEN_ADDRESS, plausible
from robot_agent.hardware.servos.packet import BROADCAST, STATUS_OVERHEAD, Instruction, encode
from robot_agent.hardware.servos.port import LineClock, PortLostError, ServoPort

_TURN_ROUND = 60e-6
"""s a servo takes before it answers, generously."""


class BusExchange:
    """One bus. `joints` are the places of its servos in the body's arrays, `ids` their ids in the same order."""

    def __init__(self, port: ServoPort, ids: Sequence[int], joints: NDArray[np.int64], *, baud: int) -> None:
        self.port = port
        self.joints = joints
        self.up = True
        """False: the port was lost, and nothing is asked until it is opened again."""
        self._ids = list(ids)
        self._id_bytes = np.array(self._ids, dtype=np.uint8)
        self._baud = baud
        self.late = False
        """Answers to the question before this one came when nobody waited for them any more."""
        self.least_duration = self.duration = 0.0
        """s that question and answers take on the wire at the least, and with what the servos may wait in between."""
        self.asked = np.arange(len(ids))
        """Which of the bus's servos are asked; those that are lost are not waited for."""
        self.group = GroupAnswer([], READ_TYPE.itemsize)
        self._request = b""
        self.ask_only(np.ones(len(ids), dtype=np.bool_))

    def ask_only(self, wanted: NDArray[np.bool_]) -> None:
        """From now on ask these of the bus's servos."""
        asked = np.flatnonzero(wanted)
        if self._request and np.array_equal(asked, self.asked):
            return
        self.asked = asked
        ids = [self._ids[rank] for rank in asked]
        self.group = GroupAnswer(ids, READ_TYPE.itemsize)
        block = READ_ADDRESS.to_bytes(2, "little") + READ_TYPE.itemsize.to_bytes(2, "little")
        self._request = encode(BROADCAST, Instruction.SYNC_READ, block + bytes(ids))
        answers = len(ids) * (STATUS_OVERHEAD + READ_TYPE.itemsize)
        self.least_duration = (len(self._request) + answers) * 10.0 / self._baud
        self.duration = self.least_duration + len(ids) * (_TURN_ROUND + 2 * 10.0 / self._baud)

    def ask(self) -> None:
        self.late = self.waiting and bool(self._overdue())
        self.group.begin()
        self._guarded(self._request)

    def take(self) -> None:
        if self.up:
            try:
                self.group.feed(self.port.receive())
            except PortLostError:
                self.up = False

    def _overdue(self) -> bytes:
        try:
            return self.port.receive()
        except PortLostError:
            self.up = False
            return b""

    @property
    def waiting(self) -> bool:
        return self.up and not self.group.complete

    def tell(self, address: int, values: NDArray[np.generic], ranks: NDArray[np.int64]) -> None:
        """Write `values` (ranks,) to a register of several servos; nothing comes back."""
        size = values.dtype.itemsize
        parts = np.empty((len(ranks), 1 + size), dtype=np.uint8)
        parts[:, 0] = self._id_bytes[ranks]
        parts[:, 1:] = np.frombuffer(values.tobytes(), dtype=np.uint8).reshape(-1, size)
        message = address.to_bytes(2, "little") + size.to_bytes(2, "little")
        self._guarded(encode(BROADCAST, Instruction.SYNC_WRITE, message + parts.tobytes()))

    def tell_goals(self, goals: NDArray[np.void]) -> None:
        """Write goals of WRITTEN_TYPE (servos of the bus,) to all of them."""
        self.tell(WRITTEN_ADDRESS, goals, np.arange(len(self._ids)))

    def _guarded(self, message: bytes) -> None:
        if self.up:
            try:
                self.port.send(message)
            except PortLostError:
                self.up = False


class CyclicExchange:
    """All buses of a robot, or some of them where its count of `joints` is given.

    `block` holds the last believed answers, `answered` who gave one in the last cycle.
    """

    def __init__(
        self, buses: Sequence[BusExchange], clock: LineClock, *, answer_margin: float, joints: int | None = None
    ) -> None:
        self.buses = buses
        self._clock = clock
        self._margin = answer_margin
        count = sum(len(bus.joints) for bus in buses) if joints is None else joints
        self.block = np.zeros(count, dtype=READ_TYPE)
        self.answered = np.zeros(count, dtype=np.bool_)
        self.forgetful = np.zeros(count, dtype=np.bool_)
        """Who answered nothing but zeros: it has lost its RAM, and with it what to show."""
        self.alert = np.zeros(count, dtype=np.bool_)
        self.taken = 0.0
        """s of the last cycle."""

    def read(self) -> None:
        """Ask everybody; returns when all have answered or the time for it is over."""
        begin_ns = self._clock.now_ns()
        for bus in self.buses:
            bus.ask()
        up = [bus for bus in self.buses if bus.up]
        patience = max((bus.duration for bus in up), default=0.0) + self._margin
        deadline_ns = begin_ns + round(patience * 1e9)
        # Nobody can be done before: to wake for each servo's answer would cost more than to read them.
        self._clock.sleep_until(begin_ns + round(min((bus.least_duration for bus in up), default=0.0) * 1e9))
        while (waiting := [bus for bus in self.buses if bus.waiting]) and self._clock.now_ns() < deadline_ns:
            self._clock.wait_for_answer([bus.port for bus in waiting], deadline_ns)
            for bus in waiting:
                bus.take()
        self.answered[:] = self.forgetful[:] = False
        for bus in self.buses:
            self._believe(bus)
        self.taken = (self._clock.now_ns() - begin_ns) * 1e-9

    def write(self, goals: NDArray[np.void]) -> None:
        """Send goals of WRITTEN_TYPE (joints,) to all."""
        for bus in self.buses:
            bus.tell_goals(goals[bus.joints])

    def tell(self, address: int, values: NDArray[np.generic], which: NDArray[np.bool_]) -> None:
        """Write a register of the servos `which` (joints,) to their `values` (joints,)."""
        for bus in self.buses:
            ranks = np.flatnonzero(which[bus.joints])
            if ranks.size:
                bus.tell(address, values[bus.joints[ranks]], ranks)

    def _believe(self, bus: BusExchange) -> None:
        group = bus.group
        sound = group.finish()
        heard = group.data.view(READ_TYPE)[:, 0] if len(group.ids) else np.zeros(0, dtype=READ_TYPE)
        joints = bus.joints[bus.asked]
        good = sound & plausible(heard)
        self.answered[joints] = good
        self.forgetful[joints] = sound & ~group.data.any(axis=1)
        self.alert[joints[sound]] = group.error[sound] & 0x80 != 0
        self.block[joints[good]] = heard[good]
