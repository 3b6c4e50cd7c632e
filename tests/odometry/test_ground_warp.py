"""Against the warped picture, followed ground is found where it is, however much at a slant it is seen."""

import numpy as np
import pytest
from walking_motion import Walk

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.odometry.front_end import FrontEnd
from robot_agent.odometry.ground_warp import carried, ground_warp, warped
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import FrontEndConfig
from weaver_shared.transforms import Pose


def _ground_in_left(calibration: StereoCalibration, world_from_body: Pose) -> np.ndarray:
    """Inverse depth over x, y, 1 of the plane z = 0."""
    eye = world_from_body @ calibration.left.body_from_camera
    return np.asarray(-eye.rotation[2] / eye.position[2])


def test_a_point_on_the_ground_is_carried_to_where_the_other_eye_sees_it(calibration: StereoCalibration) -> None:
    body = Walk().body(0.0)
    left, right = (body @ eye.body_from_camera for eye in (calibration.left, calibration.right))
    warp = ground_warp(calibration.left, calibration.right, right.inverse() @ left, _ground_in_left(calibration, body))
    assert warp is not None
    points = np.array([[0.6, 0.1, 0.0], [0.8, -0.2, 0.0], [1.2, 0.0, 0.0]])
    pixels = []
    for pose, eye in ((left, calibration.left), (right, calibration.right)):
        seen = pose.inverse().transform(points) @ eye.matrix.T
        pixels.append(seen[:, :2] / seen[:, 2:])
    assert carried(warp, pixels[0]) == pytest.approx(pixels[1], abs=1e-6)


def test_what_is_no_ground_is_not_warped(calibration: StereoCalibration) -> None:
    left, right = calibration.left, calibration.right
    sideways = Pose.of([-0.1, 0.0, 0.0])
    assert ground_warp(left, right, sideways, None) is None
    assert ground_warp(left, right, sideways, np.array([0.0, 40.0, 10.0])) is None
    assert warped(np.eye(4, dtype=np.uint8), None) is not None


def test_what_hardly_bends_a_followed_square_is_not_worth_a_warp(calibration: StereoCalibration) -> None:
    body, left, right = Walk().body(0.0), calibration.left, calibration.right
    ground = _ground_in_left(calibration, body)
    for way, worth in ((0.001, False), (0.03, True)):
        ahead = body.rotation @ left.body_from_camera.rotation
        second_from_first = Pose(rotation=np.eye(3), position=ahead.T @ np.array([-way, 0.0, 0.0]))
        assert (ground_warp(left, left, second_from_first, ground, 13.0) is not None) == worth
    right_from_left = right.body_from_camera.inverse() @ left.body_from_camera
    assert ground_warp(left, right, right_from_left, ground, 13.0) is not None


def test_slanted_ground_is_matched_without_bias(calibration: StereoCalibration) -> None:
    front_end = FrontEnd(calibration, FrontEndConfig())
    ground, body = TexturedGround(calibration, seed=3, noise=1.0), Walk().body(0.0)
    for k in range(3):
        tracks = front_end.step(ground.look(k, k, body), Pose.identity())
    left, right = (body @ eye.body_from_camera for eye in (calibration.left, calibration.right))
    rays = np.column_stack([tracks.observation[:, 0], np.ones(tracks.number)]) @ left.rotation.T
    points = left.position + rays * (-left.position[2] / rays[:, 2])[:, None]
    seen = right.inverse().transform(points)
    error = calibration.right.fx * (tracks.observation[:, 1] - seen[:, :2] / seen[:, 2:])[tracks.seen == 3]
    assert len(error) > 60
    assert np.abs(np.median(error, axis=0)).max() < 0.01
    assert 1.48 * np.median(np.abs(error), axis=0).max() < 0.08
