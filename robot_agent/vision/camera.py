"""Pinhole cameras with lens distortion, singly and as a stereo pair on a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

Distortion = Literal["none", "radtan", "equidistant"]


@dataclass(frozen=True, slots=True, kw_only=True)
class PinholeCamera:
    """Intrinsics in pixels, distortion as in Kalibr's files (k1 k2 p1 p2, or k1..k4 of the fisheye model)."""

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    distortion_model: Distortion
    distortion: NDArray[np.float64]  # (4,)
    body_from_camera: Pose  # camera: optical frame, x right, y down, z forward

    @property
    def matrix(self) -> NDArray[np.float64]:
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])


@dataclass(frozen=True, slots=True, kw_only=True)
class StereoCalibration:
    """Two eyes; `time_offset` is added to a picture's stamp to get the IMU's time (s)."""

    left: PinholeCamera
    right: PinholeCamera
    time_offset: float = 0.0

    @staticmethod
    def of_robot(robot: RobotDescription) -> StereoCalibration:
        """The ideal pair of a robot description: no distortion, parallel axes."""
        fx, fy, cx, cy = robot.camera.intrinsics

        def eye(body_from_camera: Pose) -> PinholeCamera:
            return PinholeCamera(
                width=robot.camera.width,
                height=robot.camera.height,
                fx=fx,
                fy=fy,
                cx=cx,
                cy=cy,
                distortion_model="none",
                distortion=np.zeros(4),
                body_from_camera=body_from_camera,
            )

        return StereoCalibration(left=eye(robot.camera.body_from_left), right=eye(robot.camera.body_from_right))
