"""The gait is no faster than the servos: feet in the air stay on their paths, and the robot says that it is slowed."""

import numpy as np
import pytest

from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.legs_tick import solve_feet
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body, joint_frames_in_body

ROBOT = load_robot("weaver")
DT = 0.01
SAID = "the gait is slowed to what the servos can follow"


def walked(speed, *, gait="tripod", frequency=1.0, height=0.05, seconds=6.0, robot=ROBOT, **settings):
    """Farthest way of a foot in the air from its path, mean speed, and what was said, after two seconds."""
    config = LocomotionConfig(feel_ground=False, compensate_servos=False, **settings)
    walker = Walker(robot, config, DT)
    joints, away, speeds, said = walker.begin_standing(), 0.0, [], set()
    parameters = GaitParameters(
        stamp_ns=0, virtual_stiffness=2000.0, stride_frequency=frequency, stride_height=height, confidence=1.0
    )
    for tick in range(round(seconds / DT)):
        out = walker.step(
            WalkInput(
                stamp_ns=0,
                velocity=np.array([speed, 0.0, 0.0]),
                parameters=parameters,
                gait=gait,
                stand=True,
                joint_position=joints,
                joint_torque=np.zeros_like(joints),
                foot_contact=np.ones(robot.leg_count, dtype=np.bool_),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
            )
        )
        joints = out.joint_position
        if tick * DT > 2.0:
            reached = feet_in_body(robot, walker._angles.ravel())
            away = max(away, np.linalg.norm(reached - out.foot_in_body, axis=1)[out.swing].max(initial=0.0))
            speeds.append(out.velocity[0])
            said |= set(out.reasons)
    return away, np.array(speeds), said


@pytest.mark.parametrize("gait", ["tripod", "ripple"])
@pytest.mark.parametrize("height", [0.05, 0.12])
def test_feet_stay_on_their_paths_however_fast_the_order(gait, height):
    away, speeds, said = walked(0.35, gait=gait, height=height)
    assert away < 0.008
    # What a foot's time in the air allows: less of the stride in the air is a slower robot.
    assert speeds.mean() > 0.24 * (1.0 - ROBOT.gait(gait).duty)
    assert SAID in said


def test_without_it_swinging_feet_lag_far_behind():
    away, _, said = walked(0.35, spare_servos=False)
    assert away > 0.025
    assert SAID not in said


def test_a_walk_that_the_servos_can_follow_is_not_slowed():
    away, speeds, said = walked(0.12)
    assert away < 1e-5
    assert speeds.min() == pytest.approx(0.12)
    assert SAID not in said


def test_the_pace_is_even_over_the_stride():
    _, speeds, _ = walked(0.25, seconds=8.0)
    late = speeds[300:]
    assert late.std() < 0.25 * late.mean()


def test_last_links_that_lean_after_their_feet_let_the_robot_walk_faster():
    """The knees of the corner legs are what the servos can not follow: their last joints take over a part."""
    away, speeds, _ = walked(0.3, frequency=1.2, height=0.03)
    leaning_away, leaning_speeds, _ = walked(0.3, frequency=1.2, height=0.03, last_link_lean=2.5)
    assert max(away, leaning_away) < 0.008
    assert leaning_speeds.mean() > 1.15 * speeds.mean()


def test_all_last_links_lean_alike_and_no_more_than_allowed():
    config = LocomotionConfig(feel_ground=False, compensate_servos=False, last_link_lean=4.0)
    walker = Walker(ROBOT, config, DT)
    walker.begin_standing()
    feet = ROBOT.stance_in_body + np.array([[0.03, 0.02, 0.0], [-0.06, 0.0, 0.0], [0.15, 0.0, 0.03]] * 2)
    solve_feet(walker._memory, feet)
    frames = joint_frames_in_body(ROBOT, walker._angles.ravel())
    last_link = frames[:, -1, :3, 3] - frames[:, -2, :3, 3]
    np.testing.assert_allclose(frames[:, -1, :3, 3], feet, atol=1e-9)
    lean = last_link[:, :2] / -last_link[:, 2:]
    np.testing.assert_allclose(lean, [[0.12, 0.08], [-0.24, 0.0], [0.4, 0.0]] * 2, atol=1e-9)
