"""IMU and power monitor as their bytes tell them: values, stamps, and silence where there is nothing to believe."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hardware_bodies import Twin

from robot_agent.hardware.imu import gx3, mip
from robot_agent.hardware.imu.clock_map import ClockMap
from robot_agent.hardware.imu.punctual import PunctualImu
from robot_agent.hardware.imu.stream import MicroStrainImu, gx3_imu, gx5_imu
from robot_agent.hardware.power_monitor import LINE_LENGTH, PowerMonitor, PowerParser, PowerRecord, encode
from robot_agent.hardware.serial_line import SerialLine
from robot_agent.odometry.imu_stream import ImuStream
from sim_agent.sensor_lines import DirectLine, EmulatedGx3, EmulatedGx5, EmulatedPowerMonitor
from sim_agent.twin.device_terminal import DeviceTerminal
from weaver_shared.clock import SimulatedClock
from weaver_shared.config.odometry import FailureConfig
from weaver_shared.messages import ImuBatch

Make = Callable[..., Twin]
MAKERS = {"gx3": (EmulatedGx3, gx3_imu), "gx5": (EmulatedGx5, gx5_imu)}
HOST_NS = 5_000_000_000
STEP_NS = 10_000_000


def shaken(count: int, start_ns: int = 0) -> ImuBatch:
    """A sensor in motion at 100 Hz."""
    phase = np.linspace(0.0, 3.0, count)[:, None] + np.arange(3)
    return ImuBatch(
        stamp_ns=start_ns + STEP_NS * np.arange(1, count + 1),
        angular_velocity_in_imu=0.5 * np.sin(phase),
        specific_force_in_imu=np.array([0.0, 0.0, 9.81]) + np.cos(phase),
    )


@pytest.mark.parametrize("kind", MAKERS)
def test_samples_come_through_with_their_stamps_on_our_clock(kind: str) -> None:
    """Bytes arrive up to 40 ms late, in heaps; stamps are those of the sensor within a millisecond."""
    device_type, make = MAKERS[kind]
    device = device_type()
    line = DirectLine(device)
    imu = make(line, 100)
    imu.take(HOST_NS)
    sent = shaken(200)
    records = device.records(sent)
    got = []
    for at in range(0, 200, 5):
        for record in records[at : at + 5]:
            line.put(record)
        late_ns = 1_000_000 + (at * 7919) % 40_000_000
        got.append(imu.take(HOST_NS + int(sent.stamp_ns[at + 4]) + late_ns))
    batch = ImuBatch.join(got)
    assert batch.specific_force_in_imu == pytest.approx(sent.specific_force_in_imu, abs=2e-6)
    assert batch.angular_velocity_in_imu == pytest.approx(sent.angular_velocity_in_imu, abs=1e-6)
    assert np.abs(np.diff(batch.stamp_ns[50:]) - STEP_NS).max() < 20_000
    assert batch.stamp_ns[-1] - HOST_NS - sent.stamp_ns[-1] == pytest.approx(1e6, abs=1.5e6)


@pytest.mark.parametrize("kind", MAKERS)
@pytest.mark.parametrize("field", ["specific_force_in_imu", "angular_velocity_in_imu"])
def test_a_blow_beyond_the_sensors_range_is_not_lost_and_the_odometry_knows_it(kind: str, field: str) -> None:
    """A sample left out would be a gap like any other, and what it hid half a metre per second."""
    device_type, make = MAKERS[kind]
    device = device_type()
    line = DirectLine(device)
    imu = make(line, 100)
    imu.take(HOST_NS)
    calm = shaken(20)
    struck = getattr(calm, field).copy()
    struck[12] = [-3.0, 0.0, 150.0]
    for beyond, sent in ((False, calm), (True, replace(shaken(20, 20 * STEP_NS), **{field: struck}))):
        for record in device.records(sent):
            line.put(record)
        batch = imu.take(HOST_NS + int(sent.stamp_ns[-1]) + 1_000_000)
        assert batch.stamp_ns.size == 20
        stream = ImuStream(FailureConfig())
        stream.add(batch)
        assert stream.take_until(int(batch.stamp_ns[-1])).unmeasured == beyond


@pytest.mark.parametrize(("kind", "length"), [("gx3", gx3.LENGTH), ("gx5", mip.LENGTH)])
def test_what_a_record_needs_on_its_way_is_taken_off_its_stamp(kind: str, length: int) -> None:
    device_type, make = MAKERS[kind]
    device = device_type()
    line = DirectLine(device)
    imu = make(line, 100, delay=0.004)
    imu.take(HOST_NS)
    sent = shaken(4)
    records = device.records(sent)
    assert [len(record) for record in records] == [length] * 4
    arrivals = HOST_NS + sent.stamp_ns
    batch = ImuBatch.join([fed(imu, line, [one], int(at)) for one, at in zip(records, arrivals, strict=True)])
    assert batch.stamp_ns[-1] == arrivals[-1] - 4_000_000


def test_an_imu_is_heard_at_once_by_a_thread_of_its_own(tmp_path: Path) -> None:
    clock, device = SimulatedClock(HOST_NS), EmulatedGx5()
    link = tmp_path / "imu"
    with closing(DeviceTerminal(link, device)) as terminal:
        line = SerialLine(str(link), 115_200)
        with closing(PunctualImu(gx5_imu(line, 100), line, clock.now_ns)) as imu:
            soon(lambda: device.streaming)
            sent = shaken(6)
            taken: list[ImuBatch] = []
            for number, (record, stamp_ns) in enumerate(zip(device.records(sent), sent.stamp_ns, strict=True)):
                clock.sleep_until(HOST_NS + int(stamp_ns))
                terminal.put(record)
                # The first is believed with the second.
                soon(lambda number=number: joined_into(taken, imu).size >= (number + 1 if number else 0))
    # Taken by a loop that has another time, their stamps are those of their arrival.
    assert ImuBatch.join(taken).stamp_ns.tolist() == (HOST_NS + sent.stamp_ns).tolist()


def test_what_came_while_the_control_loop_was_away_is_all_there() -> None:
    class Source:
        """Has a batch of two for each of the first five questions."""

        asked = 0

        def take(self, now_ns: int) -> ImuBatch:
            self.asked += 1
            return shaken(2, 2 * self.asked * STEP_NS) if self.asked <= 5 else ImuBatch.join([])

        def close(self) -> None: ...

    class Line:
        def wait(self, seconds: float) -> None: ...

    source = Source()
    with closing(PunctualImu(source, Line(), lambda: 0)) as imu:  # type: ignore[arg-type]
        soon(lambda: source.asked > 5)
        assert imu.take(0).stamp_ns.tolist() == [STEP_NS * number for number in range(3, 13)]
        assert imu.take(0).stamp_ns.size == 0


def joined_into(taken: list[ImuBatch], imu: PunctualImu) -> np.ndarray:
    taken.append(imu.take(0))
    return ImuBatch.join(taken).stamp_ns


def soon(condition: Callable[..., bool]) -> None:
    """Within half a minute of however busy a computer."""
    deadline = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.001)


@pytest.mark.parametrize("kind", MAKERS)
def test_a_device_is_told_to_send_and_told_again_when_it_falls_silent(kind: str) -> None:
    device_type, make = MAKERS[kind]
    device = device_type()
    imu = make(DirectLine(device), 100)
    assert not device.streaming
    imu.take(HOST_NS)
    assert device.streaming
    device.streaming = False
    imu.take(HOST_NS + 500_000_000)
    assert not device.streaming
    imu.take(HOST_NS + 1_500_000_000)
    assert device.streaming


def fed(imu: MicroStrainImu, line: DirectLine, records: list[bytes], now_ns: int) -> ImuBatch:
    for record in records:
        line.put(record)
    return imu.take(now_ns)


def test_a_sensor_that_repeats_itself_is_not_believed() -> None:
    device = EmulatedGx5()
    line = DirectLine(device)
    imu = gx5_imu(line, 100)
    imu.take(HOST_NS)
    frozen = [device.record(STEP_NS * tick, np.array([0.0, 0.0, 9.81]), np.zeros(3)) for tick in range(1, 60)]
    assert fed(imu, line, frozen, HOST_NS).stamp_ns.size <= 12


def test_the_gx3s_timer_may_begin_anew_after_nineteen_hours() -> None:
    device = EmulatedGx3(timer_ticks=gx3.TIMER_RANGE - 3000)
    device.streaming = True
    parser = gx3.Gx3Parser()
    records = parser.feed(b"".join(device.records(shaken(20))))
    assert len(records) == 20
    assert np.abs(np.diff([record.device_ns for record in records]) - STEP_NS).max() <= 16_001
    assert parser.jumps == 0


def test_a_restarted_device_is_believed_at_its_second_record_and_stamps_go_on() -> None:
    device = EmulatedGx5()
    line = DirectLine(device)
    imu = gx5_imu(line, 100)
    imu.take(HOST_NS)
    before = fed(imu, line, device.records(shaken(50, 7_000_000_000)), HOST_NS + 500_000_000)
    after = fed(imu, line, device.records(shaken(50)), HOST_NS + 1_000_000_000)
    assert before.stamp_ns.size == 50
    assert after.stamp_ns.size > 0
    assert (np.diff(np.concatenate([before.stamp_ns, after.stamp_ns])) > 0).all()


def test_the_vendors_own_vectors() -> None:
    """Ping and its check sums as in the vendor's tests."""
    assert mip.ping() == bytes.fromhex("756501020201E0C6")
    assert gx3.start_streaming() == bytes.fromhex("C4C129C8")
    assert len(gx3.sampling(100)) == 20


def test_numbers_that_no_sensor_measures_are_not_believed() -> None:
    device = EmulatedGx5()
    parser = mip.MipParser()
    for force in (np.array([np.nan, 0.0, 9.8]), np.array([0.0, 0.0, 200.0])):
        assert parser.feed(b"".join(device.record(STEP_NS * k, force, np.zeros(3)) for k in (1, 2, 3))) == []
    packet = mip.packet(mip.SENSOR, (mip.ACCELERATION, struct.pack(">3f", 0, 0, -1)))
    assert parser.feed(packet) == []


def test_the_clock_map_follows_drifting_clocks_and_ignores_delays() -> None:
    clock = ClockMap()
    errors = []
    for tick in range(1, 60_000):
        true_ns = tick * STEP_NS
        device_ns = round(true_ns * (1.0 - 5e-5))
        delay_ns = 200_000 + (tick * 7919 % 997) * 30_000
        clock.observe(device_ns, true_ns + delay_ns)
        errors.append(clock.at(device_ns) - true_ns)
    assert np.abs(errors[2000:]).max() < 1_500_000
    assert clock.resets == 0


def test_power_lines_are_read_and_gaps_counted() -> None:
    lines = [encode(PowerRecord(s, 11 * s, 25_900, 4_321 - 1000 * s, 17, 1)) for s in range(8)]
    assert {len(line) for line in lines} == {LINE_LENGTH}
    parser = PowerParser()
    records = parser.feed(lines[0][:20]) + parser.feed(lines[0][20:] + lines[1] + lines[4] + b"$PWR,000" + lines[5])
    assert [record.sequence for record in records] == [0, 1, 4, 5]
    assert parser.lost == 2
    assert records[3].milliamperes == -679


def test_energy_survives_lost_lines_and_the_relay_hears_our_heart() -> None:
    device = EmulatedPowerMonitor()
    line = DirectLine(device)
    monitor = PowerMonitor(line)
    reading = None
    for tick in range(901):
        now_ns = HOST_NS + tick * 11_111_111
        sent = device.line(now_ns, 25.0, 4.0)
        if tick % 3 != 1:
            line.put(sent)
        reading = monitor.take(now_ns) or reading
    assert reading is not None
    assert reading.energy == pytest.approx(25.0 * 4.0 * 10.0, rel=0.01)
    assert reading.current == 4.0
    assert device.heartbeats == pytest.approx(91, abs=2)


def test_a_body_has_the_samples_and_the_battery_of_its_lines(make_twin: Make) -> None:
    twin = make_twin()
    sizes = []
    for _ in range(30):
        twin.body.wait_next()
        sensed = twin.body.read()
        sizes.append(sensed.imu.stamp_ns.size)
    assert sum(sizes) == pytest.approx(60, abs=6)
    assert sensed.imu.specific_force_in_imu.mean(axis=0) == pytest.approx([0.0, 0.0, 9.81], abs=0.1)
    assert 25.0 < sensed.battery_voltage < 29.5
    assert sensed.motor_power == pytest.approx(27.0, abs=3.0)


def test_silent_lines_are_silence_to_the_body(make_twin: Make) -> None:
    twin = make_twin()
    twin.run(10)
    twin.sensors.imu_line.plugged = twin.sensors.power_line.plugged = False
    twin.run(3)
    assert twin.body.read().imu.stamp_ns.size == 0
    assert np.isfinite(twin.body.read().battery_voltage)
    twin.run(110)
    assert np.isnan(twin.body.read().battery_voltage)
