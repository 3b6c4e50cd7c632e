"""The ground under a robot is where its touching feet are, or its lowest ones."""

import numpy as np
import pytest

from weaver_shared.foot_contacts import FootContacts
from weaver_shared.leg_batch import LegBatch
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import joint_frames_in_body
from weaver_shared.transforms import Pose, rotation_from_rpy

POSE = Pose(rotation=rotation_from_rpy(0.1, -0.2, 0.5), position=np.array([1.0, 2.0, 0.2]))


def feet_at(world_z, touching):
    """One reading of six feet whose centres lie at these world heights, m."""
    x, y = np.array([[0.3, 0.0, -0.3, 0.3, 0.0, -0.3], [-0.3, -0.4, -0.3, 0.3, 0.4, 0.3]])
    in_world = np.column_stack([x + 1.0, y + 2.0, world_z])
    feet = np.array([[POSE.inverse().transform(point) for point in in_world]])
    return FootContacts(
        stamp_ns=np.array([0]),
        foot_in_body=feet,
        sole_in_body=feet,
        touching=np.array([touching], dtype=bool),
    )


def test_touching_feet_tell_the_ground_and_swinging_ones_do_not():
    contacts = feet_at([0.02, 0.12, 0.03, 0.12, 0.04, 0.12], [1, 0, 1, 0, 1, 0])
    assert contacts.ground_height(POSE, 0.02) == pytest.approx(0.01)


def test_without_three_contacts_the_three_lowest_feet_tell_it():
    contacts = feet_at([0.02, 0.12, 0.03, 0.12, 0.04, 0.12], [0, 0, 0, 1, 0, 0])
    assert contacts.ground_height(POSE, 0.02) == pytest.approx(0.01)


def test_the_sole_is_a_foot_radius_further_along_the_last_link():
    robot = load_robot()
    joints = np.random.default_rng(1).uniform(-0.5, 0.5, (3, robot.joint_count))
    touching = np.ones((3, robot.leg_count), dtype=bool)
    batch = LegBatch(
        stamp_ns=np.arange(3), joint_position=joints, joint_torque=np.zeros_like(joints), foot_contact=touching
    )
    contacts = FootContacts.of(robot, batch)
    for n in range(3):
        ends = joint_frames_in_body(robot, joints[n])[:, -2:, :3, 3]
        np.testing.assert_allclose(contacts.foot_in_body[n], ends[:, 1])
        beyond = contacts.sole_in_body[n] - ends[:, 1]
        np.testing.assert_allclose(np.linalg.norm(beyond, axis=1), robot.foot_radius)
        np.testing.assert_allclose(np.cross(beyond, ends[:, 1] - ends[:, 0]), 0.0, atol=1e-12)
