"""Measures what safety judges: how old each sense is and how the body is doing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robot_agent.battery_gauge import BatteryGauge
from robot_agent.body import Trouble
from robot_agent.odometry import NavigationState
from robot_agent.orders import Orders
from robot_agent.safety import SafetyInputs
from weaver_shared.messages import OdometryEstimate, OdometryQuality, Proprioception


class Vigilance:
    """Keeps the stamps of the last signs of life, on the robot's clock."""

    def __init__(self) -> None:
        self._imu_ns: int | None = None
        self._odometry: OdometryEstimate | None = None
        self._odometry_arrived_ns: int | None = None
        self._now_ns = 0
        self._missing_since_ns: np.ndarray | None = None
        self._power_ns: int | None = None
        self._battery = BatteryGauge()

    def odometry_arrived(self, estimate: OdometryEstimate) -> None:
        self._odometry = estimate
        self._odometry_arrived_ns = self._now_ns

    @property
    def odometry(self) -> OdometryEstimate | None:
        return self._odometry

    def odometry_age(self) -> float:
        """Seconds since an estimate arrived; infinite before the first."""
        if self._odometry_arrived_ns is None:
            return float("inf")
        return (self._now_ns - self._odometry_arrived_ns) * 1e-9

    def inspect(
        self,
        sensed: Proprioception,
        state: NavigationState,
        orders: Orders,
        *,
        upright: bool,
        troubles: Sequence[Trouble] = (),
    ) -> SafetyInputs:
        now = self._now_ns = sensed.stamp_ns
        if np.isfinite(sensed.battery_voltage) or self._power_ns is None:
            self._power_ns = now
        if sensed.imu.stamp_ns.size or self._imu_ns is None:
            self._imu_ns = now
        if self._missing_since_ns is None:
            self._missing_since_ns = np.full(sensed.joint_valid.size, now)
        self._missing_since_ns[sensed.joint_valid] = now
        lost = self._odometry is not None and self._odometry.quality is OdometryQuality.LOST
        return SafetyInputs(
            stop_level=orders.stop_level,
            upright=upright,
            needs_odometry=orders.mission_active,
            operator_silence=orders.operator_silence,
            attended=orders.attended,
            tilt=float(np.arccos(np.clip(-state.gravity_in_body[2], -1.0, 1.0))),
            imu_age=(now - self._imu_ns) * 1e-9,
            odometry_age=self.odometry_age(),
            odometry_lost=lost,
            joints_missing=float(now - self._missing_since_ns.min()) * 1e-9,
            power_age=(now - self._power_ns) * 1e-9,
            temperature=float(np.max(sensed.joint_temperature)),
            battery_voltage=self._battery.step(sensed.battery_voltage, sensed.supply_current, now),
            troubles=tuple(troubles),
        )
