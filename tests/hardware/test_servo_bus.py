"""The emulated bus is what the vendor's own client takes it for, and behaves as the manual says."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from dynamixel_sdk import (
    COMM_RX_TIMEOUT,
    COMM_SUCCESS,
    GroupBulkRead,
    GroupBulkWrite,
    GroupSyncRead,
    GroupSyncWrite,
    PacketHandler,
    PortHandler,
)

from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.servos.health_block import READ_ADDRESS, READ_TYPE, indirect_addresses
from robot_agent.hardware.servos.packet import ALERT, Fault
from sim_agent.servo_bus import EmulatedBus, EmulatedServo
from sim_agent.servo_bus.joints import FirstOrderJoints
from sim_agent.servo_bus.pseudo_terminal import PseudoTerminal
from sim_agent.servo_bus.virtual_port import VirtualPort
from weaver_shared.clock import SimulatedClock

IDS = list(range(1, 31))
SDK = PacketHandler(2.0)
Ask = Callable[..., tuple[int, ...]]


class Bench:
    """Thirty servos on a bus with a clock of its own."""

    def __init__(self) -> None:
        models = [r.MODELS[321 if servo % 5 in (3, 4) else 311] for servo in IDS]
        self.servos = [EmulatedServo(servo, model) for servo, model in zip(IDS, models, strict=True)]
        self.clock = SimulatedClock()
        self.joints = FirstOrderJoints(self.servos)
        self.bus = EmulatedBus(self.servos, advance=self.joints.advance)
        self.port = VirtualPort(self.bus, self.clock)

    def write(self, servo: int, register: r.Register, value: int) -> int:
        send = {1: SDK.write1ByteTxRx, 2: SDK.write2ByteTxRx, 4: SDK.write4ByteTxRx}[register.size]
        result, error = send(self.port, servo, register.address, value)
        assert result == COMM_SUCCESS
        return int(error)

    def read(self, servo: int, register: r.Register) -> int:
        ask = {1: SDK.read1ByteTxRx, 2: SDK.read2ByteTxRx, 4: SDK.read4ByteTxRx}[register.size]
        value, result, _ = ask(self.port, servo, register.address)
        assert result == COMM_SUCCESS
        return int(value)


@pytest.fixture
def bench() -> Bench:
    return Bench()


def test_the_sdk_finds_every_servo(bench: Bench) -> None:
    found, result = SDK.broadcastPing(bench.port)
    assert result == COMM_SUCCESS
    assert {servo: model for servo, (model, _) in found.items()} == {s.id: s.table.model.number for s in bench.servos}
    assert SDK.ping(bench.port, 7) == (311, COMM_SUCCESS, 0)
    assert SDK.ping(bench.port, 99)[1] == COMM_RX_TIMEOUT


def test_the_sdk_reads_what_it_wrote(bench: Bench) -> None:
    for register, value in ((r.LED, 1), (r.GOAL_CURRENT, 300), (r.GOAL_POSITION, 1234)):
        assert bench.write(3, register, value) == 0
        assert bench.read(3, register) == value


def test_sync_reads_and_writes_of_the_sdk(bench: Bench) -> None:
    goals = GroupSyncWrite(bench.port, SDK, r.GOAL_POSITION.address, 4)
    for servo in IDS:
        goals.addParam(servo, (2000 + servo).to_bytes(4, "little"))
    assert goals.txPacket() == COMM_SUCCESS
    for read in (GroupSyncRead.txRxPacket, GroupSyncRead.fastSyncRead):
        group = GroupSyncRead(bench.port, SDK, r.GOAL_POSITION.address, 4)
        for servo in IDS:
            group.addParam(servo)
        assert read(group) == COMM_SUCCESS
        assert [group.getData(servo, r.GOAL_POSITION.address, 4) for servo in IDS] == [2000 + s for s in IDS]


def test_bulk_reads_and_writes_of_the_sdk(bench: Bench) -> None:
    write = GroupBulkWrite(bench.port, SDK)
    write.addParam(1, r.GOAL_CURRENT.address, 2, (100).to_bytes(2, "little"))
    write.addParam(2, r.LED.address, 1, b"\x01")
    assert write.txPacket() == COMM_SUCCESS
    for read in (GroupBulkRead.txRxPacket, GroupBulkRead.fastBulkRead):
        group = GroupBulkRead(bench.port, SDK)
        group.addParam(1, r.GOAL_CURRENT.address, 2)
        group.addParam(2, r.LED.address, 1)
        assert read(group) == COMM_SUCCESS
        assert group.getData(1, r.GOAL_CURRENT.address, 2) == 100
        assert group.getData(2, r.LED.address, 1) == 1


def test_registered_writes_wait_for_the_action(bench: Bench) -> None:
    SDK.regWriteTxRx(bench.port, 1, r.GOAL_POSITION.address, 4, list((777).to_bytes(4, "little")))
    assert bench.read(1, r.GOAL_POSITION) != 777
    assert bench.read(1, r.REGISTERED) == 1
    SDK.action(bench.port, 1)
    bench.clock.forward(seconds=0.01)
    assert bench.read(1, r.GOAL_POSITION) == 777


def test_a_reboot_empties_ram_and_takes_a_while(bench: Bench) -> None:
    bench.write(4, r.TORQUE_ENABLE, 1)
    bench.write(4, r.BUS_WATCHDOG, 100)
    assert SDK.reboot(bench.port, 4) == (COMM_SUCCESS, 0)
    assert SDK.ping(bench.port, 4)[1] == COMM_RX_TIMEOUT
    bench.clock.forward(seconds=0.5)
    assert bench.read(4, r.TORQUE_ENABLE) == bench.read(4, r.BUS_WATCHDOG) == 0


def test_factory_reset_and_clear_of_the_sdk(bench: Bench) -> None:
    bench.write(5, r.RETURN_DELAY, 0)
    assert SDK.factoryReset(bench.port, 5, 0x02) == (COMM_SUCCESS, 0)
    bench.clock.forward(seconds=0.5)
    assert bench.read(5, r.RETURN_DELAY) == r.FACTORY_RETURN_DELAY
    assert SDK.clearMultiTurn(bench.port, 5) == (COMM_SUCCESS, 0)


@pytest.mark.parametrize(
    ("register", "value", "fault"),
    [
        (r.PRESENT_POSITION, 0, Fault.ACCESS),
        (r.BUS_WATCHDOG, 128, Fault.DATA_RANGE),
        (r.RETURN_DELAY, 0, Fault.ACCESS),
        (r.GOAL_CURRENT, 1942, Fault.DATA_LIMIT),
        (r.GOAL_POSITION, 4096, Fault.DATA_LIMIT),
        (r.LED, 2, Fault.DATA_RANGE),
    ],
)
def test_forbidden_writes_are_refused_for_their_reason(
    bench: Bench, register: r.Register, value: int, fault: Fault
) -> None:
    bench.write(1, r.TORQUE_ENABLE, 1)
    before = bench.read(1, register)
    assert bench.write(1, register, value) == fault
    assert bench.read(1, register) == before


def test_half_a_register_can_not_be_written(bench: Bench) -> None:
    assert SDK.write2ByteTxRx(bench.port, 1, r.GOAL_POSITION.address, 5) == (COMM_SUCCESS, Fault.DATA_LENGTH)


def test_status_return_level_decides_who_gets_an_answer(bench: Bench) -> None:
    SDK.write1ByteTxOnly(bench.port, 1, r.STATUS_RETURN_LEVEL.address, 1)
    assert SDK.write1ByteTxRx(bench.port, 1, r.LED.address, 1)[0] == COMM_RX_TIMEOUT
    assert bench.read(1, r.LED) == 1
    SDK.write1ByteTxOnly(bench.port, 1, r.STATUS_RETURN_LEVEL.address, 0)
    assert SDK.read1ByteTxRx(bench.port, 1, r.LED.address)[1] == COMM_RX_TIMEOUT
    assert SDK.ping(bench.port, 1)[1] == COMM_SUCCESS


def test_return_delay_is_time_on_the_line(bench: Bench) -> None:
    def duration() -> float:
        begin = bench.clock.now_ns()
        bench.read(1, r.LED)
        return (bench.clock.now_ns() - begin) * 1e-9

    slow = duration()
    bench.write(1, r.RETURN_DELAY, 0)
    assert slow - duration() == pytest.approx(500e-6 - 30e-6, abs=2e-6)


def test_a_cycle_of_thirty_servos_takes_what_the_line_takes(bench: Bench) -> None:
    """26 ms with the factory's delay, 10.3 ms without, at 1 Mbit/s (facts of the line, computed)."""
    for servo in bench.servos:
        servo.table[r.RETURN_DELAY] = 0
    group = GroupSyncRead(bench.port, SDK, r.PRESENT_CURRENT.address, 10)
    for servo in IDS:
        group.addParam(servo)
    begin = bench.clock.now_ns()
    assert group.txRxPacket() == COMM_SUCCESS
    wire = (44 + 30 * 21) * 10e-6 + 30 * 30e-6 + 1e-3
    assert (bench.clock.now_ns() - begin) * 1e-9 == pytest.approx(wire, rel=0.02)


def test_the_watchdog_stops_a_servo_that_nobody_talks_to(bench: Bench) -> None:
    bench.write(1, r.TORQUE_ENABLE, 1)
    bench.write(1, r.GOAL_POSITION, 3000)
    bench.write(1, r.BUS_WATCHDOG, 5)
    bench.clock.forward(seconds=0.11)
    stopped = bench.read(1, r.PRESENT_POSITION)
    assert 2048 < stopped < 3000
    assert bench.read(1, r.BUS_WATCHDOG) == 255
    assert bench.read(1, r.TORQUE_ENABLE) == 1
    assert bench.write(1, r.GOAL_POSITION, 3000) == Fault.DATA_RANGE
    bench.clock.forward(seconds=1.0)
    assert bench.read(1, r.PRESENT_POSITION) == pytest.approx(stopped, abs=1)
    bench.write(1, r.BUS_WATCHDOG, 0)
    assert bench.write(1, r.GOAL_POSITION, 3000) == 0


def test_questions_to_anybody_feed_every_watchdog(bench: Bench) -> None:
    bench.write(1, r.TORQUE_ENABLE, 1)
    bench.write(1, r.BUS_WATCHDOG, 5)
    for _ in range(10):
        bench.clock.forward(seconds=0.09)
        bench.read(2, r.LED)
    assert bench.read(1, r.BUS_WATCHDOG) == 5


def test_a_shutdown_takes_torque_until_a_reboot(bench: Bench) -> None:
    bench.write(2, r.TORQUE_ENABLE, 1)
    bench.servos[1].fail(32)
    assert bench.read(2, r.TORQUE_ENABLE) == 0
    assert SDK.ping(bench.port, 2)[2] & ALERT
    assert bench.write(2, r.TORQUE_ENABLE, 1) & ALERT
    assert bench.read(2, r.TORQUE_ENABLE) == 0
    SDK.reboot(bench.port, 2)
    bench.clock.forward(seconds=0.5)
    assert bench.write(2, r.TORQUE_ENABLE, 1) == 0
    assert bench.read(2, r.TORQUE_ENABLE) == 1


def test_a_hot_servo_shuts_down_by_itself(bench: Bench) -> None:
    bench.servos[0].temperature = 85.0
    assert bench.read(1, r.HARDWARE_ERROR) == 4
    assert bench.read(1, r.PRESENT_TEMPERATURE) == 85


def test_indirect_addresses_gather_a_block(bench: Bench) -> None:
    places = indirect_addresses()
    assert SDK.writeTxRx(bench.port, 6, r.INDIRECT_ADDRESSES, len(places), list(places)) == (COMM_SUCCESS, 0)
    data, result, _ = SDK.readTxRx(bench.port, 6, READ_ADDRESS, READ_TYPE.itemsize)
    block = np.frombuffer(bytes(data), dtype=READ_TYPE)[0]
    assert result == COMM_SUCCESS
    assert (block["position"], block["temperature"], block["voltage"]) == (2048, 25, 148)
    assert block["return_level"] == r.ANSWERS_ALL


@pytest.mark.parametrize(("target", "fault"), [(r.ID.address, 4), (63, 4), (64, 0), (661, 0), (662, 4)])
def test_indirect_addresses_reach_ram_alone(bench: Bench, target: int, fault: int) -> None:
    places = [*indirect_addresses()[:4], *target.to_bytes(2, "little")]
    before = SDK.readTxRx(bench.port, 6, r.INDIRECT_ADDRESSES, 6)[0]
    assert SDK.writeTxRx(bench.port, 6, r.INDIRECT_ADDRESSES, 6, places) == (COMM_SUCCESS, fault)
    assert SDK.readTxRx(bench.port, 6, r.INDIRECT_ADDRESSES, 6)[0] == (before if fault else places)


def test_a_silent_servo_leaves_a_gap_or_silences_the_rest(bench: Bench) -> None:
    bench.servos[9].alive = False
    for breaks, expected in ((False, 29), (True, 9)):
        bench.bus.troubles.chain_breaks = breaks
        request = [0x84, 0, 4, 0, *IDS]
        SDK.syncReadTx(bench.port, 132, 4, request[4:], len(IDS), False)
        bench.port.is_using = False
        bench.clock.forward(seconds=0.1)
        assert len(bench.port.readPort(10_000)) == expected * 15


def test_servos_move_to_their_goal_no_faster_than_they_can(bench: Bench) -> None:
    bench.write(1, r.TORQUE_ENABLE, 1)
    bench.write(1, r.GOAL_POSITION, 2048 + 1024)
    bench.clock.forward(seconds=0.1)
    assert bench.read(1, r.PRESENT_POSITION) == pytest.approx(2048 + 0.1 * 4.7 / r.RAD_PER_COUNT, abs=20)
    bench.clock.forward(seconds=1.0)
    assert bench.read(1, r.PRESENT_POSITION) == pytest.approx(3072, abs=1)


def test_the_sdk_opens_a_pseudo_terminal(bench: Bench, tmp_path: Path) -> None:
    terminal = PseudoTerminal(bench.bus, tmp_path / "servos", paced=False)
    port = PortHandler(str(terminal.link))
    try:
        assert port.openPort()
        port.setPacketTimeout = lambda length: PortHandler.setPacketTimeoutMillis(port, 2000.0)
        assert SDK.ping(port, 7) == (311, COMM_SUCCESS, 0)
        group = GroupSyncRead(port, SDK, r.PRESENT_POSITION.address, 4)
        for servo in IDS:
            group.addParam(servo)
        assert group.txRxPacket() == COMM_SUCCESS
        assert group.getData(30, r.PRESENT_POSITION.address, 4) == 2048
    finally:
        port.closePort()
        terminal.close()
    assert not terminal.link.is_symlink()
