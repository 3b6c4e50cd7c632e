"""Rectified pictures are row aligned and keep the scene's metric geometry."""

import cv2
import numpy as np
import pytest

from robot_agent.vision.camera import Distortion, PinholeCamera, StereoCalibration
from robot_agent.vision.distortion import normalise, project
from robot_agent.vision.rectification import Rectifier
from weaver_shared.messages import StereoFrame
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose, rotation_from_rpy


def _real_pair(model: Distortion) -> StereoCalibration:
    coefficients = {
        "none": np.zeros(4),
        "radtan": np.array([-0.28, 0.07, 2e-4, 2e-5]),
        "equidistant": np.array([-0.02, 0.01, -0.004, 0.001]),
    }[model]

    def eye(fx: float, rotation: tuple[float, float, float], position: tuple[float, float, float]) -> PinholeCamera:
        return PinholeCamera(
            width=640,
            height=480,
            fx=fx,
            fy=fx - 1.0,
            cx=318.0,
            cy=243.0,
            distortion_model=model,
            distortion=coefficients,
            body_from_camera=Pose(rotation=rotation_from_rpy(*rotation), position=np.array(position)),
        )

    return StereoCalibration(
        left=eye(381.0, (0.01, -0.02, 0.0), (0.0, 0.0, 0.0)),
        right=eye(383.0, (-0.01, 0.01, 0.005), (0.1, 0.002, -0.001)),
    )


def _dot_picture(pixel: np.ndarray) -> np.ndarray:
    picture = np.zeros((480, 640), dtype=np.uint8)
    rows, columns = np.mgrid[0:480, 0:640]
    spot = 255.0 * np.exp(-0.5 * ((columns - pixel[0]) ** 2 + (rows - pixel[1]) ** 2) / 4.0)
    picture[:] = spot.astype(np.uint8)
    return picture


def _centroid(picture: np.ndarray) -> np.ndarray:
    moments = cv2.moments(picture)
    return np.array([moments["m10"] / moments["m00"], moments["m01"] / moments["m00"]])


@pytest.mark.parametrize("model", ["none", "radtan", "equidistant"])
def test_pixels_survive_the_way_to_rays_and_back(model: Distortion) -> None:
    camera = _real_pair(model).left
    pixels = np.random.default_rng(0).uniform((40, 40), (600, 440), (50, 2))
    rays = np.column_stack([normalise(camera, pixels), np.ones(50)])
    assert project(camera, 2.5 * rays) == pytest.approx(pixels, abs=0.02)


def test_points_behind_the_lens_have_no_pixel() -> None:
    camera = _real_pair("radtan").left
    assert np.isnan(project(camera, np.array([[0.0, 0.0, -1.0]]))).all()


@pytest.mark.parametrize("model", ["none", "radtan", "equidistant"])
@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_a_point_in_space_is_found_again_from_its_disparity(model: Distortion, scale: float) -> None:
    calibration = _real_pair(model)
    rectifier = Rectifier(calibration, scale)
    point_in_body = np.array([0.08, -0.05, 0.7])
    pictures = []
    for camera in (calibration.left, calibration.right):
        pixel = project(camera, camera.body_from_camera.inverse().transform(point_in_body)[None])[0]
        pictures.append(_dot_picture(pixel))
    frame = StereoFrame(stamp_ns=0, sequence=0, left=pictures[0], right=pictures[1])
    left, right = (_centroid(picture) for picture in rectifier.rectify(frame))
    assert left[1] == pytest.approx(right[1], abs=0.1)
    depth = rectifier.fx * rectifier.baseline / (left[0] - right[0])
    ray = np.array([(left[0] - rectifier.cx) / rectifier.fx, (left[1] - rectifier.cy) / rectifier.fy, 1.0])
    assert rectifier.body_from_rectified.transform(depth * ray) == pytest.approx(point_in_body, abs=0.006)


def test_an_ideal_pair_passes_untouched() -> None:
    calibration = StereoCalibration.of_robot(load_robot("weaver"))
    picture = np.random.default_rng(0).integers(0, 255, (480, 640), dtype=np.uint8)
    frame = StereoFrame(stamp_ns=0, sequence=0, left=picture, right=picture)
    left, right = Rectifier(calibration).rectify(frame)
    assert left is frame.left
    assert right is frame.right
    half = Rectifier(calibration, 0.5)
    assert half.rectify(frame)[0].shape == (240, 320)
    assert half.fx == pytest.approx(381.4 / 2)
    assert half.cx == pytest.approx((320 - 1) / 2)
