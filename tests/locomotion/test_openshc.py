"""What OpenSHC is known to do, by the figures measured on it; none of it needs the recordings."""

import csv
import io

import numpy as np
import pytest

from robot_agent.command_line import gait as gait_command
from robot_agent.locomotion.openshc.body_pose import BodyPose, intrinsic_of, rotation_of_intrinsic
from robot_agent.locomotion.openshc.controller import Controller
from robot_agent.locomotion.openshc.reading import with_settings
from robot_agent.locomotion.openshc.run import run
from robot_agent.locomotion.openshc.script import events_of
from robot_agent.locomotion.openshc.shipped import shipped
from robot_agent.locomotion.openshc.steps import MANUAL, MOVING, PACKED, READY, RUNNING, STARTING, STOPPED, WALKING
from weaver_shared.errors import ConfigurationError, InputError
from weaver_shared.transforms import rotation_from_rpy

COMPAT = ["--compat", "openshc-0.5.11"]


def told(robot, settings, script, ticks=None, *, from_rest=False):
    """What `watch` would see: the controller after every tick."""
    return run(with_settings(shipped(robot), settings), events_of(script), ticks=ticks, from_rest=from_rest)


def test_one_leg_after_the_other_is_brought_to_its_stance():
    (_, controller), *_ = told("bullet_mammalian", [], "", ticks=0)
    clearance = np.array([0.0, 0.0, controller.description.body_clearance])
    for leg in controller.legs:
        np.testing.assert_allclose(leg.tip(), leg.description.place - clearance, atol=1e-3)


@pytest.mark.parametrize(
    ("robot", "gait", "ticks", "speed", "starting", "stopping"),
    [
        ("default", "wave", 724, 0.0180, 6.80, 12.08),
        ("default", "amble", 400, 0.0424, 3.04, 5.04),
        ("default", "ripple", 412, 0.0415, 3.68, 6.36),
        ("bullet_insectoid", "amble", 640, 0.1255, 2.72, 5.32),
        ("bullet_insectoid", "ripple", 652, 0.1249, 3.24, 5.92),
        ("bullet_insectoid", "bipod", 364, 0.3636, 2.00, 3.20),
    ],
)
def test_it_starts_speeds_up_and_stops_as_slowly_as_measured(robot, gait, ticks, speed, starting, stopping):
    description = with_settings(shipped(robot), [f"gait_type={gait}_gait"])
    fastest, states, told_to_stop = 0.0, [], 6 + ticks
    script = f"6 velocity 1 0 0\n{told_to_stop} velocity 0 0 0"
    for _, controller in run(description, events_of(script), ticks=None, from_rest=False):
        fastest = max(fastest, controller.walk.velocity.linear[0])
        states.append(controller.walk.state)
    assert fastest == pytest.approx(speed, abs=5e-5)
    assert states.count(STARTING) * description.time_delta == pytest.approx(starting)
    stood = states.index(STOPPED, told_to_stop)
    assert (stood - told_to_stop) * description.time_delta == pytest.approx(stopping)


def test_the_start_up_by_steps_takes_the_ticks_it_was_measured_to_take():
    """Unpack 100, first start-up 545, shut-down 150 for it runs twice a tick (D8), pack 100."""
    changes = {}
    script = "1 state ready\n201 state running\n800 state ready\n1000 state packed"
    for tick, controller in told("default", ["start_up_sequence=true"], script, ticks=1100, from_rest=True):
        changes.setdefault((controller.robot_state, tick >= 800), tick)
    assert changes[READY, False] == 101
    assert changes[RUNNING, False] == 200 + 545
    assert changes[READY, True] == 799 + 150
    assert changes[PACKED, True] == 999 + 100


def test_dynamic_stiffness_is_reported_but_changes_nothing():
    """D3, with reported values up to 108 above the parameter's 12."""
    script = "1 force AR 0 0 20\n1 velocity 0.5 0 0"
    joints, reported = [], []
    for on in ("true", "false"):
        settings = ["admittance_control=true", f"dynamic_stiffness={on}"]
        *_, (_, controller) = told("default", settings, script, ticks=160)
        joints.append(np.array([leg.position for leg in controller.legs]))
        reported.append(controller.admittance.stiffness.max())
    np.testing.assert_array_equal(joints[0], joints[1])
    assert reported[0] > 12.0 + 24.0
    assert reported[1] == 0.0


def test_a_step_of_the_imu_moves_the_body_at_once():
    """D14: 10 degrees lean the body 17.6 mm in one tick."""
    angle = np.radians(10.0)
    *_, (_, leaning) = told("default", ["inclination_posing=true"], f"1 imu {angle} 0 0 0 0 0", ticks=1)
    assert leaning.posing.pose.position[1] == pytest.approx(0.0176, abs=5e-5)
    gains = ["imu_posing=true", "rotation_pid_gains.p=0.5"]
    *_, (_, levelled) = told("default", gains, f"1 imu {angle} 0 0 0 0 0", ticks=1)
    np.testing.assert_allclose(levelled.posing.pose.rotation, rotation_from_rpy(-0.5 * angle, 0.0, 0.0), atol=1e-12)


def test_a_slower_frequency_waits_for_a_slower_robot_but_not_backwards():
    """D10."""
    for direction, waits in ((1.0, True), (-1.0, False)):
        (_, controller), *rest = told("default", [], f"1 velocity {direction} 0 0\n250 adjust step_frequency -0.5", 252)
        assert controller.walk.state == MOVING
        assert ("step_frequency" in controller.asked_parameters) == waits
        assert len(rest) == 252


def test_a_gait_is_changed_only_after_a_stop():
    gaits = []
    for _, controller in told("default", [], "1 velocity 0.6 0 0\n200 gait wave_gait", ticks=420):
        gaits.append((controller.walk.state, controller.gait_name))
    assert (MOVING, "wave_gait") not in gaits
    assert gaits[-1] == (STOPPED, "wave_gait")


def test_a_leg_is_lifted_moved_and_put_back():
    script = "1 leg AR manual\n121 tip AR 1 0 1\n171 tip AR 0 0 0\n176 leg AR walking"
    states, tips = [], []
    for _, controller in told("default", [], script, ticks=300):
        states.append(controller.manipulation.states[0])
        tips.append(controller.legs[0].tip())
    assert states[120] == MANUAL
    assert states[-1] == WALKING
    np.testing.assert_allclose(tips[120] - tips[0], [0.0, 0.0, 0.02], atol=2e-3)
    assert (tips[172] - tips[120])[[0, 2]] == pytest.approx([0.05, 0.05], abs=0.01)
    np.testing.assert_allclose(tips[-1], tips[0], atol=2e-3)


def test_tips_of_five_joint_legs_stay_upright_on_request():
    *_, (_, controller) = told("bullet_insectoid", ["gravity_aligned_tips=true"], "1 velocity 0.5 0.2 0.1", ticks=450)
    standing = [leg for leg, path in zip(controller.legs, controller.walk.paths, strict=True) if path.step_state == 1]
    for leg in standing:
        np.testing.assert_allclose(leg.tip_frame()[:3, 0], [0.0, 0.0, -1.0], atol=0.02)


def test_the_ground_is_searched_below_and_found_above():
    rough = ["rough_terrain_mode=true", "step_depth.min=0", "step_depth.max=0.02", "step_depth=0.01"]
    lowest = 0.0
    for _, controller in told("default", rough, "1 force all 0 0 0\n1 velocity 0.5 0 0", ticks=320):
        lowest = min(lowest, *(path.tip[2] for path in controller.walk.paths))
    assert lowest < -0.008
    felt = "1 force all 0 0 0\n1 velocity 0.5 0 0\n150 force AR 0 0 2"
    *_, (_, controller) = told("default", rough, felt, ticks=320)
    assert np.isfinite(controller.walk.tips).all()


def test_a_wider_stance_is_taken_at_the_stop():
    *_, (_, controller) = told("default", ["stance_span_modifier=0.5"], "1 velocity 0.6 0 0\n260 velocity 0 0 0")
    for path in controller.walk.paths:
        assert abs(path.default[1]) > abs(path.identity[1]) + 0.02


def test_real_velocities_are_kept_up_to_the_limit():
    *_, (_, controller) = told("default", ["velocity_input_mode=real"], "1 velocity 0.03 0.01 0", ticks=300)
    np.testing.assert_allclose(controller.walk.velocity.linear, [0.03, 0.01], atol=1e-12)
    *_, (_, controller) = told("default", ["velocity_input_mode=real"], "1 velocity 0.2 0 0", ticks=300)
    assert controller.walk.velocity.linear[0] == pytest.approx(0.0770, abs=5e-5)


def test_removing_a_pose_does_not_undo_adding_it():
    """D17: 0.3 mm are left of the tripod's automatic pose."""
    pose = BodyPose(np.array([0.0, 0.0, 0.02]), rotation_from_rpy(0.015, 0.0, 0.0))
    left = BodyPose().added(pose).removed(pose)
    assert np.linalg.norm(left.position) == pytest.approx(0.3e-3, rel=0.01)
    turn = [0.2, -0.3, 0.4]
    np.testing.assert_allclose(intrinsic_of(rotation_of_intrinsic(*turn)), turn, atol=1e-12)


def table(capsys, *arguments):
    assert gait_command.main([*arguments, *COMPAT]) == 0
    return list(csv.DictReader(io.StringIO(capsys.readouterr().out)))


def test_the_command_gives_the_velocity_once_and_takes_it_back(capsys, tmp_path):
    body = tmp_path / "body.csv"
    arguments = ["--robot", "default", "--gait", "tripod", "--velocity", "-0.6,0,0", "--stop-after", "250"]
    rows = table(capsys, *arguments, "--body", str(body), "--csv", "-")
    states = [row["walk_state"] for row in csv.DictReader(body.read_text().splitlines())]
    assert len(rows) == 6 * len(states)
    assert states[5:7] == [str(STOPPED), str(STARTING)]
    assert states[-12:] == ["2", *[str(STOPPED)] * 11]
    assert rows[0]["leg"] == "AR"
    assert float(rows[-6]["walker_x"]) == pytest.approx(0.13, abs=0.01)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--compat", "openshc-9"], "known is openshc-0.5.11"),
        ([*COMPAT, "--robot", "weaver"], "known are default"),
        ([*COMPAT, "--robot", "default", "--gait", "bipod"], "known are wave, amble"),
        ([*COMPAT, "--robot", "default", "--set", "step_depht=0.1"], "no parameter of OpenSHC"),
        ([*COMPAT, "--robot", "default", "--set", "swing_height=0.5"], "swing_height"),
        ([*COMPAT, "--robot", "default", "--stop-after", "0"], "from 1 up"),
        ([*COMPAT, "--robot", "nowhere.yaml"], "can not be read"),
        (["--stop-after", "10"], "--compat only"),
        (["--set", "a=1"], "--set is of use"),
    ],
)
def test_what_openshc_does_not_know_is_answered_with_what_it_does(arguments, says):
    with pytest.raises((ConfigurationError, InputError), match=says):
        gait_command.main(arguments)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("velocity 1 0 0", "use TICK COMMAND VALUES"),
        ("3 fly 1 0 0", "known are state, velocity"),
        ("0 velocity 1 0", "vx vy wz"),
        ("0 velocity 1 0 nan", "finite"),
        ("0 velocity 1 0 fast", "vx vy wz"),
        ("0 force XX 0 0 1", "known are AR"),
        ("0 gait gallop", "known are wave_gait"),
        ("0 adjust clearance 1", "valid are step_frequency"),
        ("0 reset now", "known are no_reset"),
    ],
)
def test_a_bad_line_of_a_script_is_named(line, says):
    controller = Controller(shipped("default"))
    with pytest.raises((ConfigurationError, InputError), match=says):
        [event.tell(controller) for event in events_of(line)]
