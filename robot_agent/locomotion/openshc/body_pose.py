"""OpenSHC's poses, whose removal does not undo their addition (facts 3.11, D17)."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi

import numpy as np
from numpy.typing import NDArray

from weaver_shared.transforms import rotation_exp, rotation_log, rotation_x, rotation_y, rotation_z

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class BodyPose:
    """`position` (3,) m and `rotation` (3, 3) of the body over the walk plane."""

    position: Array = field(default_factory=lambda: np.zeros(3))
    rotation: Array = field(default_factory=lambda: np.eye(3))

    def added(self, other: BodyPose) -> BodyPose:
        return BodyPose(self.position + self.rotation @ other.position, self.rotation @ other.rotation)

    def removed(self, other: BodyPose) -> BodyPose:
        """Off by (1 - R) p of what is removed, where it both turns and shifts."""
        return BodyPose(self.position - self.rotation @ other.position, self.rotation @ other.rotation.T)

    def blended(self, share: float, other: BodyPose) -> BodyPose:
        """This pose at 0, `other` at 1; rotations along the shortest way."""
        position = share * other.position + (1.0 - share) * self.position
        turn = self.rotation.T @ other.rotation
        return BodyPose(position, self.rotation @ rotation_exp(share * rotation_log(turn)))

    def into(self, point: Array) -> Array:
        """`point` (3,) of the walk plane as the body sees it."""
        seen: Array = self.rotation.T @ (point - self.position)
        return seen

    def out_of(self, point: Array) -> Array:
        placed: Array = self.position + self.rotation @ point
        return placed


def smooth_step(share: float) -> float:
    """6 c^5 - 15 c^4 + 10 c^3."""
    return 6.0 * share**5 - 15.0 * share**4 + 10.0 * share**3


def rotation_of_intrinsic(roll: float, pitch: float, yaw: float) -> Array:
    """Rx(roll) Ry(pitch) Rz(yaw)."""
    return rotation_x(roll) @ rotation_y(pitch) @ rotation_z(yaw)


def intrinsic_of(rotation: Array) -> Array:
    """Roll, pitch, yaw of `rotation_of_intrinsic`, pitch within +-pi/2."""
    m = rotation
    return np.array(
        [np.arctan2(-m[1, 2], m[2, 2]), np.arcsin(np.clip(m[0, 2], -1.0, 1.0)), np.arctan2(-m[0, 1], m[0, 0])]
    )


def tilt_between_up_and(normal: Array) -> Array:
    """Shortest rotation (3, 3) of the z axis into `normal` (3,), a unit vector."""
    axis = np.array([-normal[1], normal[0], 0.0])
    sine = float(np.linalg.norm(axis))
    if sine == 0.0:
        return np.eye(3) if normal[2] > 0.0 else rotation_x(pi)
    return rotation_exp(axis / sine * np.arctan2(sine, normal[2]))


def projected(vector: Array, along: Array) -> Array:
    """Part of `vector` along `along`, both (3,)."""
    square = float(along @ along)
    if square == 0.0:
        return np.zeros(3)
    part: Array = (float(vector @ along) / square) * along
    return part
