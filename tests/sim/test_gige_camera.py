"""An emulated GigE Vision camera as its packets tell it, without any client's library."""

from __future__ import annotations

import socket
import struct
from collections.abc import Iterator
from contextlib import closing

import numpy as np
import pytest

from sim_agent.gige import GigeCamera
from sim_agent.gige.camera import AGE_NS
from sim_agent.gige.control import PORT, Command, Status
from sim_agent.gige.features import FEATURES, LATCH_CONTROL, LATCHED
from sim_agent.gige.registers import PACKET_SIZE, PRIVILEGE, STREAM_ADDRESS, STREAM_PORT
from weaver_shared.clock import SimulatedClock
from weaver_shared.errors import ResourceError

ADDRESS = "127.92.3.1"
SIZE = (64, 48)
LOOPBACK = 0x7F00_0001


class Client:
    """Asks as a client does, one packet at a time."""

    def __init__(self) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.socket.settimeout(10.0)

    def ask(self, command: Command, payload: bytes = b"", *, answered: bool = True) -> tuple[int, bytes]:
        self.socket.sendto(struct.pack(">BBHHH", 0x42, answered, command, len(payload), 7) + payload, (ADDRESS, PORT))
        if not answered:
            return 0, b""
        data = self.socket.recv(65_536)
        status, _, _, number = struct.unpack_from(">HHHH", data)
        assert number == 7
        return status, data[8:]

    def write(self, address: int, value: int) -> int:
        return self.ask(Command.WRITE_REGISTERS, struct.pack(">II", address, value))[0]

    def set(self, name: str, value: int) -> None:
        assert self.write(FEATURES[name].address, value) == Status.SUCCESS

    def close(self) -> None:
        self.socket.close()


@pytest.fixture
def clock() -> SimulatedClock:
    return SimulatedClock(5_000_000_000)


@pytest.fixture
def camera(clock: SimulatedClock) -> Iterator[GigeCamera]:
    with closing(GigeCamera(ADDRESS, "LEFT", SIZE, clock.now_ns)) as camera:
        yield camera


@pytest.fixture
def client() -> Iterator[Client]:
    with closing(Client()) as client:
        yield client


def streamed(client: Client, packet_size: int = 1000) -> Client:
    """Takes control and lets the pictures come to another socket, which is returned."""
    receiver = Client()
    client.write(PRIVILEGE, 2)
    client.write(STREAM_ADDRESS, LOOPBACK)
    client.write(STREAM_PORT, receiver.socket.getsockname()[1])
    client.write(PACKET_SIZE, packet_size)
    client.set("AcquisitionStart", 1)
    return receiver


def seen(receiver: Client, camera: GigeCamera) -> tuple[int, int, np.ndarray]:
    """Frame, device stamp and pixels of the next picture."""
    frame, stamp_ns, pixels = 0, 0, b""
    while True:
        packet = receiver.socket.recv(65_536)
        _, frame, what = struct.unpack_from(">HHI", packet)
        if what >> 24 == 1:
            (stamp_ns,) = struct.unpack_from(">Q", packet, 12)
        elif what >> 24 == 3:
            pixels += packet[8:]
        else:
            return frame, stamp_ns, np.frombuffer(pixels, dtype=np.uint8).reshape(SIZE[::-1])


def test_it_tells_who_it_is(camera: GigeCamera, client: Client) -> None:
    status, told = client.ask(Command.DISCOVER)
    assert status == Status.SUCCESS
    assert told[0xD8:0xE8].rstrip(b"\0") == b"LEFT"


def test_a_picture_arrives_as_it_was_shown_with_its_own_time(
    camera: GigeCamera, client: Client, clock: SimulatedClock
) -> None:
    picture = np.arange(SIZE[0] * SIZE[1], dtype=np.int64).astype(np.uint8).reshape(SIZE[::-1])
    camera.see(picture)
    with closing(streamed(client)) as receiver:
        client.ask(Command.WRITE_MEMORY, struct.pack(">If", FEATURES["ExposureTime"].address, 4000.0))
        camera.tick(clock.now_ns() + 20_000_000)
        frame, stamp_ns, pixels = seen(receiver, camera)
    assert frame == 1
    # In the middle of the exposure, on a clock that began with the camera; stamped at the beginning.
    assert stamp_ns == AGE_NS + 20_000_000 - 2_000_000
    assert np.array_equal(pixels, picture)


def test_a_camera_that_waits_for_its_line_exposes_with_its_rising_edge_alone(
    camera: GigeCamera, client: Client, clock: SimulatedClock
) -> None:
    with closing(streamed(client)):
        client.set("TriggerMode", 1)
        client.set("TriggerSource", FEATURES["TriggerSource"].entries["Line3"])
        client.set("TriggerActivation", FEATURES["TriggerActivation"].entries["RisingEdge"])
        camera.tick(clock.now_ns())
        camera.pulse("Line2", clock.now_ns(), "RisingEdge")
        camera.pulse("Line3", clock.now_ns(), "FallingEdge")
        assert camera.exposures == 0
        camera.pulse("Line3", clock.now_ns(), "RisingEdge")
        assert camera.exposures == 1


def test_lost_packets_are_sent_again_when_asked_for(camera: GigeCamera, client: Client, clock: SimulatedClock) -> None:
    with closing(streamed(client)) as receiver:
        camera.lost_packets = 1.0
        camera.tick(clock.now_ns())
        client.ask(Command.RESEND, struct.pack(">HHII", 0, 1, 0, 0xFFFFFF), answered=False)
        frame, _, pixels = seen(receiver, camera)
    assert (frame, pixels.shape) == (1, SIZE[::-1])


def test_it_keeps_its_time_for_who_asks(camera: GigeCamera, client: Client, clock: SimulatedClock) -> None:
    client.write(PRIVILEGE, 2)
    clock.forward(seconds=1.5)
    client.write(LATCH_CONTROL, 2)
    clock.forward(seconds=1.0)
    _, told = client.ask(Command.READ_MEMORY, struct.pack(">II", LATCHED, 8))
    assert int.from_bytes(told[4:], "big") == AGE_NS + 1_500_000_000


def test_only_one_client_controls_it(camera: GigeCamera, client: Client) -> None:
    assert client.write(PRIVILEGE, 2) == Status.SUCCESS
    with closing(Client()) as other:
        assert other.write(FEATURES["AcquisitionStart"].address, 1) == Status.ACCESS_DENIED
        assert client.write(PRIVILEGE, 0) == Status.SUCCESS
        assert other.write(PRIVILEGE, 2) == Status.SUCCESS


def test_two_cameras_can_not_have_one_address(camera: GigeCamera, clock: SimulatedClock) -> None:
    with pytest.raises(ResourceError, match=ADDRESS):
        GigeCamera(ADDRESS, "RIGHT", SIZE, clock.now_ns)


@pytest.mark.parametrize(
    ("command", "payload"),
    [
        (Command.READ_MEMORY, b""),
        (Command.READ_MEMORY, bytes(12)),
        (Command.WRITE_REGISTERS, bytes(4)),
        (Command.RESEND, bytes(5)),
    ],
)
def test_a_question_of_the_wrong_length_is_refused_and_the_next_one_answered(
    camera: GigeCamera, client: Client, command: Command, payload: bytes
) -> None:
    assert client.ask(command, payload) == (Status.INVALID_PARAMETER, b"")
    status, told = client.ask(Command.DISCOVER)
    assert status == Status.SUCCESS
    assert len(told) == 0xF8
