"""Rigid transforms: `a_from_b @ b_from_c` reads as `a_from_c`, so a wrong product is visible in its names."""

from __future__ import annotations

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
    vector = np.asarray(rotation_vector, dtype=np.float64)
    angle = float(np.linalg.norm(vector))
    cross = skew(vector)
    if angle < 1e-8:
        return np.eye(3) + cross + 0.5 * cross @ cross
    rotation: Array = np.eye(3) + np.sin(angle) / angle * cross + (1.0 - np.cos(angle)) / angle**2 * (cross @ cross)
    return rotation


def rotation_log(rotation: ArrayLike) -> Array:
    """Rotation vector (3,) in rad, length at most pi, of a rotation matrix."""
    w, x, y, z = wxyz_from_rotation(rotation)
    imaginary = np.array([x, y, z])
    sine = float(np.linalg.norm(imaginary))
    if sine < 1e-9:
        return 2.0 * imaginary
    return float(2.0 * np.arctan2(sine, w) / sine) * imaginary


def rotation_from_wxyz(wxyz: ArrayLike) -> Array:
    """Rotation matrix of a quaternion, normalised first. Raises ValueError on a zero quaternion."""
    quaternion = np.asarray(wxyz, dtype=np.float64)
    norm = float(np.linalg.norm(quaternion))
    if not norm > 0.0:
        raise ValueError("a quaternion needs a length above zero")
    w, x, y, z = quaternion / norm
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def wxyz_from_rotation(rotation: ArrayLike) -> Array:
    """Unit quaternion, w first and never negative (Shepperd's choice of the largest component)."""
    m = np.asarray(rotation, dtype=np.float64)
    squares = np.array(
        [
            1.0 + m[0, 0] + m[1, 1] + m[2, 2],
            1.0 + m[0, 0] - m[1, 1] - m[2, 2],
            1.0 - m[0, 0] + m[1, 1] - m[2, 2],
            1.0 - m[0, 0] - m[1, 1] + m[2, 2],
        ]
    )
    largest = int(np.argmax(squares))
    s = 2.0 * np.sqrt(squares[largest])
    if largest == 0:
        q = np.array([s / 4, (m[2, 1] - m[1, 2]) / s, (m[0, 2] - m[2, 0]) / s, (m[1, 0] - m[0, 1]) / s])
    elif largest == 1:
        q = np.array([(m[2, 1] - m[1, 2]) / s, s / 4, (m[0, 1] + m[1, 0]) / s, (m[0, 2] + m[2, 0]) / s])
    elif largest == 2:
        q = np.array([(m[0, 2] - m[2, 0]) / s, (m[0, 1] + m[1, 0]) / s, s / 4, (m[1, 2] + m[2, 1]) / s])
    else:
        q = np.array([(m[1, 0] - m[0, 1]) / s, (m[0, 2] + m[2, 0]) / s, (m[1, 2] + m[2, 1]) / s, s / 4])
    normalised: Array = q / np.linalg.norm(q)
    return -normalised if normalised[0] < 0.0 else normalised


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
    m = np.asarray(rotation, dtype=np.float64)
    pitch = np.arcsin(np.clip(-m[2, 0], -1.0, 1.0))
    return np.array([np.arctan2(m[2, 1], m[2, 2]), pitch, np.arctan2(m[1, 0], m[0, 0])])


def yaw_of(rotation: ArrayLike) -> float:
    m = np.asarray(rotation, dtype=np.float64)
    return float(np.arctan2(m[1, 0], m[0, 0]))


def wrap_angle(angle: float) -> float:
    """The same angle within (-pi, pi]."""
    return float(-((-angle + np.pi) % (2.0 * np.pi) - np.pi))
