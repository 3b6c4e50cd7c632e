"""Where an estimate begins: gravity and gyro bias from a moment at rest, or gravity alone when rest does not come."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.rotations import exponential
from weaver_shared.config.odometry import RestConfig, StartConfig
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import rotation_exp

Array = NDArray[np.float64]

HEADING_SIGMA, PLACE_SIGMA = 1e-4, 1e-4
"""rad, m: the world is defined by where the robot begins, so both are known; not zero, to keep the system regular."""

REST_TILT_SIGMA = 0.03
"""rad: loose on purpose; tilt and accelerometer bias are told apart by motion, not by the first guess."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Beginning:
    rotation: Array  # (3, 3) world_from_imu
    gyro_bias: Array  # (3,)
    accel_bias: Array  # (3,)
    information: Array  # (15, 15) on the state of the first frame
    at_rest: bool


def levelled(world_from_imu: Array, up_in_imu: Array) -> Array:
    """The rotation next to `world_from_imu` in which `up_in_imu` (unit vector) points up."""
    up = world_from_imu @ up_in_imu
    axis = np.cross(up, [0.0, 0.0, 1.0])
    sine = float(np.linalg.norm(axis))
    if sine < 1e-9:
        return world_from_imu if up[2] > 0.0 else rotation_exp([np.pi, 0.0, 0.0]) @ world_from_imu
    angle = np.arctan2(sine, up[2])
    return np.asarray(rotation_exp(axis * (angle / sine)) @ world_from_imu)


def is_still(samples: Array, gyro_bias: Array | None, rest: RestConfig, *, seen_still: bool) -> bool:
    """Do samples (n, 7) look like an IMU at rest? Without a known bias, only their spread can tell.

    Where pictures have `seen_still` that nothing moves, the IMU may tremble as it does beside running motors.
    """
    if len(samples) < 4:
        return False
    gyro, accel = samples[:, 1:4], samples[:, 4:7]
    greatest_gyro = rest.shaken_gyro_deviation if seen_still else rest.gyro_deviation
    greatest_accel = rest.shaken_accel_deviation if seen_still else rest.accel_deviation
    if (gyro.std(axis=0) > greatest_gyro).any() or (accel.std(axis=0) > greatest_accel).any():
        return False
    return gyro_bias is None or bool((np.abs(gyro.mean(axis=0) - gyro_bias) < rest.gyro_mean).all())


def begin_at_rest(samples: Array, guess: Array, imu: Imu, config: StartConfig) -> Beginning:
    """Level the guessed world_from_imu (3, 3) by the mean specific force; the mean turn rate is the gyro's bias."""
    duration = float(samples[:, 0].sum())
    force = samples[:, 4:7].mean(axis=0)
    trembling = samples[:, 1:4].std(axis=0).max() / np.sqrt(len(samples))
    gyro_sigma = 2.0 * max(imu.gyro_noise_density / np.sqrt(duration), float(trembling))
    return _beginning(
        rotation=levelled(guess, force / np.linalg.norm(force)),
        gyro_bias=samples[:, 1:4].mean(axis=0),
        accel_bias=np.zeros(3),
        sigmas=(REST_TILT_SIGMA, 0.01, gyro_sigma, config.accel_bias_sigma),
        at_rest=True,
    )


def begin_in_motion(samples: Array, guess: Array, config: StartConfig) -> Beginning:
    """Level by the specific force averaged in the axes of the newest sample, turned there by the gyro."""
    newest_from_sample = np.eye(3)
    total = np.zeros(3)
    for row in samples[::-1]:
        total += newest_from_sample @ row[4:7] * row[0]
        newest_from_sample = newest_from_sample @ exponential(-row[1:4] * row[0])
    norm = float(np.linalg.norm(total))
    return _beginning(
        rotation=levelled(guess, total / norm) if norm > 0.0 else guess,
        gyro_bias=np.zeros(3),
        accel_bias=np.zeros(3),
        sigmas=(
            config.moving_tilt_sigma,
            config.moving_velocity_sigma,
            config.gyro_bias_sigma,
            config.accel_bias_sigma,
        ),
        at_rest=False,
    )


def begin_again(rotation: Array, gyro_bias: Array, accel_bias: Array, config: StartConfig) -> Beginning:
    """Start over in the same world after a loss: attitude (world_from_imu) and biases are still known."""
    return _beginning(
        rotation=rotation,
        gyro_bias=gyro_bias,
        accel_bias=accel_bias,
        sigmas=(
            REST_TILT_SIGMA,
            config.moving_velocity_sigma,
            0.1 * config.gyro_bias_sigma,
            0.5 * config.accel_bias_sigma,
        ),
        at_rest=False,
    )


def _beginning(
    *,
    rotation: Array,
    gyro_bias: Array,
    accel_bias: Array,
    sigmas: tuple[float, float, float, float],
    at_rest: bool,
) -> Beginning:
    tilt, speed, gyro, accel = sigmas
    information = np.diag(1.0 / np.repeat([tilt, PLACE_SIGMA, speed, gyro, accel], 3) ** 2)
    up_in_imu = rotation[2]
    information[:3, :3] += np.outer(up_in_imu, up_in_imu) / HEADING_SIGMA**2
    return Beginning(
        rotation=rotation, gyro_bias=gyro_bias, accel_bias=accel_bias, information=information, at_rest=at_rest
    )
