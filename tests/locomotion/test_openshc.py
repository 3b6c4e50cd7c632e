"""The compatibility mode equals OpenSHC 0.5.11's own recordings, and its parameters equal the recorded ones."""

import csv
import gzip
import json
from pathlib import Path

import numpy as np
import pytest

from robot_agent.command_line import gait as gait_command
from robot_agent.locomotion.openshc.leg import Leg
from robot_agent.locomotion.openshc.limits import SpeedLimits, walkspace, workspace
from robot_agent.locomotion.openshc.robots import LEGS, ROBOTS, robot_of
from robot_agent.locomotion.openshc.start_states import START_STATES
from robot_agent.locomotion.openshc.step_cycle import StepCycle
from robot_agent.locomotion.openshc.walk import MOVING, Walk
from weaver_shared.errors import ConfigurationError

DATA = Path(__file__).resolve().parents[2] / ".." / "shared" / "data" / "openshc"
needs_recordings = pytest.mark.skipif(not DATA.is_dir(), reason=f"the OpenSHC recordings are not at {DATA}")
TIP, JOINT = 1e-8, 1e-7


class Recording:
    def __init__(self, name: str, joints: int) -> None:
        with gzip.open(DATA / f"{name}_legs.csv.gz", "rt") as stream:
            rows = list(csv.DictReader(stream))
        with open(DATA / f"{name}_body.csv") as stream:
            self.body = list(csv.DictReader(stream))
        names = [f"q{k}" for k in range(joints)]
        self.tip = self._array(rows, ["walker_x", "walker_y", "walker_z"])
        self.model = self._array(rows, ["model_x", "model_y", "model_z"])
        self.joints = self._array(rows, names)
        self.rates = self._array(rows, ["d" + name for name in names])
        self.phase = self._array(rows, ["phase"])[:, :, 0]
        self.state = np.array([int(row["walk_state"]) for row in self.body])
        self.command = np.array([[float(row[f"in_{k}"]) for k in ("vx", "vy", "wz")] for row in self.body])

    @staticmethod
    def _array(rows, names):
        return np.array([[float(row[name]) for name in names] for row in rows]).reshape(-1, 6, len(names))


@needs_recordings
@pytest.mark.parametrize(
    ("name", "robot", "gait"),
    [
        ("default_tripod_gait_fwd", "default", "tripod_gait"),
        ("default_ripple_gait_mix", "default", "ripple_gait"),
        ("default_wave_gait_turn", "default", "wave_gait"),
        ("bullet_tripod_gait_fwd", "bullet_insectoid", "tripod_gait"),
        ("bullet_bipod_gait_mix", "bullet_insectoid", "bipod_gait"),
    ],
)
def test_walking_equals_the_recording(name, robot, gait):
    walk = Walk(robot_of(robot), gait)
    recording = Recording(name, walk.robot.joints)
    moving = np.flatnonzero(recording.state == MOVING)
    for tick in range(1, moving[-1] + 1):
        walk.tick(recording.command[tick, :2], recording.command[tick, 2])
        tips = np.array([path.tip for path in walk.paths])
        np.testing.assert_allclose(tips, recording.tip[tick], atol=TIP)
        np.testing.assert_array_equal(walk.phase, recording.phase[tick])
        if tick == moving[0]:
            # At rest the five-joint solver amplifies the recording's rounding, so joints are compared from here on.
            for leg in range(6):
                walk.legs[leg].position = recording.joints[tick, leg].copy()
                walk.legs[leg].rate = recording.rates[tick, leg].copy()
        elif tick > moving[0]:
            joints = np.array([leg.position for leg in walk.legs])
            np.testing.assert_allclose(joints, recording.joints[tick], atol=JOINT)
            np.testing.assert_allclose([leg.tip() for leg in walk.legs], recording.model[tick], atol=TIP)


@needs_recordings
def test_stopping_equals_the_recording_to_the_last_tick():
    walk = Walk(robot_of("default"), "ripple_gait")
    recording = Recording("default_ripple_gait_mix", 3)
    for tick in range(1, len(recording.body)):
        walk.tick(recording.command[tick, :2], recording.command[tick, 2])
        assert walk.state == recording.state[tick]
        np.testing.assert_allclose([path.tip for path in walk.paths], recording.tip[tick], atol=TIP)


@needs_recordings
def test_step_cycles_equal_the_recorded_table():
    with open(DATA / "step_cycles.csv") as stream:
        for row in csv.DictReader(stream):
            cycle = StepCycle.of(row["gait"], float(row["step_frequency_param"]), float(row["dt"]))
            assert cycle.period == int(row["period_ticks"])
            assert (cycle.swing_start, cycle.swing_end) == (int(row["swing_start"]), int(row["swing_end"]))
            assert cycle.offsets == tuple(int(row[f"off_{leg}"]) for leg in LEGS)


@needs_recordings
def test_one_solver_step_equals_600_recorded_ones():
    robot = robot_of("default")
    with open(DATA / "fkik_default.csv") as stream:
        for row in csv.DictReader(stream):
            leg = LEGS.index(row["leg"])
            start = np.array([float(row[f"q{k}"]) for k in range(3)])
            chain = Leg(robot.dh[leg], robot.limits[leg], robot.max_rate, False, robot.dt, start)
            np.testing.assert_allclose(chain.tip(), [float(row[f"fk_{a}"]) for a in "xyz"], atol=1e-11)
            result = chain.step_to(np.array([float(row[f"des_{a}"]) for a in "xyz"]))
            np.testing.assert_allclose(chain.position, [float(row[f"q_after{k}"]) for k in range(3)], atol=1e-10)
            assert result == pytest.approx(float(row["ik_result"]), abs=1e-9)


@needs_recordings
def test_workspace_and_limits_equal_the_recorded_ones():
    robot = robot_of("default")
    with gzip.open(DATA / "start_direct_legs.csv.gz", "rt") as stream:
        ready = [row for row in csv.DictReader(stream) if row["tick"] == "301"]
    spaces = []
    for leg, row in enumerate(ready):
        start = np.array([float(row[f"q{k}"]) for k in range(3)])
        chain = Leg(robot.dh[leg], robot.limits[leg], robot.max_rate, True, robot.dt, start)
        spaces.append(workspace(chain, np.array([*robot.stance[leg], -robot.clearance])))
    with open(DATA / "workspace_default.csv") as stream:
        for row in csv.DictReader(stream):
            radius = spaces[LEGS.index(row["leg"])][int(row["bearing_deg"])]
            assert radius == pytest.approx(float(row["radius_m"]), abs=1e-9)
    radii = walkspace(robot.stance, spaces)
    limits = SpeedLimits.of(radii, StepCycle.of("tripod_gait", 1.0, 0.02), robot.stance, 0.02)
    with open(DATA / "default_tripod_gait_limits.csv") as stream:
        for row in csv.DictReader(stream):
            bearing = int(row["bearing_deg"])
            assert radii[bearing] == pytest.approx(float(row["walkspace_m"]), rel=1e-9)
            assert radii[bearing] == pytest.approx(START_STATES["default"].walkspace[bearing // 45 % 4], rel=1e-9)
            assert limits.linear[bearing] == pytest.approx(float(row["max_lin_speed"]), rel=1e-8)
            assert limits.angular_acceleration[bearing] == pytest.approx(float(row["max_ang_acc"]), rel=1e-8)


@needs_recordings
@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_robot_parameters_equal_the_recorded_configuration(name):
    robot = ROBOTS[name]
    parameters = json.loads((DATA / f"config_{name}.json").read_text())["syropod"]["parameters"]
    assert robot.dt == parameters["time_delta"]
    assert robot.clearance == parameters["body_clearance"]
    assert robot.swing_height == parameters["swing_height"]["default"]
    assert robot.step_frequency == parameters["step_frequency"]["default"]
    assert robot.clamp_rate == parameters["clamp_joint_velocities"]
    for leg, leg_name in enumerate(LEGS):
        place = parameters[f"{leg_name}_stance_position"]
        np.testing.assert_array_equal(robot.stance[leg], [place["x"], place["y"]])
        for row, link in enumerate(parameters["link_id"]):
            values = parameters[f"{leg_name}_{link}_link_parameters"]
            np.testing.assert_array_equal(robot.dh[leg, row], [values[k] for k in ("theta", "d", "r", "alpha")])
        for row, joint in enumerate(parameters["joint_id"]):
            values = parameters[f"{leg_name}_{joint}_joint_parameters"]
            np.testing.assert_array_equal(robot.limits[leg, row], [values["min"], values["max"]])


def test_the_command_writes_the_recorded_columns(tmp_path):
    target = tmp_path / "out.csv"
    arguments = ["--robot", "default", "--gait", "tripod_gait", "--velocity", "1,0,0", "--ticks", "30"]
    assert gait_command.main([*arguments, "--compat", "openshc-0.5.11", "--csv", str(target)]) == 0
    lines = target.read_text().splitlines()
    assert len(lines) == 1 + 31 * 6
    if DATA.is_dir():
        with gzip.open(DATA / "default_tripod_gait_fwd_legs.csv.gz", "rt") as stream:
            assert lines[0] == stream.readline().strip()


def test_the_mammalian_robot_walks_too():
    walk = Walk(robot_of("bullet_mammalian"), "bipod_gait")
    for _ in range(200):
        walk.tick(np.array([0.5, 0.0]), 0.0)
    assert walk.linear[0] > 0.05
    assert np.isfinite([leg.position for leg in walk.legs]).all()


@pytest.mark.parametrize(
    "arguments",
    [
        ["--compat", "openshc-9"],
        ["--compat", "openshc-0.5.11", "--robot", "weaver"],
        ["--compat", "openshc-0.5.11", "--robot", "default", "--gait", "tripod"],
    ],
)
def test_what_openshc_does_not_know_is_answered_with_what_it_does(arguments):
    with pytest.raises(ConfigurationError, match="known"):
        gait_command.main(arguments)
