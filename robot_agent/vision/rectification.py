"""Row-aligned pictures of a stereo pair: what dense matching needs, and the geometry to go back to metres."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.vision.camera import PinholeCamera, StereoCalibration
from robot_agent.vision.distortion import normalise
from weaver_shared.messages import StereoFrame
from weaver_shared.transforms import Pose

Picture = NDArray[np.uint8]


class Rectifier:
    """Turns both eyes into identical ideal pinholes side by side, at full (`scale` 1) or half (0.5) size.

    A point at depth z appears `fx * baseline / z` pixels further left in the right picture; its place in the optical
    frame of `body_from_rectified` (the left eye's centre) follows from `fx`, `fy`, `cx`, `cy`, all in pixels of the
    pictures returned. An ideal pair passes through untouched but for the halving.
    """

    def __init__(self, calibration: StereoCalibration, scale: float = 1.0) -> None:
        if not 0.0 < scale <= 1.0:
            raise ValueError(f"the scale of rectified pictures is within 0..1, not {scale}")
        left, right = calibration.left, calibration.right
        self.width = round(left.width * scale)
        self.height = round(left.height * scale)
        self._maps: tuple[tuple[NDArray[np.int16], NDArray[np.uint16]], ...] = ()
        self._resize = scale != 1.0

        baseline_in_body = right.body_from_camera.position - left.body_from_camera.position
        self.baseline = float(np.linalg.norm(baseline_in_body))
        if _is_ideal(calibration):
            self.body_from_rectified = left.body_from_camera
            focal, centre = left.fx, np.array([left.cx, left.cy])
        else:
            rotation = _common_rotation(left.body_from_camera, right.body_from_camera)
            self.body_from_rectified = Pose(rotation=rotation, position=left.body_from_camera.position)
            focal = (left.fx + left.fy + right.fx + right.fy) / 4.0
            centre = _common_centre(left, right, rotation, focal)
        # Pixel centres are whole numbers, so scaling acts about the picture's corner at (-0.5, -0.5).
        self.fx = self.fy = focal * scale
        self.cx, self.cy = (float(c) for c in (centre + 0.5) * scale - 0.5)
        if not _is_ideal(calibration):
            self._maps = tuple(self._map_of(camera) for camera in (left, right))

    @property
    def matrix(self) -> NDArray[np.float64]:
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])

    def rectify(self, frame: StereoFrame) -> tuple[Picture, Picture]:
        """Left and right picture, each (height, width)."""
        left, right = (self._rectify_eye(picture, eye) for eye, picture in enumerate((frame.left, frame.right)))
        return left, right

    def _rectify_eye(self, picture: Picture, eye: int) -> Picture:
        if self._maps:
            return np.asarray(cv2.remap(picture, *self._maps[eye], cv2.INTER_LINEAR), dtype=np.uint8)
        if self._resize:
            size = (self.width, self.height)
            return np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
        return picture

    def _map_of(self, camera: PinholeCamera) -> tuple[NDArray[np.int16], NDArray[np.uint16]]:
        rectified_from_camera = self.body_from_rectified.rotation.T @ camera.body_from_camera.rotation
        size = (self.width, self.height)
        fisheye = camera.distortion_model == "equidistant"
        make = cv2.fisheye.initUndistortRectifyMap if fisheye else cv2.initUndistortRectifyMap
        coefficients = camera.distortion if camera.distortion_model != "none" else np.zeros(4)
        first, second = make(camera.matrix, coefficients, rectified_from_camera, self.matrix, size, cv2.CV_16SC2)
        return first, second


def _is_ideal(calibration: StereoCalibration) -> bool:
    left, right = calibration.left, calibration.right
    left_from_right = left.body_from_camera.inverse() @ right.body_from_camera
    return bool(
        left.distortion_model == right.distortion_model == "none"
        and np.allclose(left.matrix, right.matrix)
        and left.fx == left.fy
        and np.allclose(left_from_right.rotation, np.eye(3), atol=1e-9)
        and np.allclose(left_from_right.position[1:], 0.0, atol=1e-9)
    )


def _common_rotation(body_from_left: Pose, body_from_right: Pose) -> NDArray[np.float64]:
    """Axes in body as columns: x along the baseline, z as near to both optical axes as that allows."""
    x = body_from_right.position - body_from_left.position
    x = x / np.linalg.norm(x)
    forward = body_from_left.rotation[:, 2] + body_from_right.rotation[:, 2]
    y = np.cross(forward, x)
    y = y / np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)], axis=1)


def _common_centre(
    left: PinholeCamera, right: PinholeCamera, rotation: NDArray[np.float64], focal: float
) -> NDArray[np.float64]:
    """Principal point that leaves the middles of both pictures in the middle, on average."""
    middle = np.array([(left.width - 1) / 2.0, (left.height - 1) / 2.0])
    seen = []
    for camera in (left, right):
        ray = np.append(normalise(camera, middle[None])[0], 1.0)
        ray = rotation.T @ camera.body_from_camera.rotation @ ray
        seen.append(focal * ray[:2] / ray[2])
    return np.asarray(middle - np.mean(seen, axis=0))
