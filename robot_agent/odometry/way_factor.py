"""The way over standing feet as a measurement between two frames."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.rotations import cross_matrix
from robot_agent.odometry.window_state import POSITION, ROTATION, STATE, Frames

Array = NDArray[np.float64]


class Ways(NamedTuple):
    """Slot k leads from frame k - 1 to frame k, in the IMU's axes at frame k - 1."""

    displacement: Array  # (slots, 3) m
    variance: Array  # (slots,) m^2; 0 where nothing is known

    @staticmethod
    def of(slots: int) -> Ways:
        return Ways(displacement=np.zeros((slots, 3)), variance=np.zeros(slots))

    def remove(self, slot: int) -> None:
        for array in self:
            array[slot:-1] = array[slot + 1 :].copy()


@compiled
def way_residual(frames: Frames, ways: Ways, k: int) -> Array:
    """How far frame k is from where the feet put it, in the axes of frame k - 1, (3,) m."""
    imu_from_world = np.ascontiguousarray(frames.rotation[k - 1].T)
    residual: Array = imu_from_world @ (frames.position[k] - frames.position[k - 1]) - ways.displacement[k]
    return residual


@compiled
def way_jacobian(frames: Frames, k: int) -> Array:
    """Derivative (3, 30) to the states of frames k - 1 and k."""
    imu_from_world = np.ascontiguousarray(frames.rotation[k - 1].T)
    j = np.zeros((3, 2 * STATE))
    j[:, ROTATION : ROTATION + 3] = cross_matrix(imu_from_world @ (frames.position[k] - frames.position[k - 1]))
    j[:, POSITION : POSITION + 3] = -imu_from_world
    j[:, STATE + POSITION : STATE + POSITION + 3] = imu_from_world
    return j


@compiled
def add_ways(
    frames: Frames,
    origin: Frames,
    ways: Ways,
    first: int,
    last: int,
    huber: float,
    hessian: Array,
    gradient: Array,
) -> float:
    """Add the factors that end at frames first + 1 .. last, less of those beyond `huber` sigmas (all feet slipped)."""
    cost = 0.0
    for k in range(first + 1, last + 1):
        if not ways.variance[k] > 0.0:
            continue
        residual = way_residual(frames, ways, k)
        size = np.sqrt(float(residual @ residual) / ways.variance[k])
        weight = (1.0 if size <= huber else huber / size) / ways.variance[k]
        jacobian = way_jacobian(origin, k)
        transposed = np.ascontiguousarray(jacobian.T)
        begin = STATE * (k - 1)
        hessian[begin : begin + 2 * STATE, begin : begin + 2 * STATE] += weight * (transposed @ jacobian)
        gradient[begin : begin + 2 * STATE] += weight * (transposed @ residual)
        cost += 0.5 * size * size if size <= huber else huber * (size - 0.5 * huber)
    return cost
