"""The arrays of the sliding window, one slot a frame, oldest first. Poses are those of the IMU in world.

What all frames have in common follows theirs: the pictures' time offset, and where the rig of both eyes sits on the
IMU, as a correction to its calibration.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.rotations import exponential, logarithm, orthonormal

Array = NDArray[np.float64]

STATE = 15
"""Unknowns of a frame: rotation (in imu), position, velocity (in world), gyro bias, accelerometer bias."""
ROTATION, POSITION, VELOCITY, GYRO_BIAS, ACCEL_BIAS = 0, 3, 6, 9, 12

COMMON = 7
"""Unknowns of all frames together, after theirs: time offset, turn of the rig (in imu), its shift (in the rig)."""
TIME_OFFSET, RIG_ROTATION, RIG_SHIFT = 0, 1, 4

COMMON_FIELDS = 3
"""Of `Frames`, at its end, that have no slots."""


class Frames(NamedTuple):
    rotation: Array  # (slots, 3, 3) world_from_imu
    position: Array  # (slots, 3) of the IMU in world
    velocity: Array  # (slots, 3) in world
    gyro_bias: Array  # (slots, 3)
    accel_bias: Array  # (slots, 3)
    rate: Array  # (slots, 3) angular velocity in imu at the frame, bias removed
    time_offset: Array  # (1,) s added to a picture's stamp for the IMU's time
    rig_rotation: Array  # (3, 3) imu_from_rig, where the rig is the IMU as the calibrated eyes believe it
    rig_shift: Array  # (3,) m, of the IMU in the rig's axes: a point is at rig_rotation^T point - rig_shift

    @staticmethod
    def of(slots: int) -> Frames:
        return Frames(
            rotation=np.tile(np.eye(3), (slots, 1, 1)),
            position=np.zeros((slots, 3)),
            velocity=np.zeros((slots, 3)),
            gyro_bias=np.zeros((slots, 3)),
            accel_bias=np.zeros((slots, 3)),
            rate=np.zeros((slots, 3)),
            time_offset=np.zeros(1),
            rig_rotation=np.eye(3),
            rig_shift=np.zeros(3),
        )

    def remove(self, slot: int) -> None:
        """Close the gap that `slot` leaves."""
        for array in self[:-COMMON_FIELDS]:
            array[slot:-1] = array[slot + 1 :].copy()


@compiled
def unknowns(count: int) -> int:
    """Size of the system of `count` frames: their states and what they have in common."""
    return STATE * count + COMMON


@compiled
def copy_slot(source: Frames, target: Frames, slot: int) -> None:
    target.rotation[slot] = source.rotation[slot]
    target.position[slot] = source.position[slot]
    target.velocity[slot] = source.velocity[slot]
    target.gyro_bias[slot] = source.gyro_bias[slot]
    target.accel_bias[slot] = source.accel_bias[slot]


@compiled
def copy_common(source: Frames, target: Frames) -> None:
    target.time_offset[:] = source.time_offset
    target.rig_rotation[:] = source.rig_rotation
    target.rig_shift[:] = source.rig_shift


@compiled
def advance(frames: Frames, count: int, step: Array) -> None:
    """Add a step (unknowns,): rotations on the right (the rig's on the left), everything else as vectors."""
    for k in range(count):
        d = step[STATE * k : STATE * (k + 1)]
        frames.rotation[k] = orthonormal(frames.rotation[k] @ exponential(d[ROTATION:POSITION]))
        frames.position[k] += d[POSITION:VELOCITY]
        frames.velocity[k] += d[VELOCITY:GYRO_BIAS]
        frames.gyro_bias[k] += d[GYRO_BIAS:ACCEL_BIAS]
        frames.accel_bias[k] += d[ACCEL_BIAS:]
    d = step[STATE * count :]
    frames.time_offset[0] += d[TIME_OFFSET]
    frames.rig_rotation[:] = orthonormal(exponential(d[RIG_ROTATION:RIG_SHIFT]) @ frames.rig_rotation)
    frames.rig_shift[:] += d[RIG_SHIFT:COMMON]


@compiled
def difference(frames: Frames, origin: Frames, count: int) -> Array:
    """The step (unknowns,) that leads from `origin` to `frames`."""
    step = np.zeros(unknowns(count))
    for k in range(count):
        d = step[STATE * k : STATE * (k + 1)]
        d[ROTATION:POSITION] = logarithm(np.ascontiguousarray(origin.rotation[k].T) @ frames.rotation[k])
        d[POSITION:VELOCITY] = frames.position[k] - origin.position[k]
        d[VELOCITY:GYRO_BIAS] = frames.velocity[k] - origin.velocity[k]
        d[GYRO_BIAS:ACCEL_BIAS] = frames.gyro_bias[k] - origin.gyro_bias[k]
        d[ACCEL_BIAS:] = frames.accel_bias[k] - origin.accel_bias[k]
    d = step[STATE * count :]
    d[TIME_OFFSET] = frames.time_offset[0] - origin.time_offset[0]
    d[RIG_ROTATION:RIG_SHIFT] = logarithm(frames.rig_rotation @ np.ascontiguousarray(origin.rig_rotation.T))
    d[RIG_SHIFT:COMMON] = frames.rig_shift - origin.rig_shift
    return step
