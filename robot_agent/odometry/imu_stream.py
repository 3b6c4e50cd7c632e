"""Inertial samples in order and without nonsense, cut at the pictures' instants."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.odometry import FailureConfig
from weaver_shared.messages import ImuBatch

Array = NDArray[np.float64]


SKIPPED = 1.5
"""Times the usual step from sample to sample, from which on one between them is missing."""

PERIOD_BLEND = 0.1
"""Share of each new step in the usual one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Inertia:
    """What happened between two pictures."""

    samples: Array  # (n, 7) duration (s), angular velocity (rad/s), specific force (m/s^2), all in imu
    rate: Array  # (3,) angular velocity in imu at the end, bias included
    problem: str  # what is wrong with the samples; empty if nothing
    trusted: bool  # False: so much is missing that the samples are a guess
    gap: float = 0.0  # s, the longest stretch without a sample
    unmeasured: bool = False  # a blow was harder than the sensor can measure, or a sample or a few are missing


def usable(batch: ImuBatch, config: FailureConfig) -> NDArray[np.bool_]:
    """Which samples are finite and within the sensor's range, (n,)."""
    gyro, accel = batch.angular_velocity_in_imu, batch.specific_force_in_imu
    with np.errstate(invalid="ignore"):
        sane = (np.abs(gyro) < config.greatest_gyro).all(axis=1) & (np.abs(accel) < config.greatest_accel).all(axis=1)
    return np.asarray(sane)


class ImuStream:
    """Samples wait here until a picture asks for all of them up to its instant."""

    def __init__(self, config: FailureConfig) -> None:
        self._config = config
        self._rows = np.zeros((0, 6))
        self._stamps = np.zeros(0, dtype=np.int64)
        self._last = np.array([0.0, 0.0, 0.0, np.nan, np.nan, np.nan])
        self._cursor: int | None = None
        self._bad = 0
        self._unmeasured = False
        self._period: float | None = None  # s, usual step from sample to sample

    def add(self, batch: ImuBatch) -> None:
        """Take samples in; the unusable and the out of order are left out and counted."""
        rows = np.column_stack([batch.angular_velocity_in_imu, batch.specific_force_in_imu])
        good = usable(batch, self._config)
        self._unmeasured |= bool(np.isfinite(rows[~good]).all(axis=1).any())
        newest = self._stamps[-1] if len(self._stamps) else (self._cursor if self._cursor is not None else -(2**62))
        past = np.maximum.accumulate(np.concatenate([[newest], batch.stamp_ns]))[:-1]
        good &= batch.stamp_ns > past
        self._bad += int((~good).sum())
        if newest >= 0:
            self._watch_steps(np.diff(np.concatenate([[newest], batch.stamp_ns[good]])) * 1e-9)
        self._rows = np.concatenate([self._rows, rows[good]])
        self._stamps = np.concatenate([self._stamps, batch.stamp_ns[good]])

    def take_until(self, stamp_ns: int) -> Inertia:
        """Everything since the last call up to `stamp_ns`; a sample reaching beyond is split."""
        begin = self._cursor
        self._cursor = stamp_ns
        first_after = int(np.searchsorted(self._stamps, stamp_ns, side="left"))
        taken = self._rows[: first_after + 1]
        ends = np.minimum(self._stamps[: first_after + 1], stamp_ns)
        split = first_after < len(self._stamps) and self._stamps[first_after] > stamp_ns
        bad, self._bad = self._bad, 0
        unmeasured, self._unmeasured = self._unmeasured, False
        keep_from = first_after if split else first_after + 1
        self._rows, self._stamps = self._rows[keep_from:], self._stamps[keep_from:]
        missing = begin is not None and len(ends) == 0
        if begin is None:
            begin = int(ends[0]) if len(ends) else stamp_ns
        if len(taken):
            self._last = taken[-1]
        if len(ends) == 0 or ends[-1] < stamp_ns:  # the newest sample holds until the picture
            taken, ends = np.vstack([taken, self._last]), np.append(ends, stamp_ns)
        durations = np.diff(np.concatenate([[begin], ends])) * 1e-9
        known = np.isfinite(taken).all(axis=1)
        samples = np.column_stack([durations, taken])[known & (durations > 0.0)]
        gap = float(durations.max(initial=0.0))
        problem = ""
        if gap > self._config.imu_gap or missing:
            problem = f"no inertial samples for {gap:.2f} s"
        elif bad:
            problem = f"{bad} inertial samples unusable"
        return Inertia(
            samples=samples,
            rate=np.array(self._last[:3]),
            problem=problem,
            trusted=gap <= self._config.imu_gap and not missing and bool(known.any()),
            gap=gap,
            unmeasured=unmeasured,
        )

    def _watch_steps(self, steps: Array) -> None:
        """What a lost sample has hidden is unknown: a foot that struck then is half a metre per second."""
        if not steps.size:
            return
        usual = float(np.median(steps))
        if self._period is None:
            self._period = usual
        self._unmeasured |= bool(((steps > SKIPPED * self._period) & (steps <= self._config.imu_gap)).any())
        self._period += PERIOD_BLEND * (min(usual, 2.0 * self._period) - self._period)
