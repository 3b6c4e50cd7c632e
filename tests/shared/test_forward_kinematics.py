"""Denavit-Hartenberg chains: rigid links, a leg as long as the paper says, feet that move as the joints turn."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body, joint_frames_in_body
from weaver_shared.transforms import rotation_x, rotation_z

WEAVER = load_robot("weaver")


def angles_of(robot: RobotDescription) -> st.SearchStrategy[np.ndarray]:
    limits = np.tile(robot.joint_limits, (robot.leg_count, 1))
    return st.tuples(*[st.floats(low, high) for low, high in limits]).map(np.array)


def chained(robot: RobotDescription, leg: int, angles: np.ndarray) -> np.ndarray:
    """RotZ(theta + q) TransZ(d) TransX(r) RotX(alpha), one elementary motion after the other."""
    frame = rigid(rotation_z(robot.hip_yaws[leg]), robot.hips_in_body[leg])
    for (theta, d, r, alpha), angle in zip(robot.dh, angles, strict=True):
        for motion in (
            rigid(rotation_z(theta + angle), np.zeros(3)),
            rigid(np.eye(3), np.array([r, 0.0, d])),
            rigid(rotation_x(alpha), np.zeros(3)),
        ):
            frame = frame @ motion
    return frame


def rigid(rotation: np.ndarray, position: np.ndarray) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, position
    return matrix


@given(angles=angles_of(WEAVER))
def test_all_legs_at_once_equal_one_motion_after_the_other(angles: np.ndarray) -> None:
    frames = joint_frames_in_body(WEAVER, angles)
    for leg, mine in enumerate(angles.reshape(WEAVER.leg_count, -1)):
        assert_allclose(frames[leg, -1], chained(WEAVER, leg, mine), atol=1e-12)
    assert_allclose(feet_in_body(WEAVER, angles), frames[:, -1, :3, 3])


@given(angles=angles_of(WEAVER))
def test_links_are_rigid(angles: np.ndarray) -> None:
    frames = joint_frames_in_body(WEAVER, angles)
    rotations = frames[..., :3, :3]
    assert_allclose(rotations @ np.swapaxes(rotations, -1, -2), np.broadcast_to(np.eye(3), rotations.shape), atol=1e-12)
    links = np.linalg.norm(np.diff(frames[:, :, :3, 3], axis=1), axis=2)
    expected = np.hypot(WEAVER.dh[:, 1], WEAVER.dh[:, 2])
    assert_allclose(links, np.broadcast_to(expected, links.shape), atol=1e-12)


@given(angles=angles_of(WEAVER))
def test_no_foot_is_farther_than_the_leg_is_long(angles: np.ndarray) -> None:
    reach = np.linalg.norm(feet_in_body(WEAVER, angles) - WEAVER.hips_in_body, axis=1)
    assert (reach <= 0.34 + 1e-12).all()


def test_a_stretched_leg_points_along_its_hip() -> None:
    feet = feet_in_body(WEAVER, np.zeros(WEAVER.joint_count))
    outward = np.column_stack([np.cos(WEAVER.hip_yaws), np.sin(WEAVER.hip_yaws), np.zeros(6)])
    assert_allclose(feet, WEAVER.hips_in_body + 0.34 * outward, atol=1e-12)


@pytest.mark.parametrize("joint", ["femur", "tibia", "tarsus"])
def test_positive_pitch_joints_lower_the_foot(joint: str) -> None:
    angles = np.zeros((WEAVER.leg_count, WEAVER.joints_per_leg))
    angles[:, [each.name for each in WEAVER.joints].index(joint)] = 0.3
    assert (feet_in_body(WEAVER, angles)[:, 2] < -0.02).all()


def test_positive_yaw_turns_the_leg_to_the_left() -> None:
    angles = np.zeros((WEAVER.leg_count, WEAVER.joints_per_leg))
    angles[:, 0] = 0.3
    bearing = feet_in_body(WEAVER, angles) - WEAVER.hips_in_body
    turned = np.arctan2(bearing[:, 1], bearing[:, 0])
    assert_allclose(turned, WEAVER.hip_yaws + 0.3, atol=1e-12)


@given(angles=angles_of(WEAVER))
def test_a_mirrored_leg_moves_as_the_mirror_image(angles: np.ndarray) -> None:
    content = WEAVER.model_dump()
    content["legs"] = list(content["legs"])
    for right, left in ((0, 5), (1, 4), (2, 3)):
        x, y, z = content["legs"][right]["hip_in_body"]
        yaw = content["legs"][right]["hip_yaw"]
        content["legs"][right] |= {"hip_roll": 0.4}
        content["legs"][left] |= {"hip_in_body": (x, -y, z), "hip_yaw": -yaw, "hip_roll": -0.4, "mirrored": True}
    robot = RobotDescription.model_validate(content)
    same = angles.reshape(6, 5)
    same[3:] = same[2::-1]
    frames = joint_frames_in_body(robot, same)
    assert_allclose(frames[3:, :, :3, 3], frames[2::-1, :, :3, 3] * [1.0, -1.0, 1.0], atol=1e-12)
    assert_allclose(np.linalg.det(frames[..., :3, :3]), 1.0, atol=1e-12)
