"""Keeps what the body felt between two pictures and hands it over with the second, each reading once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from weaver_shared.leg_batch import LegBatch
from weaver_shared.messages import ImuBatch, Proprioception

CAPACITY = 2000
"""Control ticks kept at most: 20 s without a picture."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Felt:
    imu: ImuBatch
    legs: LegBatch


class FeltQueue:
    """Collects control ticks; inertial samples are split at a picture's stamp, ticks belong to where they begin."""

    def __init__(self) -> None:
        self._imu: list[ImuBatch] = []
        self._ticks: list[Proprioception] = []

    def add(self, sensed: Proprioception) -> None:
        if sensed.imu.stamp_ns.size:
            self._imu.append(sensed.imu)
            del self._imu[:-CAPACITY]
        self._ticks.append(sensed)
        del self._ticks[:-CAPACITY]

    def newest_imu_ns(self) -> int:
        return int(self._imu[-1].stamp_ns[-1]) if self._imu else -1

    def up_to(self, stamp_ns: int) -> Felt:
        """Remove and return all that is not later than `stamp_ns`."""
        joined = ImuBatch.join(self._imu)
        split = int(np.searchsorted(joined.stamp_ns, stamp_ns, side="right"))
        rest = _cut(joined, slice(split, None))
        self._imu = [rest] if rest.stamp_ns.size else []
        felt = [sensed for sensed in self._ticks if sensed.stamp_ns <= stamp_ns]
        self._ticks = self._ticks[len(felt) :]
        return Felt(imu=_cut(joined, slice(None, split)), legs=LegBatch.of(felt))


def _cut(batch: ImuBatch, part: slice) -> ImuBatch:
    return ImuBatch(
        stamp_ns=batch.stamp_ns[part],
        angular_velocity_in_imu=batch.angular_velocity_in_imu[part],
        specific_force_in_imu=batch.specific_force_in_imu[part],
    )
