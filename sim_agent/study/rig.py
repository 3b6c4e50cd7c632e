"""A simulated robot with its walker and nothing else, on the ground or held on a stand in the air."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.body import JointTargets
from robot_agent.limits import JointGate
from robot_agent.locomotion import Walker, WalkInput, WalkOutput
from robot_agent.odometry import StatePropagator
from robot_agent.pipeline import initial_pose
from sim_agent.body import CONTROL_RATE, SimulatedBody
from sim_agent.study.speeds import flat_ground
from sim_agent.worlds import World
from weaver_shared.messages import Proprioception
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

DT = 1.0 / CONTROL_RATE
STILL = np.zeros(3)
SETTLING = 0.5
"""s for which the robot lies before it is switched on, so that its first reading of gravity is one at rest."""


class Rig:
    """Lock step at 100 Hz; told a velocity, the robot walks by its own senses. `held_at`: m, height of a stand.

    `truth` is for judging, `out` what the walker said at the last tick.
    """

    def __init__(self, robot: RobotDescription, world: World, seed: int = 1, *, held_at: float | None = None) -> None:
        self.robot = robot
        self.world = world
        self.body = SimulatedBody(robot, world, seed, held_at=held_at)
        self.walker = Walker(robot, dt=DT)
        self.parameters = flat_ground(robot)
        self.seconds = 0.0
        self._gate = JointGate(robot)
        self._torque_limit = np.tile([robot.servos[j.servo].stall_torque for j in robot.joints], robot.leg_count)
        self.torque_share = 0.0  # largest torque so far over what the servo has
        for _ in range(round(SETTLING / DT)):
            self.body.wait_next()
            sensed = self.body.read()
        self._propagator = StatePropagator(robot.imu, initial_pose(robot, sensed.joint_position))
        self.walker.reset(sensed.joint_position)
        self.out: WalkOutput
        self.sensed = sensed
        self.step(gait=robot.gaits[0], stand=False)

    def step(self, *, gait: str, velocity: Array = STILL, stand: bool = True) -> Proprioception:
        """One tick under these orders; returns what was sensed."""
        stamp_ns = self.body.wait_next()
        self.sensed = sensed = self.body.read()
        state = self._propagator.propagate(sensed.imu)
        self.out = self.walker.step(
            WalkInput(
                stamp_ns=stamp_ns,
                velocity=velocity,
                parameters=self.parameters,
                gait=gait,
                stand=stand,
                joint_position=sensed.joint_position,
                joint_torque=sensed.joint_torque,
                foot_contact=sensed.foot_contact,
                gravity_in_body=state.gravity_in_body,
            )
        )
        targets = JointTargets(
            stamp_ns=stamp_ns,
            position=self.out.joint_position,
            torque_limit=self._torque_limit,
            torque_on=True,
        )
        self.body.write(self._gate.pass_on(targets, sensed.joint_position, DT))
        self.torque_share = max(self.torque_share, float(np.abs(sensed.joint_torque / self._torque_limit).max()))
        self.seconds += DT
        return sensed

    def truth(self) -> Pose:
        """Where the body really is."""
        return self.body.scene_state().world_from_body

    def tilt(self) -> float:
        """Angle between the body's z axis and the vertical, rad, by truth."""
        return float(np.arccos(np.clip(self.truth().rotation[2, 2], -1.0, 1.0)))

    def close(self) -> None:
        self.body.close()
