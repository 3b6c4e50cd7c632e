"""Torques that hold a force at the foot tell that force again, whatever the legs' pose."""

import numpy as np
import pytest

from weaver_shared.robots import load_robot
from weaver_shared.robots.foot_loads import foot_jacobians, foot_loads
from weaver_shared.robots.forward_kinematics import feet_in_body

STEP = 1e-6


@pytest.fixture(params=["weaver", "bullet_insectoid", "magneto"])
def robot(request):
    return load_robot(request.param)


def pose(robot, seed):
    return np.random.default_rng(seed).uniform(-0.4, 0.4, robot.joint_count)


def test_jacobians_are_those_of_the_feet(robot):
    joints, n = pose(robot, 1), robot.joints_per_leg
    jacobian = foot_jacobians(robot, joints)
    for index in range(n):
        moved = joints.copy()
        moved[index::n] += STEP
        change = (feet_in_body(robot, moved) - feet_in_body(robot, joints)) / STEP
        np.testing.assert_allclose(jacobian[:, :, index], change, atol=1e-5)


def test_the_load_that_the_torques_hold_is_found(robot):
    rng, joints = np.random.default_rng(2), pose(robot, 2)
    forces = rng.normal(size=(robot.leg_count, 3)) * 20.0
    torque = -np.einsum("lij,li->lj", foot_jacobians(robot, joints), forces)
    up = np.array([0.1, -0.2, 0.97])
    np.testing.assert_allclose(foot_loads(robot, joints, torque.ravel(), up), forces @ up, atol=1e-6)
