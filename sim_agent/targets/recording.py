"""A made-up stereo-inertial rig, waved before a target: pictures, samples and the truth behind them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.rig import Rig
from robot_agent.calibration.target import AprilGrid
from robot_agent.vision.camera import Distortion
from sim_agent.targets.motion import HandHeldMotion, gravity_before, inertia_along
from sim_agent.targets.rendering import TargetRenderer
from weaver_shared.messages import ImuBatch
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose, rotation_exp

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]

LENSES: dict[Distortion, Array] = {
    "radtan": np.array([-0.28, 0.07, 2e-4, -1e-4]),
    "equidistant": np.array([0.04, -0.02, 0.005, -0.001]),
}

EXPOSURE = 0.004
"""s; at 1 rad/s and 460 px of focal length it smears by 2 px."""

INSTANTS = 9
"""Poses a picture's exposure is spread over."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RigTruth:
    """What a calibration has to find."""

    rig: Rig
    camera_from_imu: Pose
    time_offset: float  # s, added to a picture's stamp to get the IMU's time
    gravity_in_target: Array
    biases: Array  # (2, 3) at the begin


def draw_rig(generator: np.random.Generator, model: Distortion, size: tuple[int, int] = (640, 480)) -> RigTruth:
    """Two eyes 0.11 m apart, not quite parallel, an IMU some centimetres aside, clocks some milliseconds apart."""
    scale = size[0] / 640.0
    middle = np.array([(size[0] - 1) / 2.0, (size[1] - 1) / 2.0])
    intrinsics = np.empty((2, 8))
    for eye in range(2):
        intrinsics[eye, :2] = scale * (458.0 + generator.uniform(-8.0, 8.0) + generator.uniform(-1.5, 1.5, 2))
        intrinsics[eye, 2:4] = middle + scale * generator.uniform(-8.0, 8.0, 2)
        intrinsics[eye, 4:] = LENSES[model] * generator.uniform(0.8, 1.2, 4)
    second = Pose(
        rotation=rotation_exp(generator.uniform(-0.02, 0.02, 3)),
        position=np.array([-0.11, 0.0, 0.0]) + generator.uniform(-0.003, 0.003, 3),
    )
    return RigTruth(
        rig=Rig(
            models=(model, model), intrinsics=intrinsics, eye_from_first=(Pose.identity(), second), sizes=(size, size)
        ),
        camera_from_imu=Pose(
            rotation=rotation_exp(generator.uniform(-1.5, 1.5, 3)), position=generator.uniform(-0.06, 0.06, 3)
        ),
        time_offset=float(generator.uniform(-0.015, 0.015)),
        gravity_in_target=gravity_before(generator.uniform(-0.1, 0.1, 3)),
        biases=np.stack([generator.normal(0.0, 0.004, 3), generator.normal(0.0, 0.03, 3)]),
    )


class TargetRecording:
    """`frames` at `rate` Hz, rendered one after another; their stamps lag the truth by the rig's time offset."""

    def __init__(
        self,
        truth: RigTruth,
        grid: AprilGrid,
        motion: HandHeldMotion,
        imu: Imu,
        generator: np.random.Generator,
        *,
        seconds: float,
        rate: float = 20.0,
    ) -> None:
        self._truth, self._motion, self._generator = truth, motion, generator
        self._renderers = [TargetRenderer(grid, camera) for camera in truth.rig.cameras]
        self.times = np.arange(1.0, 1.0 + seconds, 1.0 / rate)
        samples = np.arange(0.5, 1.5 + seconds, 1.0 / imu.rate)
        self.inertia: ImuBatch = inertia_along(
            motion, truth.camera_from_imu, samples, truth.gravity_in_target, imu, truth.biases, generator
        )

    def __len__(self) -> int:
        return len(self.times)

    def __iter__(self) -> Iterator[tuple[int, list[Picture]]]:
        """Stamp (ns) and both eyes' pictures; the stamp is the middle of the exposure by the camera's own clock."""
        for time in self.times:
            parts = time + EXPOSURE * ((np.arange(INSTANTS) + 0.5) / INSTANTS - 0.5)
            poses = [self._motion.target_from_camera(float(part)) for part in parts]
            pictures = [
                renderer.draw([pose @ place.inverse() for pose in poses], self._generator)
                for renderer, place in zip(self._renderers, self._truth.rig.eye_from_first, strict=True)
            ]
            yield round((time - self._truth.time_offset) * 1e9), pictures
