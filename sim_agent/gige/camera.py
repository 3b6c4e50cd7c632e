"""A GigE Vision camera that shows pictures it is given. Any address of the loopback network will do."""

from __future__ import annotations

import ipaddress
import socket
import struct
import threading
import time
from collections.abc import Callable
from random import Random

import numpy as np
from numpy.typing import NDArray

from sim_agent.gige.control import PORT, Command, Question, Resend, Status, answer, question, resend
from sim_agent.gige.features import CHUNKS, FEATURES, LATCH_CONTROL, LATCHED
from sim_agent.gige.registers import (
    BOOTSTRAP_LENGTH,
    FIRE_TEST,
    HEARTBEAT_TIMEOUT,
    PACKET_SIZE,
    PRIVILEGE,
    STREAM_ADDRESS,
    STREAM_PORT,
    Registers,
)
from sim_agent.gige.stream import LAST_FRAME, Chunk, packets, payload_size
from weaver_shared.errors import ResourceError

WIRE_SPEED = 125e6  # byte/s of gigabit Ethernet; faster than that a receiver's buffer overflows
AGE_NS = 10_000_000_000
"""It was switched on so long before it is served; pictures may be of a moment ago."""
KEPT_FRAMES = 4
"""Frames of which packets can be asked for again."""
_POLL = 0.1  # s
_IP_AND_UDP = 28


class GigeCamera:
    """Grey pictures of `size` (width, height) on `address`; `now_ns` is its clock.

    Raises ResourceError where the computer does not have that address, or another camera is there.
    """

    def __init__(self, address: str, serial: str, size: tuple[int, int], now_ns: Callable[[], int]) -> None:
        self._now_ns = now_ns
        self._begun_ns = now_ns() - AGE_NS
        self._registers = Registers(address, serial, size)
        self._size = size
        self._picture = bytes(size[0] * size[1])
        self._guard = threading.RLock()
        self._controller: tuple[str, int] | None = None
        self._heard = 0.0
        self._running = False
        self._frame = 0
        self._kept: dict[int, list[bytes]] = {}
        self._wires: dict[str, tuple[GigeCamera, str]] = {}
        self._chance = Random(0)
        self.lost_packets = 0.0
        """Share of the stream's packets that get lost on their way."""
        self.exposures = 0
        self._control = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._stream = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._control.bind((address, PORT))
            self._stream.bind((address, 0))
        except OSError as error:
            self._control.close()
            self._stream.close()
            raise ResourceError(f"no camera can be emulated on {address}: {error.strerror}") from error
        self._control.settimeout(_POLL)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._serve, name=f"camera {serial}", daemon=True)
        self._thread.start()

    def wire(self, line: str, other: GigeCamera, input_line: str) -> None:
        """Lay a wire from a line of this camera to one of another."""
        self._wires[line] = (other, input_line)

    def cut(self, line: str) -> None:
        self._wires.pop(line, None)

    def see(self, picture: NDArray[np.uint8]) -> None:
        """What is before its lens from now on, (height, width)."""
        with self._guard:
            self._picture = picture.tobytes()

    def tick(self, stamp_ns: int) -> None:
        """Its own clock says that it is time; it exposes in the middle around `stamp_ns` if it is to do so freely."""
        if self._registers.chosen("TriggerMode") == "Off":
            self._expose(stamp_ns)

    def pulse(self, line: str, stamp_ns: int, edge: str) -> None:
        """A line of it rises or falls, at the beginning or end of an exposure around `stamp_ns`."""
        waits = self._registers.chosen("TriggerMode") == "On" and self._registers.chosen("TriggerSource") == line
        if waits and self._registers.chosen("TriggerActivation") == edge:
            self._expose(stamp_ns)

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self._control.close()
        self._stream.close()

    def _expose(self, stamp_ns: int) -> None:
        with self._guard:
            if not self._running:
                return
            exposure_ns = round(1e3 * self._registers.value("ExposureTime"))
            self._frame = self._frame % LAST_FRAME + 1
            self.exposures += 1
            # A camera stamps the beginning.
            device_ns = stamp_ns - exposure_ns // 2 - self._begun_ns
            chunks = self._chunks(device_ns) if self._registers.value("ChunkModeActive") else []
            size = self._registers.word(PACKET_SIZE) & 0xFFFF
            frame = packets(self._frame, device_ns, self._picture, self._size, size, chunks)
            self._kept[self._frame] = frame
            for old in list(self._kept)[:-KEPT_FRAMES]:
                del self._kept[old]
            outputs = [
                wired
                for line, wired in self._wires.items()
                if self._registers.chosen("LineMode", line) == "Output"
                and self._registers.chosen("LineSource", line) == "ExposureActive"
            ]
        for edge in ("RisingEdge", "FallingEdge"):
            for other, line in outputs:
                other.pulse(line, stamp_ns + (exposure_ns if edge == "FallingEdge" else 0), edge)
        self._send(frame)

    def _send(self, frame: list[bytes]) -> None:
        begun, sent = time.monotonic(), 0
        for packet in frame:
            if self._chance.random() >= self.lost_packets:
                self._stream.sendto(packet, self._destination())
            sent += len(packet)
            ahead = sent / WIRE_SPEED - (time.monotonic() - begun)
            if ahead > 1e-3:
                time.sleep(ahead)

    def _chunks(self, device_ns: int) -> list[Chunk]:
        figures = {
            "ChunkFrameCounter": struct.pack(">I", self._frame),
            "ChunkTimestamp": struct.pack(">Q", max(device_ns, 0)),
            "ChunkExposureTime": struct.pack(">d", self._registers.value("ExposureTime")),
            "ChunkGain": struct.pack(">d", self._registers.value("Gain")),
        }
        return [Chunk(id=CHUNKS[name], data=data) for name, data in figures.items()]

    def _destination(self) -> tuple[str, int]:
        address = ipaddress.IPv4Address(self._registers.word(STREAM_ADDRESS))
        return str(address), self._registers.word(STREAM_PORT) & 0xFFFF

    def _serve(self) -> None:
        while not self._ending.is_set():
            try:
                data, caller = self._control.recvfrom(65_536)
            except OSError:
                self._look_for_silence()
                continue
            asked = question(data)
            if asked is None:
                continue
            with self._guard:
                try:
                    said = self._answer(asked, caller)
                except (ValueError, struct.error):  # its payload is not what the command takes
                    said = answer(asked, status=Status.INVALID_PARAMETER)
            if said and asked.answer_wanted:
                self._control.sendto(said, caller)

    def _look_for_silence(self) -> None:
        patience = self._registers.word(HEARTBEAT_TIMEOUT) * 1e-3
        if self._controller is not None and time.monotonic() - self._heard > patience:
            with self._guard:
                self._controller, self._running = None, False
                self._registers.set_word(PRIVILEGE, 0)

    def _answer(self, asked: Question, caller: tuple[str, int]) -> bytes:
        if caller == self._controller:
            self._heard = time.monotonic()
        match asked.command:
            case Command.DISCOVER:
                return answer(asked, self._registers.read(0, BOOTSTRAP_LENGTH) or b"")
            case Command.READ_REGISTERS:
                self._refresh()
                return answer(asked, b"".join(self._registers.read(one, 4) or bytes(4) for one in asked.words()))
            case Command.READ_MEMORY:
                return self._read_memory(asked)
            case Command.WRITE_REGISTERS | Command.WRITE_MEMORY:
                return self._write(asked, caller)
            case Command.RESEND:
                self._send_again(resend(asked))
                return b""
        return answer(asked, status=Status.NOT_IMPLEMENTED)

    def _read_memory(self, asked: Question) -> bytes:
        self._refresh()
        address, length = asked.words()
        read = self._registers.read(address, length & 0xFFFF)
        if read is None:
            return answer(asked, status=Status.INVALID_ADDRESS)
        return answer(asked, address.to_bytes(4, "big") + read)

    def _send_again(self, wanted: Resend) -> None:
        for packet in self._kept.get(wanted.frame, [])[wanted.first : wanted.last + 1]:
            self._stream.sendto(packet, self._destination())

    def _write(self, asked: Question, caller: tuple[str, int]) -> bytes:
        if self._controller not in (None, caller):
            return answer(asked, status=Status.ACCESS_DENIED)
        if asked.command == Command.WRITE_MEMORY:
            done = self._registers.write(int.from_bytes(asked.payload[:4], "big"), asked.payload[4:])
            return answer(asked, bytes(4), Status.SUCCESS if done else Status.INVALID_ADDRESS)
        words = asked.words()
        for address, value in zip(words[::2], words[1::2], strict=True):
            if not self._registers.write(address, value.to_bytes(4, "big")):
                return answer(asked, bytes(4), Status.INVALID_ADDRESS)
            self._obey(address, value, caller)
        return answer(asked, len(words[::2]).to_bytes(4, "big"))

    def _obey(self, address: int, value: int, caller: tuple[str, int]) -> None:
        """What a register does beyond keeping its value."""
        if address == PRIVILEGE:
            self._controller, self._heard = (caller if value else None), time.monotonic()
            self._running = self._running and bool(value)
        elif address == FEATURES["AcquisitionStart"].address:
            self._running = True
        elif address == FEATURES["AcquisitionStop"].address:
            self._running = False
        elif address == LATCH_CONTROL:
            self._registers.write(LATCHED, (self._now_ns() - self._begun_ns).to_bytes(8, "big"))
        elif address == PACKET_SIZE and value & FIRE_TEST:
            self._stream.sendto(bytes((value & 0xFFFF) - _IP_AND_UDP), self._destination())

    def _refresh(self) -> None:
        chunks = self._chunks(0) if self._registers.value("ChunkModeActive") else []
        self._registers.set_value("PayloadSize", payload_size(self._size[0] * self._size[1], chunks))
