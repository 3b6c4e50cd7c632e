"""Readings of the legs between two pictures, for the stages that see and feel at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.messages import Proprioception

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class LegBatch:
    """Consecutive readings of the legs, oldest first, in the orders of `Proprioception`."""

    stamp_ns: NDArray[np.int64]  # (n,)
    joint_position: Array  # (n, joints) rad
    joint_torque: Array  # (n, joints) N m
    foot_contact: NDArray[np.bool_]  # (n, legs)

    @staticmethod
    def empty() -> LegBatch:
        return LegBatch.of([])

    @staticmethod
    def of(readings: list[Proprioception]) -> LegBatch:
        """What the legs felt in these ticks."""
        return LegBatch(
            stamp_ns=np.array([sensed.stamp_ns for sensed in readings], dtype=np.int64),
            joint_position=_stacked([sensed.joint_position for sensed in readings]),
            joint_torque=_stacked([sensed.joint_torque for sensed in readings]),
            foot_contact=_stacked([sensed.foot_contact for sensed in readings]).astype(np.bool_),
        )


def _stacked(rows: list[NDArray[np.generic]]) -> Array:
    return np.array(rows, dtype=np.float64) if rows else np.zeros((0, 0))
