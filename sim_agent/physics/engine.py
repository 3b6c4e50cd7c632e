"""PyBullet with every parameter stated: one robot in one world, stepped by joint torques."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sim_agent.model import leg_links, robot_urdf
from sim_agent.physics.ground import load_ground
from sim_agent.physics.quiet import quiet
from sim_agent.worlds import World
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose, rotation_z

with quiet():
    import pybullet

Array = NDArray[np.float64]

RATE = 400.0
"""Physics steps per second: the slowest at which feet touch down without spikes beyond twice the weight."""

FOOT_FRICTION = 1.0
TRUNK_FRICTION = 0.4
START_GAP = 0.001  # m between belly and ground at start

ARMATURE_SHARE = (1.0, 0.5, 0.3)
"""Rotor inertia given to the first, second and third of parallel joints in a row.

PyBullet has no rotor inertia; it is added to the links. What a link carries is felt by its parents' parallel joints
too, so the full value everywhere would count it up to three times. With these shares the femur's step response is
within 8 ms of a simulation with true rotors.
"""

_PARAMETERS: dict[str, float] = {
    # numSubSteps and others survive resetSimulation and have no documented defaults, so all are set.
    "fixedTimeStep": 1.0 / RATE,
    "numSubSteps": 0,
    "numSolverIterations": 50,
    "solverResidualThreshold": 1e-7,
    "erp": 0.2,
    "contactERP": 0.2,
    "frictionERP": 0.2,
    "globalCFM": 0.0,
    "enableConeFriction": 1,
    "restitutionVelocityThreshold": 0.2,
    "contactBreakingThreshold": 0.02,
    "useSplitImpulse": 0,
    "collisionFilterMode": 1,
    "enableFileCaching": 0,
    "deterministicOverlappingPairs": 1,
}


class Engine:
    """The rigid bodies. Joint order is `RobotDescription.joint_names`; base poses are of the body frame.

    With `held_at` (m, of the body frame over the ground) the trunk is fixed there.
    """

    def __init__(
        self, robot: RobotDescription, world: World, joint_position: Array, *, held_at: float | None = None
    ) -> None:
        self._robot = robot
        self._client = pybullet.connect(pybullet.DIRECT)
        pybullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=self._client)
        pybullet.setPhysicsEngineParameter(physicsClientId=self._client, **_PARAMETERS)
        with quiet():
            load_ground(world, self._client)
            self._body = self._load_robot(world, held_at)
        self._joints = self._joint_indices()
        self._centre_in_body = np.asarray(robot.body.centre_of_mass_in_body)
        self._add_armature()
        self._set_dynamics()
        for index, position in zip(self._joints, joint_position, strict=True):
            pybullet.resetJointState(self._body, index, float(position), 0.0, physicsClientId=self._client)
        self._release_default_motors()

    @property
    def foot_links(self) -> tuple[int, ...]:
        last = self._robot.joints_per_leg - 1
        return tuple(self._joints[leg * self._robot.joints_per_leg + last] for leg in range(self._robot.leg_count))

    def apply(self, torque: Array) -> None:
        """Joint torques (joints,) in N m for the next step."""
        pybullet.setJointMotorControlArray(
            self._body,
            self._joints,
            pybullet.TORQUE_CONTROL,
            forces=torque.tolist(),
            physicsClientId=self._client,
        )

    def step(self) -> None:
        pybullet.stepSimulation(physicsClientId=self._client)

    def joints(self, position: Array, velocity: Array) -> None:
        """Fill positions (joints,) in rad and velocities in rad/s."""
        states = pybullet.getJointStates(self._body, self._joints, physicsClientId=self._client)
        position[:] = [state[0] for state in states]
        velocity[:] = [state[1] for state in states]

    def world_from_body(self) -> Pose:
        centre, xyzw = pybullet.getBasePositionAndOrientation(self._body, physicsClientId=self._client)
        rotation = np.array(pybullet.getMatrixFromQuaternion(xyzw)).reshape(3, 3)
        return Pose(rotation=rotation, position=np.array(centre) - rotation @ self._centre_in_body)

    def velocity_of(self, point_in_body: Array, rotation: Array) -> tuple[Array, Array]:
        """Linear (3,) m/s and angular (3,) rad/s velocity in world of a point of the trunk."""
        linear, angular = pybullet.getBaseVelocity(self._body, physicsClientId=self._client)
        wx, wy, wz = angular
        x, y, z = rotation @ (point_in_body - self._centre_in_body)
        velocity = np.array([linear[0] + wy * z - wz * y, linear[1] + wz * x - wx * z, linear[2] + wx * y - wy * x])
        return velocity, np.array(angular)

    def foot_forces(self) -> Array:
        """Ground reaction on every leg's last link in world, (legs, 3) N, of the last step."""
        forces, _ = self.contact_forces()
        return forces

    def contact_forces(self) -> tuple[Array, Array]:
        """Ground reaction on every leg's last link (legs, 3), and on all other parts together (3,), in world, N."""
        feet = {link: leg for leg, link in enumerate(self.foot_links)}
        forces = np.zeros((self._robot.leg_count, 3))
        rest = np.zeros(3)
        for contact in pybullet.getContactPoints(bodyA=self._body, physicsClientId=self._client):
            normal, first, second = contact[7], contact[11], contact[13]
            f, g, h = contact[9], contact[10], contact[12]
            leg = feet.get(contact[3])
            target = rest if leg is None else forces[leg]
            for axis in range(3):
                target[axis] += f * normal[axis] + g * first[axis] + h * second[axis]
        return forces, rest

    def push(self, force_in_world: Array) -> None:
        """Push the trunk's centre of mass with a force (N) for the next step."""
        centre, _ = pybullet.getBasePositionAndOrientation(self._body, physicsClientId=self._client)
        pybullet.applyExternalForce(
            self._body, -1, list(force_in_world), centre, pybullet.WORLD_FRAME, physicsClientId=self._client
        )

    def close(self) -> None:
        if pybullet.isConnected(self._client):
            pybullet.disconnect(self._client)

    def _load_robot(self, world: World, held_at: float | None) -> int:
        x, y, yaw = world.start
        rotation = rotation_z(yaw)
        box = np.asarray(self._robot.body.size)[:2] / 2
        corners = np.array([[sx, sy] for sx in (-1, 0, 1) for sy in (-1, 0, 1)]) * box @ rotation[:2, :2].T
        ground = float(world.elevation(x + corners[:, 0], y + corners[:, 1]).max())
        height = ground + (held_at or self._robot.sitting_gap - self._robot.belly + START_GAP)
        pose = Pose(rotation=rotation, position=np.array([x, y, height]))
        wxyz = pose.wxyz
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "robot.urdf"
            path.write_text(robot_urdf(self._robot))
            # basePosition is where the URDF's root link frame goes, which is the body frame.
            return int(
                pybullet.loadURDF(
                    str(path),
                    basePosition=pose.position.tolist(),
                    baseOrientation=[wxyz[1], wxyz[2], wxyz[3], wxyz[0]],
                    useFixedBase=held_at is not None,
                    flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
                    physicsClientId=self._client,
                )
            )

    def _joint_indices(self) -> list[int]:
        count = pybullet.getNumJoints(self._body, physicsClientId=self._client)
        found = {
            pybullet.getJointInfo(self._body, index, physicsClientId=self._client)[1].decode(): index
            for index in range(count)
        }
        return [found[name] for name in self._robot.joint_names]

    def _add_armature(self) -> None:
        """Rotor inertia about each joint's axis; the URDF reader would refuse it as no solid body has such moments."""
        parallel = 0
        shares = []
        for joint in self._robot.joints:
            shares.append(ARMATURE_SHARE[min(parallel, len(ARMATURE_SHARE) - 1)])
            parallel = parallel + 1 if joint.alpha == 0.0 else 0
        links = leg_links(self._robot)
        for number, index in enumerate(self._joints):
            which = number % self._robot.joints_per_leg
            moments = links[which].inertia.copy()
            moments[2] += shares[which] * self._robot.servos[self._robot.joints[which].servo].armature
            pybullet.changeDynamics(
                self._body, index, localInertiaDiagonal=moments.tolist(), physicsClientId=self._client
            )

    def _set_dynamics(self) -> None:
        """Friction of what touches; none of Bullet's own damping, since the servos' friction is modelled."""
        for index in (-1, *self._joints):
            # NOTE: friction needs a call of its own: beside damping or joint settings it goes to the trunk instead.
            pybullet.changeDynamics(
                self._body,
                index,
                lateralFriction=TRUNK_FRICTION if index == -1 else FOOT_FRICTION,
                spinningFriction=0.0,
                rollingFriction=0.0,
                restitution=0.0,
                physicsClientId=self._client,
            )
            pybullet.changeDynamics(
                self._body,
                index,
                linearDamping=0.0,
                angularDamping=0.0,
                jointDamping=0.0,
                maxJointVelocity=100.0,
                activationState=pybullet.ACTIVATION_STATE_DISABLE_SLEEPING,
                physicsClientId=self._client,
            )

    def _release_default_motors(self) -> None:
        """Loading gives every joint a velocity motor; without force it is gone."""
        pybullet.setJointMotorControlArray(
            self._body,
            self._joints,
            pybullet.VELOCITY_CONTROL,
            forces=[0.0] * len(self._joints),
            physicsClientId=self._client,
        )
