"""The last gate before the servos: joint targets are finite, within limits and within reach of the servo's speed."""

from __future__ import annotations

import numpy as np

from robot_agent.body import JointTargets
from weaver_shared.robots import RobotDescription


class JointGate:
    """Clamps positions to the joints' limits and their change to what the servo can follow in one tick."""

    def __init__(self, robot: RobotDescription) -> None:
        servos = [robot.servos[joint.servo] for joint in robot.joints]
        self._lower = np.tile(robot.joint_limits[:, 0], robot.leg_count)
        self._upper = np.tile(robot.joint_limits[:, 1], robot.leg_count)
        self._speed = np.tile([servo.no_load_speed for servo in servos], robot.leg_count)
        self._torque = np.tile([servo.stall_torque for servo in servos], robot.leg_count)
        self._last: np.ndarray | None = None

    def pass_on(self, targets: JointTargets, measured: np.ndarray, dt: float) -> JointTargets:
        """What may be written. A target that is not finite keeps its joint where it was last sent.

        With torque off the memory follows the measured joints, so that switching on never jumps.
        """
        last = measured if self._last is None or not targets.torque_on else self._last
        wanted = np.where(np.isfinite(targets.position), targets.position, last)
        step = self._speed * dt
        position = np.clip(np.clip(wanted, last - step, last + step), self._lower, self._upper)
        torque = np.where(np.isfinite(targets.torque_limit), targets.torque_limit, 0.0)
        self._last = position
        return JointTargets(
            stamp_ns=targets.stamp_ns,
            position=position,
            torque_limit=np.clip(torque, 0.0, self._torque),
            torque_on=targets.torque_on,
        )
