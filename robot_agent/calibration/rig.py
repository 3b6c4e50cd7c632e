"""What a camera calibration estimates: the eyes' lenses and where each stands from the first one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.lens import MODELS, camera_of, intrinsics_of
from robot_agent.vision.camera import Distortion, PinholeCamera
from weaver_shared.transforms import Pose, rotation_exp

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Rig:
    """One or two eyes; the first one's optical frame is the rig's."""

    models: tuple[Distortion, ...]
    intrinsics: Array  # (eyes, 8): fx, fy, cx, cy, distortion
    eye_from_first: tuple[Pose, ...]  # the first is the identity
    sizes: tuple[tuple[int, int], ...]  # px

    @staticmethod
    def of(cameras: Sequence[PinholeCamera]) -> Rig:
        """Eyes on one body, whichever that is."""
        first = cameras[0].body_from_camera
        return Rig(
            models=tuple(camera.distortion_model for camera in cameras),
            intrinsics=np.array([intrinsics_of(camera) for camera in cameras]),
            eye_from_first=tuple(camera.body_from_camera.inverse() @ first for camera in cameras),
            sizes=tuple((camera.width, camera.height) for camera in cameras),
        )

    @property
    def eyes(self) -> int:
        return len(self.models)

    @property
    def model_numbers(self) -> NDArray[np.int64]:
        return np.array([MODELS.index(model) for model in self.models])

    @property
    def rotations(self) -> Array:
        return np.array([pose.rotation for pose in self.eye_from_first])

    @property
    def positions(self) -> Array:
        return np.array([pose.position for pose in self.eye_from_first])

    @property
    def cameras(self) -> list[PinholeCamera]:
        """Each eye in a body frame that is the first eye's own."""
        return [
            camera_of(model, intrinsics, size, pose.inverse())
            for model, intrinsics, size, pose in zip(
                self.models, self.intrinsics, self.sizes, self.eye_from_first, strict=True
            )
        ]

    @property
    def baseline(self) -> float:
        """Between the eyes' centres, m."""
        return float(np.linalg.norm(self.eye_from_first[1].position))


def moved(pose: Pose, step: Array) -> Pose:
    """`pose` followed by a small motion (6,) in the frame it leads to: rotation vector (rad), then translation (m)."""
    turn = rotation_exp(step[:3])
    return Pose(rotation=turn @ pose.rotation, position=turn @ pose.position + step[3:])
