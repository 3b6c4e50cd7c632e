"""Legs with more joints than a foot's place needs keep away from joint limits and from their largest speed."""

import numpy as np
import pytest

from robot_agent.kinematics import LegModel, foot_jacobian, leg_frames
from robot_agent.kinematics.damped import ITERATIONS, solve_damped
from robot_agent.kinematics.within_speed import is_too_fast, solve_within_speed
from weaver_shared.robots import load_robot

DOWN = np.array([0.0, 0.0, -1.0])
TOLERANCE = 1e-6


class Leg:
    """The first leg of a robot."""

    def __init__(self, name):
        self.robot = load_robot(name)
        self.model = LegModel.of_robot(self.robot)
        self.hip, self.axes = self.model.hips[0], self.model.hip_axes[0]

    def foot(self, joints):
        n = joints.size
        origins, axes = np.zeros((n + 1, 3)), np.zeros((n, 3))
        leg_frames(self.model.dh, self.hip, self.axes, joints, origins, axes)
        return origins[n]

    def freedom(self, joints):
        """How much of each joint's motion, 0..1, is free of the foot's place."""
        n = joints.size
        origins, axes, jacobian = np.zeros((n + 1, 3)), np.zeros((n, 3)), np.zeros((3, n))
        leg_frames(self.model.dh, self.hip, self.axes, joints, origins, axes)
        foot_jacobian(origins, axes, jacobian)
        return np.sqrt(np.diag(np.eye(n) - np.linalg.pinv(jacobian) @ jacobian).clip(0.0))

    def solve(self, foot, joints, limits=None):
        found = joints.copy()
        limits = self.model.limits if limits is None else limits
        left = solve_damped(self.model.dh, limits, self.hip, self.axes, foot, DOWN, TOLERANCE, ITERATIONS, found)
        return left, found

    def within_speed(self, foot, joints, found, largest):
        arguments = (self.model.dh, self.model.limits, self.hip, self.axes, foot, DOWN, TOLERANCE)
        return solve_within_speed(*arguments, largest, joints, found)


def places(joints, limits):
    """-1..1, of joints (n,) between their limits (n, 2)."""
    return (2.0 * joints - limits.sum(axis=1)) / (limits[:, 1] - limits[:, 0])


@pytest.mark.parametrize("name", ["octopod", "bullet_mammalian", "bullet_b_insectoid"])
@pytest.mark.parametrize("side", [0, 1])
def test_a_joint_at_its_limit_is_brought_back_while_the_foot_walks_its_path(name, side):
    leg, tried = Leg(name), 0
    _, standing = leg.solve(leg.robot.stance_in_body[0], leg.model.standing)
    for joint in np.flatnonzero(leg.freedom(standing) > 0.3):
        joints, limits, tried = standing, leg.model.limits.copy(), tried + 1
        span = limits[joint, 1] - limits[joint, 0]
        limits[joint, side] = joints[joint]  # the limit is where the joint stands
        limits[joint, 1 - side] = joints[joint] + (span if side == 0 else -span)
        rest = leg.foot(joints)
        for step in range(200):
            foot = rest + 0.004 * np.sin(0.2 * step) * np.array([1.0, 1.0, 0.5])
            left, joints = leg.solve(foot, joints, limits)
            assert (joints >= limits[:, 0]).all()
            assert (joints <= limits[:, 1]).all()
            if step > 100:
                assert left < 1e-5
        assert abs(places(joints, limits)[joint]) < 0.98
    assert tried >= 2


@pytest.mark.parametrize("name", ["octopod", "bullet_mammalian", "bullet_b_insectoid"])
def test_other_joints_take_over_from_one_that_would_turn_too_fast(name):
    leg = Leg(name)
    _, joints = leg.solve(leg.robot.stance_in_body[0], leg.model.standing)
    foot, found_slower = leg.foot(joints), 0
    for bearing in np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False):
        there = foot + 0.01 * np.array([np.cos(bearing), np.sin(bearing), 0.2])
        _, free = leg.solve(there, joints)
        largest = np.abs(free - joints)
        fastest = int(largest.argmax())
        largest[:] = largest.max()
        largest[fastest] *= 0.97
        assert is_too_fast(joints, free, largest)
        found = free.copy()
        if leg.within_speed(there, joints, found, largest):
            found_slower += 1
            assert not is_too_fast(joints, found, largest * (1.0 + 1e-12))
            np.testing.assert_allclose(leg.foot(found), there, atol=1e-5)
        else:
            np.testing.assert_array_equal(found, free)
    assert found_slower >= 5


@pytest.mark.parametrize("name", ["octopod", "bullet_mammalian", "bullet_b_insectoid"])
def test_a_standing_leg_glides_to_a_posture_and_rests_there_with_its_foot_in_place(name):
    leg = Leg(name)
    _, standing = leg.solve(leg.robot.stance_in_body[0], leg.model.standing)
    joints = np.clip(standing + 0.1, leg.model.limits[:, 0], leg.model.limits[:, 1])
    foot, turns = leg.foot(joints), []
    for _ in range(1500):
        left, found = leg.solve(foot, joints)
        assert left < TOLERANCE
        turns.append(np.abs(found - joints).max())
        joints = found
    assert max(turns) < 0.1
    assert turns[-1] < 1e-6
    assert (np.abs(places(joints, leg.model.limits)) < 0.98).all()


def test_the_same_leg_ten_times_as_large_turns_its_joints_the_same_way():
    leg = Leg("octopod")
    _, joints = leg.solve(leg.robot.stance_in_body[0], leg.model.standing)
    there = leg.foot(joints) + np.array([0.03, -0.02, 0.01])
    _, small = leg.solve(there, joints)
    large, dh = joints.copy(), leg.model.dh.copy()
    dh[:, 1:3] *= 10.0
    foot = leg.hip + 10.0 * (there - leg.hip)
    solve_damped(dh, leg.model.limits, leg.hip, leg.axes, foot, DOWN, 10.0 * TOLERANCE, ITERATIONS, large)
    np.testing.assert_allclose(large, small, atol=1e-9)
