"""What went over a robot's lines, kept so that it can be heard again: the driver does all as it did, with no device."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from robot_agent.hardware.serial_line import ByteLine
from sim_agent.servo_bus.bus import Reply
from sim_agent.servo_bus.wire import Answering
from weaver_shared.errors import InputError


@dataclass(frozen=True, slots=True)
class Said:
    """Bytes that a program wrote at a time, and what came back for them; of a talking device's line: what was read."""

    at_ns: int
    written: bytes
    replies: tuple[Reply, ...]


class TracedBus:
    """A bus whose talk is written down in `trace`."""

    def __init__(self, bus: Answering) -> None:
        self._bus = bus
        self.trace: list[Said] = []

    def transmit(self, data: bytes, now_ns: int) -> list[Reply]:
        replies = self._bus.transmit(data, now_ns)
        self.trace.append(Said(now_ns, data, tuple(replies)))
        return replies


class ReplayedBus:
    """Answers as it was answered then. Raises InputError where something else is written than then."""

    def __init__(self, trace: Iterable[Said]) -> None:
        self._trace = iter(trace)

    def transmit(self, data: bytes, now_ns: int) -> list[Reply]:
        said = next(self._trace, None)
        if said is None or said.written != data:
            recorded = "nothing more" if said is None else said.written.hex(" ")
            raise InputError(f"the trace has {recorded} where {data.hex(' ')} is written: this is another talk")
        late_ns = now_ns - said.at_ns
        return [Reply(reply.arrives_ns + late_ns, reply.data) for reply in said.replies]


class TracedLine:
    """A talking device's line, likewise."""

    def __init__(self, line: ByteLine) -> None:
        self._line = line
        self.trace: list[Said] = []

    @property
    def openings(self) -> int:
        return self._line.openings

    def receive(self, now_ns: int) -> bytes:
        data = self._line.receive(now_ns)
        self.trace.append(Said(now_ns, b"", (Reply(now_ns, data),)))
        return data

    def send(self, data: bytes) -> bool:
        return self._line.send(data)

    def close(self) -> None:
        self._line.close()


class ReplayedLine:
    """Says what was heard then, reading by reading, and hears nothing."""

    openings = 1

    def __init__(self, trace: Iterable[Said]) -> None:
        self._trace = iter(trace)

    def receive(self, now_ns: int) -> bytes:
        said = next(self._trace, None)
        return said.replies[0].data if said is not None else b""

    def send(self, data: bytes) -> bool:
        return True

    def close(self) -> None: ...


def save_trace(path: Path, trace: Iterable[Said]) -> None:
    """One line of JSON for each."""
    lines = (
        json.dumps([said.at_ns, said.written.hex(), [[reply.arrives_ns, reply.data.hex()] for reply in said.replies]])
        for said in trace
    )
    path.write_text("".join(f"{line}\n" for line in lines))


def load_trace(path: Path) -> list[Said]:
    """Raises InputError where it is none."""
    try:
        rows = [json.loads(line) for line in path.read_text().splitlines()]
        return [
            Said(at, bytes.fromhex(written), tuple(Reply(arrives, bytes.fromhex(data)) for arrives, data in replies))
            for at, written, replies in rows
        ]
    except (OSError, ValueError, TypeError) as error:
        raise InputError(f"{path} is not a trace of a robot's lines: {error}") from error
