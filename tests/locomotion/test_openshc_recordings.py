"""The compatibility mode equals what OpenSHC 0.5.11 itself recorded, over every recording at hand."""

import csv
import gzip
import json
from pathlib import Path

import numpy as np
import pytest

from robot_agent.locomotion.openshc.admittance import Admittance
from robot_agent.locomotion.openshc.body_pose import BodyPose
from robot_agent.locomotion.openshc.leg import Leg
from robot_agent.locomotion.openshc.limits import SpeedLimits, walkspace
from robot_agent.locomotion.openshc.reading import read_configuration, sections_of, with_settings
from robot_agent.locomotion.openshc.run import run
from robot_agent.locomotion.openshc.script import events_of
from robot_agent.locomotion.openshc.settings import Settings
from robot_agent.locomotion.openshc.shipped import LEGS, ROBOTS, shipped
from robot_agent.locomotion.openshc.start_up import standing_joints
from robot_agent.locomotion.openshc.step_cycle import StepCycle
from robot_agent.locomotion.openshc.table import BODY_COLUMNS, body_row, leg_rows
from robot_agent.locomotion.openshc.workspace import workspace
from robot_agent.locomotion.trajectory_table import columns

DATA = Path(__file__).resolve().parents[2] / ".." / "shared" / "data" / "openshc"
pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason=f"the OpenSHC recordings are not at {DATA}")

TIP, JOINT = 1e-8, 1e-7
"""m while moving and at rest; rad while moving. At rest the solver's null-space motion amplifies rounding."""
MOVING = 1

VELOCITY = "6 velocity {}\n{} velocity 0 0 0"
MANUAL_POSE = """
  6 pose 1 0 0  0 0 0
 36 pose 0 -1 0.5  0.5 0 0
 66 pose 0 0 0  0 -1 1
 96 pose 0 0 0  0 0 0
 96 reset all
216 reset no_reset
"""
RECORDED = {
    "default_tripod_gait_fwd": ("default", "gait_type=tripod_gait", VELOCITY.format("1 0 0", 6 + 308)),
    "default_ripple_gait_mix": ("default", "gait_type=ripple_gait", VELOCITY.format("0.5 0.3 0.2", 6 + 412)),
    "default_wave_gait_turn": ("default", "gait_type=wave_gait", VELOCITY.format("0 0 0.5", 6 + 724)),
    "bullet_tripod_gait_fwd": ("bullet_insectoid", "gait_type=tripod_gait", VELOCITY.format("1 0 0", 6 + 468)),
    "bullet_bipod_gait_mix": ("bullet_insectoid", "gait_type=bipod_gait", VELOCITY.format("0.5 0.3 0.2", 6 + 364)),
    "start_direct": ("default", "start_up_sequence=false", "0 state running"),
    "manual_pose": ("default", "manual_posing=true", MANUAL_POSE),
    "auto_pose_tripod_gait": ("default", "auto_posing=true", VELOCITY.format("0.5 0 0", 6 + 258)),
}


def test_every_recording_at_hand_is_compared():
    assert set(RECORDED) == {path.name.removesuffix("_legs.csv.gz") for path in DATA.glob("*_legs.csv.gz")}


@pytest.mark.parametrize("name", RECORDED)
def test_a_run_equals_its_recording(name):
    robot, setting, script = RECORDED[name]
    description = with_settings(shipped(robot), [setting])
    with gzip.open(DATA / f"{name}_legs.csv.gz", "rt") as stream:
        header, *legs = csv.reader(stream)
    with open(DATA / f"{name}_body.csv") as stream:
        body_header, *body = csv.reader(stream)
    assert header == columns(description.joints_per_leg)
    assert body_header == list(BODY_COLUMNS)

    recorded_body = np.array(body, dtype=float)
    recorded = np.array([row[2:] for row in legs], dtype=float).reshape(len(body), 6, -1)
    found, found_body = np.empty_like(recorded), np.empty_like(recorded_body)
    for tick, controller in run(
        description, events_of(script), ticks=len(body) - 1, from_rest=name.startswith("start")
    ):
        found[tick] = [[float(text) for text in row[2:]] for row in leg_rows(tick, controller)]
        found_body[tick] = [float(text) for text in body_row(tick, controller)]

    moving = recorded_body[:, BODY_COLUMNS.index("walk_state")] == MOVING
    of_joints = np.array([name[0] in "qd" and name[-1].isdigit() for name in header[2:]])
    of_rotation = np.array([name.startswith("model_q") for name in header[2:]])
    rates = np.array([name.startswith("dq") for name in header[2:]])
    exact = ~of_joints & ~of_rotation
    np.testing.assert_allclose(found[:, :, exact], recorded[:, :, exact], rtol=0, atol=TIP)
    np.testing.assert_allclose(found_body, recorded_body, rtol=0, atol=TIP)
    found, recorded = found[moving], recorded[moving]
    of_angles = of_rotation | (of_joints & ~rates)
    np.testing.assert_allclose(found[:, :, of_angles], recorded[:, :, of_angles], rtol=0, atol=JOINT)
    # a rate is a difference of two angles over a tick
    assert np.abs(found[:, :, rates] - recorded[:, :, rates]).max(initial=0.0) < 2 * JOINT / description.time_delta


@pytest.mark.parametrize("name", ["admittance_step_z10", "admittance_step_x5_z10"])
def test_a_pushed_foot_gives_way_as_recorded(name):
    description = shipped("default")
    (_, controller), *_ = run(description, [], ticks=0, from_rest=False)
    directions = np.array([leg.tip_frame()[:3, 0] for leg in controller.legs])
    admittance, forces = Admittance(Settings(description), 6), np.zeros((6, 3))
    forces[0] = (5.0 if "x5" in name else 0.0, 0.0, 10.0)
    with open(DATA / f"{name}.csv") as stream:
        for row in csv.DictReader(stream):
            admittance.update(forces, directions)
            np.testing.assert_allclose(admittance.state[0], [float(row["x0"]), float(row["x1"])], atol=1e-12)
            expected = [float(row[f"proj_delta_{axis}"]) for axis in "xyz"]
            np.testing.assert_allclose(admittance.offsets[0], expected, atol=1e-11)


def test_step_cycles_equal_the_recorded_table():
    gaits = shipped("bullet_insectoid").gaits
    with open(DATA / "step_cycles.csv") as stream:
        for row in csv.DictReader(stream):
            frequency, dt = float(row["step_frequency_param"]), float(row["dt"])
            cycle = StepCycle.of(gaits[row["gait"]], frequency, dt, LEGS)
            assert cycle.period == int(row["period_ticks"])
            assert cycle.frequency == pytest.approx(float(row["frequency_hz"]), rel=1e-8)
            assert (cycle.swing_start, cycle.swing_end) == (int(row["swing_start"]), int(row["swing_end"]))
            assert (cycle.stance_start, cycle.stance_end) == (int(row["stance_start"]), int(row["stance_end"]))
            assert cycle.offsets == tuple(int(row[f"off_{leg}"]) for leg in LEGS)


def test_one_solver_step_equals_600_recorded_ones():
    legs = {leg.name: leg for leg in shipped("default").legs}
    with open(DATA / "fkik_default.csv") as stream:
        for row in csv.DictReader(stream):
            start = np.array([float(row[f"q{k}"]) for k in range(3)])
            chain = Leg(legs[row["leg"]], 0.02, clamp_rate=False, start=start)
            np.testing.assert_allclose(chain.tip(), [float(row[f"fk_{a}"]) for a in "xyz"], atol=1e-11)
            result = chain.step_to(np.array([float(row[f"des_{a}"]) for a in "xyz"]))
            np.testing.assert_allclose(chain.position, [float(row[f"q_after{k}"]) for k in range(3)], atol=1e-10)
            np.testing.assert_allclose(chain.rate, [float(row[f"dq_after{k}"]) for k in range(3)], atol=1e-8)
            np.testing.assert_allclose(chain.tip(), [float(row[f"tip_after_{a}"]) for a in "xyz"], atol=1e-10)
            assert result == pytest.approx(float(row["ik_result"]), abs=1e-9)


def standing(robot):
    description = shipped(robot)
    pose = BodyPose(np.array([0.0, 0.0, description.body_clearance]))
    legs = [Leg(leg, description.time_delta, clamp_rate=description.clamp_joint_velocities) for leg in description.legs]
    for leg, joints in zip(legs, standing_joints(description, legs, pose), strict=True):
        leg.position = joints
    return description, [workspace(leg, pose.into(leg.description.place), layered=False) for leg in legs]


def test_the_workspace_equals_the_recorded_one():
    _, spaces = standing("default")
    with open(DATA / "workspace_default.csv") as stream:
        for row in csv.DictReader(stream):
            radius = spaces[LEGS.index(row["leg"])].at(float(row["height_m"]))[int(row["bearing_deg"])]
            assert radius == pytest.approx(float(row["radius_m"]), abs=1e-9)


@pytest.mark.parametrize(("robot", "name"), [("default", "default"), ("bullet_insectoid", "bullet")])
def test_speed_limits_equal_the_recorded_ones(robot, name):
    description, spaces = standing(robot)
    stance = np.array([leg.place for leg in description.legs])
    dt, frequency = description.time_delta, description.step_frequency.default
    cycle = StepCycle.of(description.gaits["tripod_gait"], frequency, dt, LEGS)
    radii = walkspace(stance, spaces)
    limits = SpeedLimits.of(radii, cycle, stance[0, :2])
    with open(DATA / f"{name}_tripod_gait_limits.csv") as stream:
        for row in csv.DictReader(stream):
            bearing = int(row["bearing_deg"])
            assert radii[bearing] == pytest.approx(float(row["walkspace_m"]), rel=1e-9)
            assert limits.linear[bearing] == pytest.approx(float(row["max_lin_speed"]), rel=1e-8)
            assert limits.angular[bearing] == pytest.approx(float(row["max_ang_speed"]), rel=1e-8)
            assert limits.linear_acceleration[bearing] == pytest.approx(float(row["max_lin_acc"]), rel=1e-8)
            assert limits.angular_acceleration[bearing] == pytest.approx(float(row["max_ang_acc"]), rel=1e-8)


@pytest.mark.parametrize("name", ROBOTS)
def test_shipped_robots_have_the_recorded_parameters(name):
    path = DATA / f"config_{name}.json"
    assert read_configuration([path]) == shipped(name)
    assert sections_of(shipped(name)) == json.loads(path.read_text())
