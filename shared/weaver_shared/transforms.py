"""Rigid transforms: `a_from_b @ b_from_c` reads as `a_from_c`, so a wrong product is visible in its names."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Pose:
    """Rotation (3, 3) and translation (3,) in metres of one frame seen from another."""

    rotation: Array
    position: Array

    @staticmethod
    def identity() -> Pose:
        return Pose(rotation=np.eye(3), position=np.zeros(3))

    @staticmethod
    def of(position: ArrayLike, wxyz: ArrayLike = (1.0, 0.0, 0.0, 0.0)) -> Pose:
        """Pose from a position (3,) in metres and a unit quaternion, w first."""
        return Pose(rotation=rotation_from_wxyz(wxyz), position=np.asarray(position, dtype=np.float64))

    @property
    def wxyz(self) -> Array:
        return wxyz_from_rotation(self.rotation)

    @property
    def matrix(self) -> Array:
        """Homogeneous matrix (4, 4)."""
        result = np.eye(4)
        result[:3, :3] = self.rotation
        result[:3, 3] = self.position
        return result

    @property
    def yaw(self) -> float:
        return yaw_of(self.rotation)

    def inverse(self) -> Pose:
        transposed = self.rotation.T
        return Pose(rotation=transposed, position=-transposed @ self.position)

    def __matmul__(self, other: Pose) -> Pose:
        return Pose(
            rotation=self.rotation @ other.rotation,
            position=self.rotation @ other.position + self.position,
        )

    def transform(self, points: ArrayLike) -> Array:
        """Map points (..., 3) from the right-hand frame to the left-hand frame."""
        return np.asarray(points, dtype=np.float64) @ self.rotation.T + self.position


def skew(vector: ArrayLike) -> Array:
    """Matrix (3, 3) of the cross product with `vector`."""
    x, y, z = np.asarray(vector, dtype=np.float64)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def rotation_exp(rotation_vector: ArrayLike) -> Array:
    """Rotation matrix of a rotation vector (3,) in rad (Rodrigues)."""
    x, y, z = _floats(rotation_vector)
    squared = x * x + y * y + z * z
    if squared < 1e-16:
        first, second = 1.0, 0.5
    else:
        angle = math.sqrt(squared)
        first, second = math.sin(angle) / angle, (1.0 - math.cos(angle)) / squared
    xy, xz, yz = second * x * y, second * x * z, second * y * z
    return np.array(
        [
            [1.0 - second * (y * y + z * z), xy - first * z, xz + first * y],
            [xy + first * z, 1.0 - second * (x * x + z * z), yz - first * x],
            [xz - first * y, yz + first * x, 1.0 - second * (x * x + y * y)],
        ]
    )


def rotation_log(rotation: ArrayLike) -> Array:
    """Rotation vector (3,) in rad, length at most pi, of a rotation matrix."""
    w, x, y, z = _quaternion(rotation)
    sine = math.sqrt(x * x + y * y + z * z)
    scale = 2.0 if sine < 1e-9 else 2.0 * math.atan2(sine, w) / sine
    return np.array([scale * x, scale * y, scale * z])


def rotation_from_wxyz(wxyz: ArrayLike) -> Array:
    """Rotation matrix of a quaternion, normalised first. Raises ValueError on a zero quaternion."""
    w, x, y, z = _floats(wxyz)
    norm = math.sqrt(w * w + x * x + y * y + z * z)
    if not norm > 0.0:
        raise ValueError("a quaternion needs a length above zero")
    w, x, y, z = w / norm, x / norm, y / norm, z / norm
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def wxyz_from_rotation(rotation: ArrayLike) -> Array:
    """Unit quaternion, w first and never negative."""
    return np.array(_quaternion(rotation))


def _quaternion(rotation: ArrayLike) -> tuple[float, float, float, float]:
    """Shepperd's choice of the largest component. Plain floats: numpy's calls cost ten times these few products."""
    xx, xy, xz, yx, yy, yz, zx, zy, zz = np.asarray(rotation, dtype=np.float64).ravel().tolist()
    squares = (1.0 + xx + yy + zz, 1.0 + xx - yy - zz, 1.0 - xx + yy - zz, 1.0 - xx - yy + zz)
    greatest = max(squares)
    largest = squares.index(greatest)
    if largest == 0:
        q = (greatest, zy - yz, xz - zx, yx - xy)
    elif largest == 1:
        q = (zy - yz, greatest, xy + yx, xz + zx)
    elif largest == 2:
        q = (xz - zx, xy + yx, greatest, yz + zy)
    else:
        q = (yx - xy, xz + zx, yz + zy, greatest)
    w, x, y, z = q
    norm = math.copysign(math.sqrt(w * w + x * x + y * y + z * z), w)
    return w / norm, x / norm, y / norm, z / norm


def _floats(vector: ArrayLike) -> list[float]:
    floats: list[float] = np.asarray(vector, dtype=np.float64).tolist()
    return floats


def rotation_x(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def rotation_y(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def rotation_z(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def rotation_from_rpy(roll: float, pitch: float, yaw: float) -> Array:
    """Rz(yaw) Ry(pitch) Rx(roll), angles in rad."""
    return rotation_z(yaw) @ rotation_y(pitch) @ rotation_x(roll)


def rpy_from_rotation(rotation: ArrayLike) -> Array:
    """Roll, pitch, yaw in rad of `rotation_from_rpy`; pitch within +-pi/2."""
    (xx, _, _), (yx, _, _), (zx, zy, zz) = np.asarray(rotation, dtype=np.float64).tolist()
    pitch = math.asin(min(max(-zx, -1.0), 1.0))
    return np.array([math.atan2(zy, zz), pitch, math.atan2(yx, xx)])


def yaw_of(rotation: ArrayLike) -> float:
    m = np.asarray(rotation, dtype=np.float64)
    return float(np.arctan2(m[1, 0], m[0, 0]))


def wrap_angle(angle: float) -> float:
    """The same angle within (-pi, pi]."""
    return float(-((-angle + np.pi) % (2.0 * np.pi) - np.pi))
