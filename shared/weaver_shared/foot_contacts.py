"""Feet and the ground: where they were by the joints, and which felt it, for whoever walks on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.leg_batch import LegBatch
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class FootContacts:
    """Where the feet were by the joints, and which felt the ground, at some instants."""

    stamp_ns: NDArray[np.int64]  # (n,)
    foot_in_body: Array  # (n, legs, 3) m
    sole_in_body: Array  # (n, legs, 3) m, the far ends of the last links: they stay where they are while feet roll
    touching: Mask  # (n, legs)

    @staticmethod
    def of(robot: RobotDescription, legs: LegBatch) -> FootContacts | None:
        """What the robot's joints and contact switches say; None without a reading."""
        if not len(legs.stamp_ns):
            return None
        frames = np.array([joint_frames_in_body(robot, joints)[:, -2:, :3, 3] for joints in legs.joint_position])
        feet = frames[:, :, 1]
        last_link = feet - frames[:, :, 0]
        return FootContacts(
            stamp_ns=legs.stamp_ns,
            foot_in_body=feet,
            sole_in_body=feet + robot.foot_radius / np.linalg.norm(last_link, axis=2, keepdims=True) * last_link,
            touching=legs.foot_contact,
        )

    def ground_height(self, world_from_body: Pose, foot_radius: float) -> float:
        """World z in m of the ground under the soles at the end, the body being at `world_from_body` then.

        The mean of the feet that touch; of the three lowest where fewer than three do.
        """
        height = self.foot_in_body[-1] @ world_from_body.rotation[2] + world_from_body.position[2] - foot_radius
        touching = self.touching[-1]
        return float(height[touching].mean() if touching.sum() >= 3 else np.sort(height)[:3].mean())

    @staticmethod
    def join(parts: list[FootContacts]) -> FootContacts:
        return FootContacts(
            stamp_ns=np.concatenate([part.stamp_ns for part in parts]),
            foot_in_body=np.concatenate([part.foot_in_body for part in parts]),
            sole_in_body=np.concatenate([part.sole_in_body for part in parts]),
            touching=np.concatenate([part.touching for part in parts]),
        )
