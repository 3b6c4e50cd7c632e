"""A robot description as the plain arrays the kernels work on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.chain import with_turns
from robot_agent.kinematics.inverse import ITERATIVE, YAW_PITCH, YAW_ROLL_PITCH
from robot_agent.kinematics.yaw_pitch import is_yaw_pitch
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

DUTY_PER_RADIAN = 0.158
"""PWM duty of an MX servo per rad of position error and unit of firmware P (identified by Rhoban's `bam`)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LegModel:
    """All legs share one chain of n joints; they differ in where it starts."""

    dh: Array  # (n, 6) theta, d, r, alpha, cos alpha, sin alpha
    limits: Array  # (n, 2) rad
    hips: Array  # (legs, 3) in body, m
    hip_axes: Array  # (legs, 3, 3) in body, columns are the axes a chain begins with
    link_mass: Array  # (n,) kg
    speed_limit: Array  # (n,) rad/s
    servo_stiffness: Array  # (n,) N m/rad of the position loop
    servo_lag: Array  # (n,) s, back-EMF damping over stiffness
    standing: Array  # (n,) rad, where the search for a standing posture begins
    closed_form: int  # which one the chain has, see `inverse`

    @property
    def leg_count(self) -> int:
        return int(self.hips.shape[0])

    @property
    def joints_per_leg(self) -> int:
        return int(self.dh.shape[0])

    @property
    def reach(self) -> float:
        """Length of the stretched chain, m."""
        return float(np.abs(self.dh[:, 1:3]).sum())

    def limits_less(self, margin: float) -> Array:
        """Limits (n, 2) drawn in by `margin` rad, but by no more than a quarter of what a joint can move."""
        taken = np.minimum(margin, 0.25 * (self.limits[:, 1] - self.limits[:, 0]))
        drawn: Array = self.limits + np.outer(taken, [1.0, -1.0])
        return drawn

    @staticmethod
    def of_robot(robot: RobotDescription, *, speed_fraction: float = 0.9) -> LegModel:
        """Arrays of a robot; joints may turn at `speed_fraction` of their servo's no-load speed."""
        servos = [robot.servos[joint.servo] for joint in robot.joints]
        stiffness = [
            s.position_gain * DUTY_PER_RADIAN * s.supply_voltage * s.torque_constant / s.resistance for s in servos
        ]
        damping = [s.torque_constant**2 / s.resistance + s.viscous_friction for s in servos]
        return LegModel(
            dh=with_turns(robot.dh),
            limits=robot.walking_limits,
            hips=robot.hips_in_body,
            hip_axes=robot.hip_axes,
            link_mass=np.array([joint.mass for joint in robot.joints]),
            speed_limit=np.array([speed_fraction * s.no_load_speed for s in servos]),
            servo_stiffness=np.array(stiffness),
            servo_lag=np.array(damping) / np.array(stiffness),
            standing=robot.standing_search[0].copy(),
            closed_form=_closed_form(robot),
        )


def _closed_form(robot: RobotDescription) -> int:
    if is_yaw_roll_pitch(robot.dh) and not any(leg.hip_roll or leg.mirrored for leg in robot.legs):
        return YAW_ROLL_PITCH
    return YAW_PITCH if is_yaw_pitch(robot.dh) else ITERATIVE


def is_yaw_roll_pitch(dh: Array) -> bool:
    """Whether a chain is Weaver's: yaw, roll about the outward axis, then three parallel pitch joints."""
    if dh.shape != (5, 4):
        return False
    quarter = 0.5 * np.pi
    shape = np.array(
        [
            [quarter, 0.0, 0.0, quarter],
            [quarter, dh[1, 1], 0.0, quarter],
            [quarter, 0.0, dh[2, 2], 0.0],
            [0.0, 0.0, dh[3, 2], 0.0],
            [0.0, 0.0, dh[4, 2], 0.0],
        ]
    )
    return bool(np.allclose(dh, shape, atol=1e-9))
