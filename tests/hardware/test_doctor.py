"""Whatever is wrong with a robot's wiring, servos or sensors, the doctor names it, and a sound robot passes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hardware_bodies import PATIENT

from robot_agent.command_line import doctor
from robot_agent.hardware.cameras.source import CameraHealth
from robot_agent.hardware.doctor import Examination, Finding, Verdict
from robot_agent.hardware.doctor.adapter import judge_adapter
from robot_agent.hardware.imu.stream import gx3_imu, gx5_imu
from robot_agent.hardware.power_monitor import PowerMonitor
from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.wiring import Wiring
from sim_agent.model import sitting_joints
from sim_agent.sensor_lines import EmulatedGx3, EmulatedGx5
from sim_agent.servo_bus import EmulatedServo
from sim_agent.servo_bus.joints import FirstOrderJoints
from sim_agent.servo_bus.twin import TwinServos, TwinTerminals
from sim_agent.servo_bus.twin_wiring import twin_wiring, wiring_file
from sim_agent.servo_bus.virtual_port import VirtualPort
from sim_agent.servo_bus.wire import VirtualLineClock
from sim_agent.still_lines import StillImuLine, StillPowerLine
from weaver_shared.config.hardware import ImuLine, ServoSettings
from weaver_shared.errors import ConfigurationError, ResourceError
from weaver_shared.messages import StereoFrame
from weaver_shared.robots import load_robot

GOOD, ATTENTION, WRONG, NOT_TESTED = Verdict.GOOD, Verdict.ATTENTION, Verdict.WRONG, Verdict.NOT_TESTED
WEAVER = load_robot("weaver")


class Patient:
    """A sitting robot on emulated buses whose time is a variable, with its sensors, and what the doctor says of it."""

    def __init__(self, folder: Path, settings: ServoSettings | None = None, *, adapter_latency: float = 1e-3) -> None:
        self.wiring = Wiring(twin_wiring(WEAVER, folder, settings=settings), WEAVER)
        start = self.wiring.shaft(sitting_joints(WEAVER))
        self.twin = TwinServos(
            self.wiring,
            lambda servos: FirstOrderJoints(servos, start=start, most_steps=4),
            adapter_latency=adapter_latency,
        )
        for servo in self.twin.servos:
            servo.table[r.RETURN_DELAY] = 0
        self.clock = VirtualLineClock(1_000_000_000)
        self.ports = {name: VirtualPort(bus, self.clock, name) for name, bus in self.twin.buses.items()}

    def servo(self, joint: str) -> EmulatedServo:
        return self.twin.servos[WEAVER.joint_names.index(joint)]

    def examined(self, *, cycles: int = 20, hung_up: bool = False, **changes: object) -> dict[str, Finding]:
        given = {
            "ports": self.ports,
            "seconds": 1.0,
            "adapters": Path("/nowhere"),
        }
        examination = Examination(
            wiring=self.wiring, clock=self.clock, cycles=cycles, hung_up=hung_up, **(given | changes)
        )
        return {finding.check: finding for finding in examination.run()}


@pytest.fixture
def patient(tmp_path: Path) -> Patient:
    return Patient(tmp_path)


def verdicts(findings: dict[str, Finding], verdict: Verdict) -> set[str]:
    return {name for name, finding in findings.items() if finding.verdict is verdict}


def test_nothing_is_wrong_with_a_sound_robot(patient: Patient) -> None:
    imu, power = gx5_imu(StillImuLine(EmulatedGx5(), WEAVER.imu), 200), PowerMonitor(StillPowerLine())
    findings = patient.examined(hung_up=True, imu=imu, power=power)
    assert verdicts(findings, GOOD) == {
        "scan of bus left",
        "scan of bus right",
        "return delay time",
        "servo supply and heat",
        "servos made ready",
        "cyclic reading",
        "watchdog",
        "IMU at rest",
        "power monitor",
    }
    assert verdicts(findings, NOT_TESTED) == {
        "latency timer of bus left",
        "latency timer of bus right",
        "motor relay",
        "cameras",
    }
    assert findings["cyclic reading"].figures["failed"] == 0
    # Question, answers and adapter of 15 servos a bus at 3 Mbit/s.
    assert 2.0 < findings["cyclic reading"].figures["median_ms"] < 3.6
    assert findings["IMU at rest"].figures["rate_hz"] == pytest.approx(200.0, rel=0.01)
    assert findings["IMU at rest"].figures["gravity"] == pytest.approx(9.81, abs=0.05)
    assert findings["power monitor"].figures["battery_v"] == pytest.approx(27.0, abs=0.01)


def test_torque_comes_on_only_for_a_robot_that_hangs_and_goes_again(patient: Patient) -> None:
    def torque_was_on() -> bool:
        # Torque enable (64) as a sync write of ones.
        return any(b"\x83\x40\x00\x01\x00\x01\x01" in sent or b"\x83\x40\x00\x01\x00\x10\x01" in sent
                   for port in patient.ports.values() for sent in port.questions)  # fmt: skip

    assert patient.examined()["watchdog"].verdict is NOT_TESTED
    assert not torque_was_on()
    assert patient.examined(hung_up=True)["watchdog"].verdict is GOOD
    assert torque_was_on()
    assert not any(servo.table[r.TORQUE_ENABLE] for servo in patient.twin.servos)


def test_a_robot_that_stands_on_its_servos_is_left_standing(patient: Patient) -> None:
    patient.examined()
    for servo in patient.twin.servos:
        servo.table[r.TORQUE_ENABLE] = 1
    findings = patient.examined(hung_up=True)
    assert findings["watchdog"].verdict is NOT_TESTED
    assert all(servo.table[r.TORQUE_ENABLE] for servo in patient.twin.servos)


def test_a_silent_servo_is_named_and_the_others_are_read(patient: Patient) -> None:
    patient.servo("BR_femur").alive = False
    findings = patient.examined()
    scan = findings["scan of bus right"]
    assert scan.figures["missing"] == ["BR_femur (id 8)"]
    assert scan.verdict is WRONG
    assert findings["servos made ready"].figures["ready"] == 29
    assert findings["cyclic reading"].verdict is GOOD


def test_a_foreign_servo_is_told(patient: Patient) -> None:
    patient.twin.buses["left"].servos.append(EmulatedServo(200, r.MODELS[311]))
    finding = patient.examined()["scan of bus left"]
    assert finding.verdict is ATTENTION
    assert "id 200 (MX-64)" in finding.found


def test_two_servos_with_one_id_are_told(patient: Patient) -> None:
    bus = patient.twin.buses["right"]
    bus.servos.append(EmulatedServo(bus.servos[0].id, r.MODELS[311]))
    finding = patient.examined()["scan of bus right"]
    assert finding.verdict is WRONG
    assert finding.figures["twice"] == [bus.servos[0].id]


def test_a_wrong_model_and_old_firmware_are_told(patient: Patient) -> None:
    patient.servo("AR_yaw").table[r.FIRMWARE] = 38
    wrong = patient.servo(WEAVER.joint_names[1])
    wrong.table[r.MODEL_NUMBER] = 311 if wrong.table[r.MODEL_NUMBER] == 321 else 321
    finding = patient.examined()["scan of bus right"]
    assert finding.verdict is WRONG
    assert "AR_yaw has 38" in finding.found
    assert f"{WEAVER.joint_names[1]} is " in finding.found


def test_a_factory_return_delay_is_told_and_set(patient: Patient) -> None:
    patient.servo("AR_yaw").table[r.RETURN_DELAY] = 250
    finding = patient.examined()["return delay time"]
    assert finding.verdict is ATTENTION
    assert finding.figures["longest_us"] == pytest.approx(500.0)
    assert patient.examined()["return delay time"].verdict is GOOD


def test_low_rail_and_hot_servos_are_told(patient: Patient) -> None:
    patient.servo("AR_yaw").voltage = 10.1
    patient.servo("BR_yaw").temperature = 66.0
    finding = patient.examined()["servo supply and heat"]
    assert finding.verdict is WRONG
    assert "AR_yaw" in finding.fix
    assert "BR_yaw" in finding.fix


def test_lost_answers_are_counted(patient: Patient) -> None:
    patient.examined()
    patient.twin.buses["left"].troubles.lost_answers = 0.02
    figures = patient.examined(cycles=100)["cyclic reading"].figures
    # One of 15 answers is lost in a quarter of the cycles.
    assert 12 <= figures["failed"] <= 45
    assert figures["misses"]


def test_an_adapter_that_keeps_bytes_makes_the_reading_too_slow(tmp_path: Path) -> None:
    patient = Patient(tmp_path, ServoSettings(answer_margin=0.03), adapter_latency=16e-3)
    finding = patient.examined()["cyclic reading"]
    assert finding.verdict is WRONG
    assert finding.figures["failed"] == 0
    assert finding.figures["median_ms"] > 16.0
    assert "latency timer" in finding.fix


def test_a_servo_whose_watchdog_sleeps_is_named(patient: Patient, monkeypatch: pytest.MonkeyPatch) -> None:
    sleeper = patient.servo("AR_yaw")

    def elapse(now_ns: int, whole: object = sleeper.elapse) -> None:
        sleeper.fed(now_ns)
        whole(now_ns)  # type: ignore[operator]

    monkeypatch.setattr(sleeper, "elapse", elapse)
    finding = patient.examined(hung_up=True)["watchdog"]
    assert finding.verdict is WRONG
    assert finding.figures["not_stopped"] == ["AR_yaw"]


def test_latency_timers_are_read_from_the_adapters_driver(tmp_path: Path) -> None:
    (tmp_path / "ttyUSB3").mkdir()
    (tmp_path / "name").symlink_to("/dev/ttyUSB3")
    for latency, verdict in ((1, GOOD), (16, WRONG)):
        (tmp_path / "ttyUSB3" / "latency_timer").write_text(f"{latency}\n")
        assert judge_adapter("left", str(tmp_path / "name"), tmp_path).verdict is verdict


@pytest.mark.parametrize("speed", [0.5, 1.1])
def test_an_imu_at_a_wrong_rate_is_told(patient: Patient, speed: float) -> None:
    line = StillImuLine(EmulatedGx3(), WEAVER.imu, speed=speed)
    finding = patient.examined(imu=gx3_imu(line, 200))["IMU at rest"]
    assert finding.verdict is WRONG
    assert finding.figures["rate_hz"] == pytest.approx(200.0 * speed, rel=0.01)


def test_an_imu_that_is_shaken_or_silent_is_told(patient: Patient) -> None:
    noisy = WEAVER.imu.model_copy(update={"gyro_noise_density": 10 * WEAVER.imu.gyro_noise_density})
    shaken = patient.examined(imu=gx5_imu(StillImuLine(EmulatedGx5(), noisy), 200))["IMU at rest"]
    assert shaken.verdict is WRONG
    assert shaken.figures["gyro_noise_ratio"] == pytest.approx(10.0, rel=0.2)
    silent = StillImuLine(EmulatedGx5(), WEAVER.imu)
    silent.plugged = False
    assert patient.examined(imu=gx5_imu(silent, 200))["IMU at rest"].figures == {"samples": 0}


def test_an_empty_battery_and_a_silent_monitor_are_told(patient: Patient) -> None:
    line = StillPowerLine(voltage=23.9)
    assert "charge" in patient.examined(power=PowerMonitor(line))["power monitor"].fix
    line.plugged = False
    assert patient.examined(power=PowerMonitor(line))["power monitor"].figures == {"readings": 0}


def test_what_is_not_wired_is_not_tested_and_a_missing_port_is_wrong(patient: Patient) -> None:
    gone = ResourceError("port /dev/left can not be opened")
    findings = patient.examined(imu=None, power=gone, ports={**patient.ports, "left": gone})
    assert findings["IMU at rest"].verdict is NOT_TESTED
    assert findings["power monitor"].verdict is WRONG
    assert findings["port of bus left"].found == str(gone)
    assert findings["scan of bus right"].verdict is GOOD
    assert findings["servos made ready"].figures == {"ready": 15, "wired": 30, "refusals": []}
    assert findings["cyclic reading"].verdict is GOOD


def test_the_command_examines_servos_behind_real_ports(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    config = twin_wiring(WEAVER, tmp_path, settings=PATIENT)
    wiring = Wiring(config, WEAVER)
    start = wiring.shaft(sitting_joints(WEAVER))
    servos = TwinServos(wiring, lambda servos: FirstOrderJoints(servos, start=start, most_steps=4))
    servos.servos[4].alive = False
    path = tmp_path / "robot.toml"
    path.write_text(wiring_file(config))
    with TwinTerminals(servos, paced=False):
        assert doctor.main([str(path), "--cycles", "3", "--json"]) == 1
    answer = json.loads(capsys.readouterr().out)
    verdicts = {finding["check"]: finding["verdict"] for finding in answer["findings"]}
    assert answer["wrong"][:2] == ["scan of bus right", "servos made ready"]
    assert verdicts["scan of bus left"] == "good"
    assert verdicts["cyclic reading"] != "not tested"
    assert verdicts["watchdog"] == verdicts["cameras"] == "not tested"


def test_ports_that_are_not_there_are_a_plain_answer(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "robot.toml"
    imu = ImuLine(kind="gx5", port=str(tmp_path / "imu"))
    path.write_text(wiring_file(twin_wiring(WEAVER, tmp_path).model_copy(update={"imu": imu})))
    assert doctor.main([str(path)]) == 1
    told = capsys.readouterr().out
    assert f"WRONG       port of bus left: port {tmp_path / 'left'} can not be opened" in told
    assert "wrong: port of bus right, port of bus left, IMU at rest" in told


def test_a_wiring_that_is_none_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="No such file"):
        doctor.main([str(tmp_path / "nothing.toml")])


def relayed(patient: Patient, *, wired: bool = True) -> PowerMonitor:
    """A power monitor whose relay feeds the servos, or lies beside their supply."""
    line = StillPowerLine()

    def switch(closed: bool) -> None:
        for servo in patient.twin.servos:
            servo.alive = closed or not wired

    line.monitor.on_relay = switch
    return PowerMonitor(line)


def test_the_relay_is_opened_only_under_a_robot_that_lies_and_is_closed_again(patient: Patient) -> None:
    power = relayed(patient)
    assert patient.examined(power=power)["motor relay"].verdict is NOT_TESTED
    finding = patient.examined(power=power, lying=True)["motor relay"]
    assert finding.verdict is GOOD
    assert finding.figures == {"before": 30, "silent": 30, "back": 30}
    assert power.relay_closed


def test_a_relay_that_feeds_nobody_is_found(patient: Patient) -> None:
    finding = patient.examined(power=relayed(patient, wired=False), lying=True)["motor relay"]
    assert finding.verdict is WRONG
    assert "keep their power" in finding.fix


class Pairs:
    """A source of pairs at such steps (ms) on the patient's clock."""

    def __init__(self, clock: VirtualLineClock, steps: list[float]) -> None:
        self._clock, self._steps, self._given = clock, steps, 0

    def read(self, timeout: float) -> StereoFrame | None:
        if self._given >= len(self._steps):
            self._clock.forward(seconds=timeout)
            return None
        self._clock.forward(seconds=self._steps[self._given] * 1e-3)
        self._given += 1
        picture = np.zeros((2, 2), dtype=np.uint8)
        return StereoFrame(stamp_ns=self._clock.now_ns(), sequence=self._given, left=picture, right=picture)

    def health(self) -> CameraHealth:
        return CameraHealth(pairs=self._given, lost=0, trouble="")

    def close(self) -> None: ...


@pytest.mark.parametrize(
    ("steps", "verdict", "words"),
    [
        ([50.0] * 40, GOOD, ""),
        ([50.0, 60.0, 40.0, 50.0] * 10, WRONG, "uneven"),
        ([], WRONG, "trigger's wire"),
    ],
)
def test_the_cameras_stamps_tell_of_their_trigger(
    patient: Patient, steps: list[float], verdict: Verdict, words: str
) -> None:
    finding = patient.examined(cameras=Pairs(patient.clock, steps))["cameras"]
    assert finding.verdict is verdict
    assert words in finding.fix
    assert sum(bar["cycles"] for bar in finding.figures.get("histogram", [])) == max(min(len(steps), 20) - 1, 0)
