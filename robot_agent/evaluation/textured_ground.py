"""A flat, textured ground as an ideal stereo pair sees it: pictures whose truth is known, without a simulator."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.vision.camera import PinholeCamera, StereoCalibration
from weaver_shared.messages import StereoFrame
from weaver_shared.transforms import Pose

Picture = NDArray[np.uint8]

RESOLUTION = 0.003
"""m of ground per texture pixel."""


class TexturedGround:
    """Ground at z = 0 of world, 6 m by 4 m about (2, 0), with grain from 6 mm up to a metre."""

    def __init__(self, calibration: StereoCalibration, seed: int, noise: float = 2.0) -> None:
        self._eyes = (calibration.left, calibration.right)
        self._random = np.random.default_rng(seed)
        self._noise = noise
        rows, columns = round(4.0 / RESOLUTION), round(6.0 / RESOLUTION)
        self._texture = _grain(rows, columns, self._random)
        # Texture pixel (column, row) lies at x = column * resolution - 1, y = 2 - row * resolution.
        self._ground_from_texture = np.array([[RESOLUTION, 0.0, -1.0], [0.0, -RESOLUTION, 2.0], [0.0, 0.0, 1.0]])

    def look(self, stamp_ns: int, sequence: int, world_from_body: Pose) -> StereoFrame:
        """Both eyes' pictures from a body above the ground, with the sensor's noise (grey values)."""
        left, right = (self._picture(eye, world_from_body @ eye.body_from_camera) for eye in self._eyes)
        return StereoFrame(stamp_ns=stamp_ns, sequence=sequence, left=left, right=right)

    def _picture(self, eye: PinholeCamera, world_from_eye: Pose) -> Picture:
        eye_from_world = world_from_eye.inverse()
        eye_from_ground = np.column_stack(
            [eye_from_world.rotation[:, 0], eye_from_world.rotation[:, 1], eye_from_world.position]
        )
        picture = cv2.warpPerspective(
            self._texture,
            eye.matrix @ eye_from_ground @ self._ground_from_texture,
            (eye.width, eye.height),
            flags=cv2.INTER_LINEAR,
            borderMode=cv2.BORDER_REFLECT,
        )
        noisy = picture + self._random.normal(0.0, self._noise, picture.shape)
        return np.asarray(np.clip(noisy, 0.0, 255.0), dtype=np.uint8)


def _grain(rows: int, columns: int, random: np.random.Generator) -> Picture:
    """Noise of several sizes on top of each other, stretched to the full range of grey."""
    total = np.zeros((rows, columns))
    for size, strength in ((2, 1.0), (6, 1.0), (20, 0.8), (80, 0.8), (300, 0.6)):
        coarse = random.normal(0.0, 1.0, (rows // size + 2, columns // size + 2))
        total += strength * cv2.resize(coarse, (columns, rows), interpolation=cv2.INTER_CUBIC)
    low, high = np.percentile(total, (1.0, 99.0))
    return np.asarray(np.clip(255.0 * (total - low) / (high - low), 0.0, 255.0), dtype=np.uint8)
