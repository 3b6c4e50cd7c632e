"""The body's state at control rate: inertia carried on from the newest odometry, without jumps.

Before odometry is there, and when it stays away, a complementary filter keeps the attitude level by the specific
force (Mahony et al., TAC 2008, with the accelerometer's say reduced while it feels more than gravity).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.imu_stream import usable
from robot_agent.odometry.propagation import propagate
from robot_agent.odometry.recent_samples import RecentSamples
from robot_agent.odometry.start import levelled
from weaver_shared.config.odometry import FailureConfig
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch, OdometryEstimate, OdometryQuality
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose, rotation_exp, rotation_log, skew

Array = NDArray[np.float64]

MEMORY = 1.0
"""s of inertia kept: the oldest correction that can still be carried to now."""

BLEND = 0.15
"""s, time constant with which a correction's jump is worked off."""

LEVEL_RATE = 0.5
"""1/s, how fast the specific force pulls the attitude level without odometry."""

COAST = 0.5
"""s without a correction after which velocity is no longer integrated but fades."""

LONGEST_SAMPLE = 0.1
"""s: a longer gap between samples is not integrated over."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NavigationState:
    """The body now."""

    stamp_ns: int
    world_from_body: Pose
    velocity_in_world: Array  # (3,) m/s
    angular_velocity_in_body: Array  # (3,) rad/s
    gravity_in_body: Array  # (3,) unit vector, pointing down
    age: float  # s since the picture of the newest correction; infinite before the first


class StatePropagator:
    """`propagate` inertia at control rate, `correct` whenever odometry arrives, however late."""

    def __init__(self, imu: Imu, initial: Pose) -> None:
        self._body_from_imu = imu.body_from_imu
        self._imu_from_body = imu.body_from_imu.inverse()
        self._rate_cross = -skew(self._imu_from_body.position)  # turns a rate into the speed of the body's origin
        self._failure = FailureConfig()
        self._recent = RecentSamples(round(MEMORY * imu.rate))
        self._world_from_imu = initial @ imu.body_from_imu
        self._velocity = np.zeros(3)  # of the IMU in world
        self._gyro_bias = np.zeros(3)
        self._accel_bias = np.zeros(3)
        self._rate = np.zeros(3)
        self._now: int | None = None
        self._corrected_ns: int | None = None
        self._levelled = False
        self._turn_left = np.zeros(3)  # rotation vector in world still to be worked off
        self._way_left = np.zeros(3)

    def correct(self, estimate: OdometryEstimate) -> None:
        """Take a pose of the past over: inertia since then is applied again, the jump is spread over time."""
        if estimate.quality in (OdometryQuality.INITIALISING, OdometryQuality.LOST):
            return
        if self._corrected_ns is not None and estimate.stamp_ns <= self._corrected_ns:
            return
        shown = self._shown()
        first = self._corrected_ns is None
        self._gyro_bias, self._accel_bias = estimate.gyro_bias, estimate.accel_bias
        world_from_imu = estimate.world_from_body @ self._body_from_imu
        rate_in_body = estimate.angular_velocity_in_body
        velocity = estimate.velocity_in_world + estimate.world_from_body.rotation @ np.cross(
            rate_in_body, self._body_from_imu.position
        )
        rotation, position, self._velocity = propagate(
            world_from_imu.rotation,
            world_from_imu.position,
            velocity,
            self._gyro_bias,
            self._accel_bias,
            self._recent.since(estimate.stamp_ns),
        )
        self._world_from_imu = Pose(rotation=rotation, position=position)
        self._corrected_ns = estimate.stamp_ns
        if first:
            self._turn_left, self._way_left = np.zeros(3), np.zeros(3)
        else:
            self._turn_left = rotation_log(shown.rotation @ rotation.T)
            self._way_left = shown.position - position

    def propagate(self, imu: ImuBatch) -> NavigationState:
        """Carry the state to the newest sample. Unusable samples are left out."""
        for stamp, gyro, accel, good in zip(
            imu.stamp_ns,
            imu.angular_velocity_in_imu,
            imu.specific_force_in_imu,
            usable(imu, self._failure),
            strict=True,
        ):
            self._take(int(stamp), gyro, accel, usable_sample=bool(good))
        return self._state()

    def _take(self, stamp: int, gyro: Array, accel: Array, *, usable_sample: bool) -> None:
        if self._now is None:
            self._now = stamp
            if usable_sample:
                self._level_at_once(accel)
            return
        if stamp <= self._now or not usable_sample:
            return
        dt = min((stamp - self._now) * 1e-9, LONGEST_SAMPLE)
        self._now = stamp
        sample = self._recent.add(stamp, dt, gyro, accel)
        self._rate = gyro - self._gyro_bias
        if not self._levelled:
            self._level_at_once(accel)
        if self._age() <= COAST:
            rotation, position, self._velocity = propagate(
                self._world_from_imu.rotation,
                self._world_from_imu.position,
                self._velocity,
                self._gyro_bias,
                self._accel_bias,
                sample,
            )
            self._world_from_imu = Pose(rotation=rotation, position=position)
        else:
            self._turn_level(dt, accel)
            self._velocity = self._velocity * math.exp(-dt / COAST)
            position = self._world_from_imu.position + self._velocity * dt
            self._world_from_imu = Pose(rotation=self._world_from_imu.rotation, position=position)
        fade = math.exp(-dt / BLEND)
        self._turn_left *= fade
        self._way_left *= fade

    def _level_at_once(self, accel: Array) -> None:
        norm = float(np.linalg.norm(accel))
        if norm < 0.5 * GRAVITY:
            return
        body = self._world_from_imu @ self._imu_from_body
        up_in_body = self._body_from_imu.rotation @ accel / norm
        body = Pose(rotation=levelled(body.rotation, up_in_body), position=body.position)
        self._world_from_imu = body @ self._body_from_imu
        self._levelled = True

    def _turn_level(self, dt: float, accel: Array) -> None:
        """Complementary filter: gyro for the fast part, specific force for the slow one."""
        rotation = self._world_from_imu.rotation @ rotation_exp(self._rate * dt)
        force = rotation @ (accel - self._accel_bias)
        norm = float(np.linalg.norm(force))
        excess = abs(norm - GRAVITY) / GRAVITY
        gain = LEVEL_RATE * dt * max(0.0, 1.0 - 4.0 * excess)
        if gain > 0.0:
            towards_up = np.array([force[1], -force[0], 0.0]) / norm  # cross product with the vertical
            rotation = rotation_exp(gain * towards_up) @ rotation
        self._world_from_imu = Pose(rotation=rotation, position=self._world_from_imu.position)

    def _age(self) -> float:
        if self._corrected_ns is None or self._now is None:
            return float("inf")
        return (self._now - self._corrected_ns) * 1e-9

    def _shown(self) -> Pose:
        """Pose of the IMU with the part of past jumps that is not worked off yet."""
        return Pose(
            rotation=rotation_exp(self._turn_left) @ self._world_from_imu.rotation,
            position=self._world_from_imu.position + self._way_left,
        )

    def _state(self) -> NavigationState:
        imu = self._shown()
        body = imu @ self._imu_from_body
        lever = imu.rotation @ (self._rate_cross @ self._rate)
        return NavigationState(
            stamp_ns=self._now if self._now is not None else 0,
            world_from_body=body,
            velocity_in_world=self._velocity + lever,
            angular_velocity_in_body=self._body_from_imu.rotation @ self._rate,
            gravity_in_body=-body.rotation[2],
            age=self._age(),
        )
