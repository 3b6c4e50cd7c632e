"""A pair of pictures as a point cloud, for looking at one pair by itself."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.perception.health import assess
from robot_agent.perception.stereo_matching import StereoMatcher
from robot_agent.perception.terrain_files import Cloud
from robot_agent.perception.working_camera import WorkingCamera
from robot_agent.vision.camera import PinholeCamera, StereoCalibration
from robot_agent.vision.rectification import Rectifier
from weaver_shared.config.perception import PerceptionConfig
from weaver_shared.errors import InputError
from weaver_shared.messages import StereoFrame

WIDEST = 640  # px; a wider picture is matched smaller
DISPARITY_SHARE = 0.25  # of the picture's width that is searched
FEWEST_POINTS = 1000


def read_pair(left: Path, right: Path, calibration: StereoCalibration) -> StereoFrame:
    """Both pictures as grey values. Raises InputError when one is missing, no picture, or not of the camera's size."""
    return StereoFrame(
        stamp_ns=0,
        sequence=0,
        left=_picture(left, calibration.left),
        right=_picture(right, calibration.right),
    )


def stereo_cloud(frame: StereoFrame, calibration: StereoCalibration, config: PerceptionConfig) -> Cloud:
    """Points in the left eye's optical frame in m.

    Raises InputError with the reason when the pictures can not be trusted: no ground is better than a wrong one.
    """
    rectifier = Rectifier(calibration, min(1.0, WIDEST / calibration.left.width))
    disparities = 16 * max(1, round(DISPARITY_SHARE * rectifier.width / 16))
    left, right = rectifier.rectify(frame)
    disparity = StereoMatcher(config.matching.model_copy(update={"disparities": disparities})).match(left, right)
    health = assess(left, right, disparity, config.health)
    if health.score < config.health.smallest:
        raise InputError(f"the pair can not be used: {health.reason} (health {health.score:.2f} of 1)")
    camera = WorkingCamera.of(rectifier)
    rows, columns = np.nonzero(disparity >= 16.0 * config.matching.smallest_disparity)
    if len(rows) < FEWEST_POINTS:
        raise InputError(f"only {len(rows)} pixels match near enough; {FEWEST_POINTS} are needed")
    depth = camera.focal_length * camera.baseline * 16.0 / disparity[rows, columns]
    across, down = camera.ray_slopes()
    points = np.stack([across[columns] * depth, down[rows] * depth, depth], axis=1)
    return Cloud(points=points, labelled_up=None)


def _picture(path: Path, camera: PinholeCamera) -> NDArray[np.uint8]:
    if not path.is_file():
        raise InputError(f"{path} is not a file; a stereo pair needs the pictures of both eyes")
    picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if picture is None:
        raise InputError(f"{path} can not be read as a picture; PNG and JPEG are valid")
    height, width = picture.shape
    if (width, height) != (camera.width, camera.height):
        raise InputError(f"{path} is {width}x{height} px, its calibration is for {camera.width}x{camera.height} px")
    return np.asarray(picture, dtype=np.uint8)
