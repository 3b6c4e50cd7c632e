"""The wire that servos share: instruction packets in, status packets out, each at its time.

Timing is that of a half-duplex line: ten bits a byte, each answer after the servo's return delay (at least the time
it takes to turn the line round), those of one question one after the other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from random import Random

from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.servos.frame_reader import FrameReader
from robot_agent.hardware.servos.packet import (
    BROADCAST,
    STATUS_OVERHEAD,
    Fault,
    Frame,
    Instruction,
    Status,
    encode_fast_status,
    encode_status,
)
from sim_agent.servo_bus.servo import EmulatedServo

TURN_ROUND = 30e-6
"""s between question and answer at the least (assumed)."""
BITS_PER_BYTE = 10
FAST_OVERHEAD = 4
"""Bytes of a servo's part of a fast answer beside its data."""


@dataclass(frozen=True, slots=True)
class Reply:
    arrives_ns: int
    data: bytes


@dataclass(slots=True)
class LineTroubles:
    """What goes wrong on the wire, as fractions of packets."""

    lost_questions: float = 0.0
    lost_answers: float = 0.0
    spoilt_answers: float = 0.0
    spoilt_ids: frozenset[int] | None = None  # None: of all servos
    chain_breaks: bool = False  # a silent servo silences all behind it in a sync read; the manual does not say


class EmulatedBus:
    """Servos on one line. `advance` is called before every packet with the time, to move what the servos turn."""

    def __init__(
        self,
        servos: Iterable[EmulatedServo],
        *,
        baud: int = 1_000_000,
        adapter_latency: float = 1e-3,
        seed: int = 0,
        advance: Callable[[int], None] = lambda now_ns: None,
    ) -> None:
        self.servos = list(servos)
        self.troubles = LineTroubles()
        self.latency_ns = round(adapter_latency * 1e9)
        self._byte_ns = BITS_PER_BYTE * 1e9 / baud
        self._advance = advance
        self._random = Random(seed)
        self._reader = FrameReader()
        self._line_free_ns = 0
        self._replies: list[Reply] = []

    def transmit(self, data: bytes, now_ns: int) -> list[Reply]:
        """Put bytes on the line; returns the answers, each whole, with the time at which the computer has it."""
        self._line_free_ns = max(self._line_free_ns, now_ns) + round(len(data) * self._byte_ns)
        self._replies = []
        for frame in self._reader.feed(data):
            self._advance(now_ns)
            for servo in self.servos:
                servo.elapse(now_ns)
            if self._random.random() >= self.troubles.lost_questions:
                self._obey(frame, now_ns)
        return self._replies

    def _obey(self, frame: Frame, now_ns: int) -> None:
        hearing = [servo for servo in self.servos if servo.hears(now_ns)]
        for servo in hearing:
            servo.fed(now_ns)
        match frame.instruction:
            case Instruction.SYNC_READ | Instruction.BULK_READ:
                self._answer_in_turn(hearing, _asked(frame))
            case Instruction.FAST_SYNC_READ | Instruction.FAST_BULK_READ:
                self._answer_as_one(hearing, _asked(frame))
            case Instruction.SYNC_WRITE | Instruction.BULK_WRITE:
                called = _by_id(hearing)
                for identity, address, data in _told(frame):
                    for servo in called.get(identity, ()):
                        servo.write(address, data)
            case _:
                for servo in hearing:
                    if frame.id in (servo.id, BROADCAST):
                        self._obey_alone(servo, frame, now_ns)

    def _obey_alone(self, servo: EmulatedServo, frame: Frame, now_ns: int) -> None:
        parameters, shadow = frame.parameters, b""
        reading = False
        match frame.instruction:
            case Instruction.PING:
                table = servo.table
                model = table[r.MODEL_NUMBER].to_bytes(2, "little") + bytes([table[r.FIRMWARE]])
                self._send(servo, encode_status(servo.id, servo.error(), model))
                return
            case Instruction.READ:
                reading = True
                address, length = _words(parameters[:4])
                fault, shadow = servo.read(address, length)
            case Instruction.WRITE:
                fault = servo.write(int.from_bytes(parameters[:2], "little"), parameters[2:])
            case Instruction.REG_WRITE:
                fault = servo.register_write(parameters)
            case Instruction.ACTION:
                fault = servo.act()
            case Instruction.CLEAR:
                fault = servo.clear(parameters)
            case Instruction.REBOOT:
                fault = Fault.NONE
                self._acknowledge(servo, frame, fault)
                servo.restart(now_ns)
                return
            case Instruction.FACTORY_RESET:
                if frame.id == BROADCAST and parameters == b"\xff":
                    return
                fault = servo.factory_reset(parameters[0] if parameters else 0, now_ns)
            case _:
                fault = Fault.INSTRUCTION
        if reading and frame.id != BROADCAST and servo.answers(reading=True):
            self._send(servo, encode_status(servo.id, servo.error(fault), shadow))
        elif not reading:
            self._acknowledge(servo, frame, fault)

    def _acknowledge(self, servo: EmulatedServo, frame: Frame, fault: Fault) -> None:
        if frame.id != BROADCAST and servo.answers(reading=False):
            self._send(servo, encode_status(servo.id, servo.error(fault)))

    def _answer_in_turn(self, hearing: list[EmulatedServo], asked: list[tuple[int, int, int]]) -> None:
        called = _by_id(hearing)
        for identity, address, length in asked:
            answering = [servo for servo in called.get(identity, ()) if servo.answers(reading=True)]
            if not answering:
                if self.troubles.chain_breaks:
                    return
                # Those behind it give it the time its answer would have taken.
                self._line_free_ns += round((STATUS_OVERHEAD + length) * self._byte_ns)
            for servo in answering:
                fault, data = servo.read(address, length)
                self._send(servo, encode_status(servo.id, servo.error(fault), data))

    def _answer_as_one(self, hearing: list[EmulatedServo], asked: list[tuple[int, int, int]]) -> None:
        """Each servo sends its part when it has heard the one before: behind a silent one nobody speaks."""
        present = {servo.id: servo for servo in hearing if servo.answers(reading=True)}
        statuses = []
        for identity, address, length in asked:
            servo = present.get(identity)
            # All know the length of the whole; a part that is missing is filled here only to be cut off below.
            fault, data = servo.read(address, length) if servo else (Fault.NONE, bytes(length))
            statuses.append(Status(identity, servo.error(fault) if servo else 0, data))
        spoken = next((rank for rank, (identity, _, _) in enumerate(asked) if identity not in present), len(asked))
        silent = sum(length + FAST_OVERHEAD for _, _, length in asked[spoken:])
        message = encode_fast_status(statuses)
        if spoken:
            self._send(present[asked[0][0]], message[: len(message) - silent])

    def _send(self, servo: EmulatedServo, message: bytes) -> None:
        delay = max(servo.table[r.RETURN_DELAY] * r.RETURN_DELAY_UNIT, TURN_ROUND)
        self._line_free_ns += round(delay * 1e9 + len(message) * self._byte_ns)
        troubles = self.troubles
        if self._random.random() < troubles.lost_answers:
            return
        touched = troubles.spoilt_ids is None or servo.id in troubles.spoilt_ids
        if touched and self._random.random() < troubles.spoilt_answers:
            place = self._random.randrange(len(message))
            message = message[:place] + bytes([message[place] ^ self._random.randrange(1, 256)]) + message[place + 1 :]
        self._replies.append(Reply(self._line_free_ns + self.latency_ns, message))


def _by_id(servos: list[EmulatedServo]) -> dict[int, list[EmulatedServo]]:
    """Several may have one id by mistake."""
    found: dict[int, list[EmulatedServo]] = {}
    for servo in servos:
        found.setdefault(servo.id, []).append(servo)
    return found


def _asked(frame: Frame) -> list[tuple[int, int, int]]:
    """Id, address and length of what a group read asks, in its order; a shape it can not have asks nothing."""
    parameters = frame.parameters
    if frame.instruction in (Instruction.SYNC_READ, Instruction.FAST_SYNC_READ):
        if len(parameters) < 5:
            return []
        address, length = _words(parameters[:4])
        return [(identity, address, length) for identity in parameters[4:]]
    if not parameters or len(parameters) % 5:
        return []
    return [(parameters[at], *_words(parameters[at + 1 : at + 5])) for at in range(0, len(parameters), 5)]


def _told(frame: Frame) -> list[tuple[int, int, bytes]]:
    """Id, address and data of what a group write tells."""
    parameters = frame.parameters
    if frame.instruction == Instruction.SYNC_WRITE:
        address, length = _words(parameters[:4])
        places = range(4, len(parameters) - length, length + 1)
        return [(parameters[at], address, parameters[at + 1 : at + 1 + length]) for at in places]
    told, at = [], 0
    while at + 5 <= len(parameters):
        address, length = _words(parameters[at + 1 : at + 5])
        told.append((parameters[at], address, parameters[at + 5 : at + 5 + length]))
        at += 5 + length
    return told


def _words(raw: bytes) -> tuple[int, int]:
    return int.from_bytes(raw[:2], "little"), int.from_bytes(raw[2:4], "little")
