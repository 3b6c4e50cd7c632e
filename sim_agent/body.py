"""A simulated robot behind the same face as a real one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.body import JointTargets, Trouble
from sim_agent.model import sitting_joints
from sim_agent.physics import RATE, ContactSensor, Engine
from sim_agent.sensors import InertialSensor
from sim_agent.servos import Battery, ServoBank, encoder_position, encoder_velocity
from sim_agent.worlds import World
from weaver_shared.errors import ConfigurationError
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import Proprioception, SceneState, TruthState
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

CONTROL_RATE = 100.0
STEPS_PER_TICK = round(RATE / CONTROL_RATE)
TICK_NS = round(1e9 / CONTROL_RATE)
STEP_NS = TICK_NS // STEPS_PER_TICK


class SimulatedBody:
    """Servos, IMU and power of a robot in a world; a `robot_agent.body.Body`.

    The clock starts at 0 and moves by one control tick per `wait_next`. The robot begins sitting with torque off.
    With `held_at` its trunk hangs on a stand, so many metres above the ground, and does not move.
    Everything random comes from `seed`; two bodies given the same orders read the same, bit for bit.
    """

    kind = "SIM"

    def __init__(self, robot: RobotDescription, world: World, seed: int, *, held_at: float | None = None) -> None:
        self.robot = robot
        self.world = world
        self._stamp_ns = 0
        start = sitting_joints(robot)
        self._engine = Engine(robot, world, start, held_at=held_at)
        self._servos = ServoBank(robot, 1.0 / RATE)
        self._battery = Battery(robot.power)
        self._contacts = ContactSensor(robot.leg_count, robot.mass * GRAVITY)
        self._imu = InertialSensor(robot.imu, np.random.default_rng([seed, 10]))
        self._imu_in_body = np.asarray(robot.imu.position_in_body)
        self._steps_per_sample = _divide(RATE, robot.imu.rate, "imu.rate")
        self._camera_period_ns = 0
        if robot.has_camera:
            self._camera_period_ns = TICK_NS * _divide(CONTROL_RATE, robot.camera.rate, "camera.rate")
        self._position = start.copy()
        self._velocity = np.zeros(robot.joint_count)
        self._torque = np.zeros(robot.joint_count)
        self._foot_contact = np.zeros(robot.leg_count, dtype=np.bool_)
        self._motor_power = 0.0
        self._ordered: JointTargets | None = None
        self._imu.begin(*self._imu_state())

    def wait_next(self) -> int:
        """Advance physics by one tick of 10 ms under the orders of the tick before and return the new stamp."""
        # An order written during a tick is on the bus when the next one begins: servos act on it one tick later.
        if self._ordered is not None:
            order, self._ordered = self._ordered, None
        else:
            order = None
        for step in range(1, STEPS_PER_TICK + 1):
            self._servos.torque(self._position, self._velocity, self._torque)
            self._engine.apply(self._torque)
            self._engine.step()
            self._engine.joints(self._position, self._velocity)
            if step % self._steps_per_sample == 0:
                self._imu.sample(self._stamp_ns + step * STEP_NS, *self._imu_state())
        self._stamp_ns += TICK_NS
        self._motor_power = self._servos.end_of_tick()
        self._battery.draw(self._motor_power, 1.0 / CONTROL_RATE)
        self._foot_contact = self._contacts.step(np.linalg.norm(self._engine.foot_forces(), axis=1))
        if order is not None:
            self._servos.command(order)
        return self._stamp_ns

    def read(self) -> Proprioception:
        return Proprioception(
            stamp_ns=self._stamp_ns,
            joint_position=encoder_position(self._position),
            joint_velocity=encoder_velocity(self._velocity),
            joint_torque=self._servos.present_torque(),
            joint_valid=np.ones(self.robot.joint_count, dtype=np.bool_),
            joint_temperature=self._servos.present_temperature(),
            foot_contact=self._foot_contact,
            imu=self._imu.take(),
            battery_voltage=self._battery.voltage,
            supply_current=self._battery.current,
            motor_power=self._motor_power,
        )

    def write(self, targets: JointTargets) -> None:
        self._ordered = targets

    def findings(self) -> tuple[Trouble, ...]:
        """A simulated robot has no troubles of its own."""
        return ()

    def joint_faults(self) -> tuple[str, ...]:
        """A simulated servo tells nothing of faults."""
        return ()

    @property
    def holding(self) -> bool:
        return False

    def truth(self) -> TruthState:
        """Where the body really is: for evaluation and display, never for the robot."""
        pose = self._engine.world_from_body()
        velocity, _ = self._engine.velocity_of(np.zeros(3), pose.rotation)
        return TruthState(
            stamp_ns=self._stamp_ns,
            position_in_world=pose.position,
            wxyz=pose.wxyz,
            velocity_in_world=velocity,
        )

    def camera_due(self) -> bool:
        """Whether the cameras expose at this tick; they run on the control clock."""
        return self._camera_period_ns > 0 and self._stamp_ns % self._camera_period_ns == 0

    def scene_state(self) -> SceneState:
        pose = self._engine.world_from_body()
        return SceneState(
            stamp_ns=self._stamp_ns,
            position_in_world=pose.position,
            wxyz=pose.wxyz,
            joint_position=self._position.copy(),
        )

    def contact_forces(self) -> tuple[Array, Array]:
        """True ground reaction on the feet (legs, 3) and on all else (3,), in world, N: for evaluation."""
        return self._engine.contact_forces()

    def push(self, force_in_world: Array) -> None:
        """Disturb the trunk with a force (3,) in N during the next physics step (2.5 ms)."""
        self._engine.push(force_in_world)

    def close(self) -> None:
        self._engine.close()

    def _imu_state(self) -> tuple[Array, Array]:
        pose: Pose = self._engine.world_from_body()
        velocity, _ = self._engine.velocity_of(self._imu_in_body, pose.rotation)
        return pose.rotation, velocity


def _divide(rate: float, slower: float, name: str) -> int:
    ratio = rate / slower
    if ratio < 1.0 or abs(ratio - round(ratio)) > 1e-9:
        raise ConfigurationError(f"{name} is {slower:g} Hz, but the simulator needs a rate that divides {rate:g} Hz")
    return round(ratio)
