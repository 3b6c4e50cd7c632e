"""What was found about camera and IMU, as lines with units and standard deviations."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.inertial_calibration import InertialEstimate
from weaver_shared.transforms import Pose, rotation_log

AXES = ("x", "y", "z")


def inertial_figures(estimate: InertialEstimate, described: Pose) -> Iterator[str]:
    """The main results; `described` is where the robot's description has the left camera in the IMU's frame."""
    place = estimate.imu_from_camera
    yield f"left camera in the IMU's frame: {_each(1e3 * place.position, 1e3 * estimate.position_sigma, 2)} mm"
    turn, sigma = np.degrees(rotation_log(place.rotation)), np.degrees(estimate.rotation_sigma)
    yield f"its rotation vector: {_each(turn, sigma, 4)} degrees"
    apart = described.rotation.T @ place.rotation
    yield (
        f"from the robot's description: {1e3 * np.linalg.norm(place.position - described.position):.1f} mm and "
        f"{np.degrees(np.linalg.norm(rotation_log(apart))):.2f} degrees away"
    )
    yield (
        f"time offset: IMU time is the picture's stamp plus {1e3 * estimate.time_offset:.3f} "
        f"± {1e3 * estimate.time_offset_sigma:.3f} ms"
    )
    yield f"gyro bias: {_each(estimate.gyro_bias, estimate.bias_sigma[:3], 5)} rad/s"
    yield f"accelerometer bias: {_each(estimate.accel_bias, estimate.bias_sigma[3:], 4)} m/s²"
    errors = float(np.sqrt((estimate.corner_errors**2).sum(axis=1).mean()))
    yield f"reprojection error {errors:.3f} px in {estimate.pictures} pictures"


def _each(values: NDArray[np.float64], sigmas: NDArray[np.float64], digits: int) -> str:
    return ", ".join(
        f"{axis} {value:.{digits}f} ± {sigma:.{digits}f}"
        for axis, value, sigma in zip(AXES, values, sigmas, strict=True)
    )
