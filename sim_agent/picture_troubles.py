"""What can go wrong with pictures, done to rendered ones: darkness, a covered lens, blur, bare ground, a passer-by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.vision.camera import PinholeCamera, StereoCalibration
from weaver_shared.messages import StereoFrame
from weaver_shared.transforms import Pose

Picture = NDArray[np.uint8]
Array = NDArray[np.float64]

BLUR = 21
"""px that a motion-blurred picture smears over."""

GROUND_NOISE = 2.0
"""Grey values of the sensor's noise, which bare ground has as well."""

NEAREST = 0.05
"""m, what is nearer to the lens is cut away before it is drawn."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """What a trouble may know of a picture: when it was taken within the trouble, and from where."""

    seconds: float  # since the trouble began
    world_from_body: Pose  # true: what is drawn into the world is drawn where it is
    place: Array  # (2,) m in world, ground that is seen ahead when the trouble begins
    random: np.random.Generator


Trouble = Callable[[StereoFrame, Moment], StereoFrame | None]
"""The frame with the trouble; None where it is lost altogether."""


def dark(frame: StereoFrame, _: Moment) -> StereoFrame:
    return replace(frame, left=np.zeros_like(frame.left), right=np.zeros_like(frame.right))


def one_eyed(frame: StereoFrame, _: Moment) -> StereoFrame:
    return replace(frame, right=np.zeros((0, 0), dtype=np.uint8))


def dropped(frame: StereoFrame, moment: Moment) -> StereoFrame | None:
    """One in five is lost."""
    return None if moment.random.uniform() < 0.2 else frame


def blurred(frame: StereoFrame, _: Moment) -> StereoFrame:
    """Smeared along the picture's columns, as by walking fast with long exposure."""
    kernel = np.full((BLUR, 1), 1.0 / BLUR)

    def smeared(picture: Picture) -> Picture:
        return np.asarray(cv2.filter2D(picture, -1, kernel), dtype=np.uint8)

    return replace(frame, left=smeared(frame.left), right=smeared(frame.right))


class BareGround:
    """A square of ground without any texture around the trouble's place."""

    def __init__(self, calibration: StereoCalibration, side: float) -> None:
        self._calibration = calibration
        self._half = 0.5 * side

    def __call__(self, frame: StereoFrame, moment: Moment) -> StereoFrame:
        x, y = moment.place
        h = self._half
        corners = np.array([[x - h, y - h, 0.0], [x + h, y - h, 0.0], [x + h, y + h, 0.0], [x - h, y + h, 0.0]])

        def painted(picture: Picture, eye: PinholeCamera) -> Picture:
            mask = np.zeros_like(picture)
            _fill(mask, _seen(corners, eye, moment.world_from_body), 255)
            grey = moment.random.normal(120.0, GROUND_NOISE, picture.shape)
            return np.where(mask > 0, np.clip(grey, 0.0, 255.0), picture).astype(np.uint8)

        eyes = self._calibration
        return replace(frame, left=painted(frame.left, eyes.left), right=painted(frame.right, eyes.right))


class PasserBy:
    """Somebody in checked trousers who walks across, from right to left, close before the robot."""

    def __init__(self, calibration: StereoCalibration, *, speed: float = 0.5, width: float = 0.5) -> None:
        self._calibration = calibration
        self._speed = speed
        self._width = width
        checks = np.indices((24, 8)).sum(axis=0) % 2
        noise = np.random.default_rng(5).integers(0, 60, (24, 8))
        self._cloth = (60 + 120 * checks + noise).astype(np.uint8).repeat(10, axis=0).repeat(10, axis=1)

    def __call__(self, frame: StereoFrame, moment: Moment) -> StereoFrame:
        x = moment.place[0]
        y = moment.place[1] - 0.8 + self._speed * moment.seconds
        bottom = np.array([[x, y + 0.5 * self._width, 0.0], [x, y - 0.5 * self._width, 0.0]])
        corners = np.vstack([bottom + np.array([0.0, 0.0, 1.2]), bottom[::-1]])

        def crossed(picture: Picture, eye: PinholeCamera) -> Picture:
            seen = _project(corners, eye, moment.world_from_body)
            if seen is None:
                return picture
            height, width = self._cloth.shape
            source = np.array([[0, 0], [width, 0], [width, height], [0, height]], dtype=np.float32)
            warp = cv2.getPerspectiveTransform(source, seen.astype(np.float32))
            size = (picture.shape[1], picture.shape[0])
            mask = cv2.warpPerspective(np.full_like(self._cloth, 255), warp, size)
            cloth = cv2.warpPerspective(self._cloth, warp, size)
            return np.where(mask > 0, cloth, picture).astype(np.uint8)

        eyes = self._calibration
        return replace(frame, left=crossed(frame.left, eyes.left), right=crossed(frame.right, eyes.right))


def _in_eye(corners: Array, eye: PinholeCamera, world_from_body: Pose) -> Array:
    return (world_from_body @ eye.body_from_camera).inverse().transform(corners)


def _project(corners: Array, eye: PinholeCamera, world_from_body: Pose) -> Array | None:
    """Pixels (n, 2) of points in world; None as soon as one is not before the lens."""
    seen = _in_eye(corners, eye, world_from_body)
    if (seen[:, 2] < NEAREST).any():
        return None
    pixels = seen @ eye.matrix.T
    return np.asarray(pixels[:, :2] / pixels[:, 2:])


def _seen(corners: Array, eye: PinholeCamera, world_from_body: Pose) -> Array:
    """Pixels (m, 2) of a convex polygon in world, cut where it goes behind the lens."""
    points = _in_eye(corners, eye, world_from_body)
    kept: list[Array] = []
    for here, there in zip(points, np.roll(points, -1, axis=0), strict=True):
        if here[2] >= NEAREST:
            kept.append(here)
        if (here[2] >= NEAREST) != (there[2] >= NEAREST):
            part = (NEAREST - here[2]) / (there[2] - here[2])
            kept.append(here + part * (there - here))
    pixels = np.array(kept).reshape(-1, 3) @ eye.matrix.T
    return np.asarray(pixels[:, :2] / pixels[:, 2:])


def _fill(mask: Picture, polygon: Array, value: int) -> None:
    if len(polygon) >= 3:
        cv2.fillConvexPoly(mask, np.clip(polygon, -20000.0, 20000.0).astype(np.int32), value)
