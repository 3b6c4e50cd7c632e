"""The three-joint leg's closed form: exact on every foot it can reach, whichever way the chain is built."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.kinematics import leg_frames, solve_leg
from robot_agent.kinematics.chain import with_turns
from robot_agent.kinematics.inverse import YAW_PITCH
from robot_agent.kinematics.yaw_pitch import is_yaw_pitch
from weaver_shared.transforms import rotation_x, rotation_z

QUARTER = 0.5 * np.pi
LIMITS = np.array([[-1.2, 1.2], [-1.5, 1.5], [-2.4, 2.4]])
HIP = np.array([0.1, -0.05, 0.02])
DOWN = np.array([0.0, 0.0, -1.0])
angles = st.tuples(st.floats(-1.1, 1.1), st.floats(-1.2, 1.2), st.floats(0.2, 2.2), st.sampled_from([-1.0, 1.0])).map(
    lambda a: np.array([a[0], a[1], a[2] * a[3]])
)


def chain(turn, offsets=(0.0, 0.0)):
    return np.array(
        [[0.3, 0.01, 0.05, turn * QUARTER], [0.1, offsets[0], 0.08, 0.0], [-0.1, offsets[1], 0.12, 0.4]],
        dtype=np.float64,
    )


def foot_of(dh, axes, joints):
    origins, joint_axes = np.zeros((4, 3)), np.zeros((3, 3))
    leg_frames(with_turns(dh), HIP, axes, joints, origins, joint_axes)
    return origins[3].copy()


def attitude(mirrored):
    axes = rotation_z(0.7) @ rotation_x(-0.3)
    axes[:, 1] *= -1.0 if mirrored else 1.0
    return np.ascontiguousarray(axes)


@given(angles, st.sampled_from([-1, 1]), st.sampled_from([(0.0, 0.0), (0.02, -0.005)]), st.booleans())
def test_it_finds_the_joints_that_a_foot_came_from(joints, turn, offsets, mirrored):
    dh, axes, solution = chain(turn, offsets), attitude(mirrored), np.zeros(3)
    foot = foot_of(dh, axes, joints)
    left = solve_leg(with_turns(dh), LIMITS, YAW_PITCH, HIP, axes, foot, DOWN, joints + 1e-3, solution)
    assert left < 1e-6
    np.testing.assert_allclose(foot_of(dh, axes, solution), foot, atol=1e-9)


@given(angles)
def test_of_two_knees_it_keeps_the_one_it_had(joints):
    dh, axes, solution = chain(1), attitude(False), np.zeros(3)
    foot = foot_of(dh, axes, joints)
    solve_leg(with_turns(dh), LIMITS, YAW_PITCH, HIP, axes, foot, DOWN, joints.copy(), solution)
    np.testing.assert_allclose(solution, joints, atol=1e-6)


def test_a_foot_out_of_reach_is_approached_within_the_limits():
    dh, axes, solution = chain(1), attitude(False), np.zeros(3)
    foot = HIP + np.array([2.0, 0.0, 0.0])
    left = solve_leg(with_turns(dh), LIMITS, YAW_PITCH, HIP, axes, foot, DOWN, np.zeros(3), solution)
    assert left == pytest.approx(np.linalg.norm(foot_of(dh, axes, solution) - foot), abs=1e-9)
    assert left > 1.0
    assert (np.abs(solution) <= LIMITS[:, 1]).all()


def test_only_a_yaw_pitch_chain_counts_as_one():
    assert is_yaw_pitch(chain(-1))
    skew = chain(1)
    skew[1, 3] = 0.1
    assert not is_yaw_pitch(skew)
    assert not is_yaw_pitch(np.zeros((5, 4)))
