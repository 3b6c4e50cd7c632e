"""Keeps what a run must be judged by, tick by tick, and turns it into figures. Truth enters here and nowhere else."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.evaluation.energy import cost_of_transport
from robot_agent.evaluation.trajectory import Trajectory, evaluate, path_length
from sim_agent.lock_step import Moment
from sim_agent.worlds import World
from weaver_shared.messages import AdaptationReport

Array = NDArray[np.float64]


@dataclass(slots=True)
class RunLog:
    """Grows by one row a control tick; the digest covers all that was sensed, estimated and commanded."""

    world: World
    mass: float
    dt: float
    _digest: Any = field(default_factory=hashlib.sha256)
    _rows: list[tuple[float, ...]] = field(default_factory=list)
    _ordered: Array | None = None
    _tracking: list[Array] = field(default_factory=list)
    _estimated: list[tuple[float, ...]] = field(default_factory=list)

    def add(self, moment: Moment) -> None:
        sensed, walk = moment.sensed, moment.walk
        for array in (sensed.joint_position, sensed.joint_torque, walk.targets.position, walk.velocity_command):
            self._digest.update(np.ascontiguousarray(array).tobytes())
        if self._ordered is not None:
            self._tracking.append((sensed.joint_position - self._ordered) ** 2)
        self._ordered = walk.targets.position.copy() if walk.targets.torque_on else None
        if moment.vision is not None:
            odometry = moment.vision.odometry
            self._digest.update(odometry.position_in_world.tobytes())
            self._digest.update(odometry.wxyz.tobytes())
            self._estimated.append((odometry.stamp_ns * 1e-9, *odometry.position_in_world, *odometry.wxyz))
        if moment.truth is not None:
            self._rows.append(
                (
                    moment.truth.stamp_ns * 1e-9,
                    *moment.truth.position_in_world,
                    *moment.truth.wxyz,
                    sensed.battery_voltage * sensed.supply_current,
                    sensed.motor_power,
                    *_adapted(walk.report),
                )
            )

    @property
    def digest(self) -> str:
        return str(self._digest.hexdigest())

    def figures(self) -> dict[str, Any]:
        """Distance (m), duration (s), cost of transport, joints against orders, figures per segment and of odometry."""
        rows = np.array(self._rows)
        if rows.size == 0:
            return {}
        energy = self._energy(rows)
        tracking = np.array(self._tracking) if self._tracking else np.full((1, 1), np.nan)
        return {
            "distance": path_length(rows[:, 1:3]),
            "duration": float(rows[-1, 0] - rows[0, 0]),
            "cost_of_transport": {"total": energy.total, "motors": energy.motors},
            "joint_tracking_rms_deg": float(np.degrees(np.sqrt(np.mean(tracking)))),
            "joint_tracking_deg": np.degrees(np.sqrt(np.mean(tracking, axis=0))).tolist(),
            "segments": self._segments(rows),
            "odometry": self._odometry(rows),
        }

    def _segments(self, rows: Array) -> dict[str, dict[str, float]]:
        names = np.array([self.world.segment_at(float(x)) or "" for x in rows[:, 1]])
        result = {}
        for name in sorted(set(names) - {""}):
            part = rows[names == name]
            means = np.nanmean(part[:, 10:15], axis=0)
            keys = ("roughness", "step_height", "virtual_stiffness", "stride_frequency", "stride_height")
            result[str(name)] = dict(zip(keys, map(float, means), strict=True)) | {
                "cost_of_transport": self._energy(part).total
            }
        return result

    def _energy(self, rows: Array) -> Any:
        return cost_of_transport(
            supply_power=rows[:, 8],
            motor_power=rows[:, 9],
            dt=self.dt,
            distance=path_length(rows[:, 1:3]),
            mass=self.mass,
        )

    def _odometry(self, rows: Array) -> dict[str, float]:
        errors = evaluate(_trajectory(np.array(self._estimated)), _trajectory(rows[:, :8]))
        return {
            "drift_percent": errors.drift_percent,
            "final_error": errors.final_error,
            "ate_m": errors.ate_m,
        }


def _trajectory(rows: Array) -> Trajectory:
    """From rows of time (s), position (m) and wxyz."""
    stamps = np.rint(rows[:, 0] * 1e9).astype(np.int64)
    return Trajectory(stamp_ns=stamps, position=rows[:, 1:4], wxyz=rows[:, 4:8])


def _adapted(report: AdaptationReport) -> tuple[float, ...]:
    applied = report.applied
    return (
        report.roughness,
        report.step_height,
        applied.virtual_stiffness,
        applied.stride_frequency,
        applied.stride_height,
    )
