"""The body's pose over the walk plane: five posers one after the other (facts 3.11)."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from math import tan

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc import configuration
from robot_agent.locomotion.openshc.auto_pose import POSING_COMPLETE, AutoPosing
from robot_agent.locomotion.openshc.body_pose import (
    BodyPose,
    intrinsic_of,
    rotation_of_intrinsic,
    smooth_step,
    tilt_between_up_and,
)
from robot_agent.locomotion.openshc.step_path import StepPath
from weaver_shared.errors import ConfigurationError
from weaver_shared.transforms import rotation_from_rpy, rotation_x, rotation_y, rpy_from_rotation

Array = NDArray[np.float64]

RATE_SMOOTHING = 0.15


class PoseReset(IntEnum):
    NO_RESET, Z_AND_YAW, X_AND_Y, PITCH_AND_ROLL, ALL, IMMEDIATE_ALL = range(6)


RESET_AXES = {
    PoseReset.NO_RESET: (),
    PoseReset.Z_AND_YAW: (2, 5),
    PoseReset.X_AND_Y: (0, 1),
    PoseReset.PITCH_AND_ROLL: (3, 4),
    PoseReset.ALL: (0, 1, 2, 3, 4, 5),
}
"""Of x, y, z, roll, pitch, yaw."""


class Posing:
    """`pose` is the body's over the walk plane; `tip_in_body` what it makes of a foot."""

    def __init__(self, description: configuration.Configuration) -> None:
        if description.gravity_aligned_tips and description.joints_per_leg <= 3:
            raise ConfigurationError("gravity_aligned_tips is reproduced for legs of 4 joints and more")
        self._description = description
        self._level = BodyPose(np.array([0.0, 0.0, description.body_clearance]))
        self._walk_plane_before = self._level
        self.walk_plane = self._level
        self.pose = BodyPose()
        self.manual, self.inclination, self.imu = BodyPose(), BodyPose(), BodyPose()
        self.auto: AutoPosing | None = None
        self.input = np.zeros(6)  # -1..1 along x, y, z, roll, pitch, yaw
        self.reset = PoseReset.NO_RESET
        self.imu_rotation, self.imu_rate = np.eye(3), np.zeros(3)
        self._imu_sum, self._imu_slow_rate = np.zeros(3), np.zeros(3)

    @property
    def complete(self) -> bool:
        """Whether automatic posing lets the walk stop."""
        return self.auto is None or self.auto.state == POSING_COMPLETE

    def begin_gait(self, gait_name: str, step_frequency: float) -> None:
        if self._description.auto_posing:
            self.auto = AutoPosing(self._description, gait_name, step_frequency)

    def gravity(self) -> Array:
        """Direction of gravity in body by the IMU's tilt, (3,)."""
        roll, pitch, _ = rpy_from_rotation(self.imu_rotation)
        down: Array = rotation_x(-roll) @ rotation_y(-pitch) @ np.array([0.0, 0.0, -1.0])
        return down

    def update(self, walk_state: int, paths: Sequence[StepPath], gait: configuration.Gait, *, running: bool) -> None:
        """A tick, from what the walk was like after the last one."""
        description = self._description
        self._follow_walk_plane(paths, max(1.0, gait.swing_phase / gait.phase_offset) if gait.phase_offset else 1.0)
        self.pose = BodyPose().added(self.walk_plane)
        if description.manual_posing:
            self._move_by_hand()
            self.pose = self.pose.added(self.manual)
        if description.inclination_posing:
            self._lean()
            self.pose = self.pose.added(self.inclination)
        if description.imu_posing and running:
            self._level_by_imu()
            self.pose = self.pose.added(self.imu)
        elif self.auto is not None:
            reference = paths[self.auto.reference]
            stands = not reference.stride.any()
            states = [path.step_state for path in paths]
            self.auto.update(walk_state, stands, reference.phase, states, self.gravity())
            self.pose = self.pose.added(self.auto.pose)

    def of_leg(self, leg: int) -> BodyPose:
        """The pose with the automatic one replaced by the leg's own."""
        if self.auto is None:
            return self.pose
        return self.pose.removed(self.auto.pose).added(self.auto.leg_poses[leg])

    def _follow_walk_plane(self, paths: Sequence[StepPath], overlap: float) -> None:
        share, plane, normal = 0.0, np.zeros(3), np.array([0.0, 0.0, 1.0])
        for path in paths:
            progress = path.swing_progress * overlap
            if 0.0 <= progress <= 1.0:
                share, plane, normal = smooth_step(progress), path.plane, path.normal
        tilt = tilt_between_up_and(normal)
        position = tilt @ np.array([0.0, 0.0, self._description.body_clearance]) + np.array([0.0, 0.0, plane[2]])
        self.walk_plane = self._walk_plane_before.blended(share, BodyPose(position, tilt))
        if share == 1.0:
            self._walk_plane_before = self.walk_plane

    def _move_by_hand(self) -> None:
        """Input, integrated within its box; a reset drives at full speed back to zero."""
        if self.reset == PoseReset.IMMEDIATE_ALL:
            self.manual = BodyPose()
            return
        here = np.concatenate([self.manual.position, intrinsic_of(self.manual.rotation)])
        most, turn, dt = self._description.max_translation, self._description.max_rotation, self._description.time_delta
        box = np.array([most.x, most.y, most.z, turn.roll, turn.pitch, turn.yaw])
        speed = np.repeat([self._description.max_translation_velocity, self._description.max_rotation_velocity], 3)
        limit = np.where(self.input > 0.0, box, -box)
        for axis in RESET_AXES[self.reset]:
            if here[axis] != 0.0:
                self.input[axis] = -np.sign(here[axis])  # stays after the reset, as there
            limit[axis] = 0.0
        there = here + self.input * speed * dt
        beyond = np.where(self.input > 0.0, there > limit, there < limit)
        there = np.where(beyond, limit, there)
        self.manual = BodyPose(there[:3], rotation_of_intrinsic(*there[3:]))

    def _lean(self) -> None:
        """Centre of mass over the support polygon; without a filter (D14)."""
        posed = self.manual.rotation @ (np.eye(3) if self.auto is None else self.auto.pose.rotation)
        roll, pitch, _ = rpy_from_rotation(self.imu_rotation @ posed.T)
        height, most = self._description.body_clearance, self._description.max_translation
        x = np.clip(-height * tan(pitch), -most.x, most.x)
        y = np.clip(height * tan(roll), -most.y, most.y)
        self.inclination = BodyPose(np.array([x, y, 0.0]))

    def _level_by_imu(self) -> None:
        """PID on roll and pitch of what the manual pose does not explain."""
        gains, most = self._description.rotation_pid_gains, self._description.max_rotation
        error = rpy_from_rotation(self.imu_rotation @ self.manual.rotation.T)
        error[2] = 0.0
        self._imu_sum = self._imu_sum + error * self._description.time_delta
        self._imu_slow_rate = RATE_SMOOTHING * -self.imu_rate + (1.0 - RATE_SMOOTHING) * self._imu_slow_rate
        correction = -(gains.d * self._imu_slow_rate + gains.p * error + gains.i * self._imu_sum)
        roll = np.clip(correction[0], -most.roll, most.roll)
        pitch = np.clip(correction[1], -most.pitch, most.pitch)
        yaw = rpy_from_rotation(self.manual.rotation)[2]
        self.imu = BodyPose(np.zeros(3), rotation_from_rpy(roll, pitch, yaw))
