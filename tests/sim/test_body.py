"""A simulated body: same orders, same readings; a bus one tick late; weight on its feet."""

import hashlib

import numpy as np
import pytest

from robot_agent.body import Body, JointTargets
from sim_agent.body import SimulatedBody
from sim_agent.model import sitting_joints
from sim_agent.worlds import make_world
from weaver_shared.errors import ConfigurationError
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription


def order(robot: RobotDescription, position: np.ndarray) -> JointTargets:
    return JointTargets(stamp_ns=0, position=position, torque_limit=np.full(robot.joint_count, 9.0), torque_on=True)


def push_up(robot: RobotDescription, tick: int) -> np.ndarray:
    """Femurs downwards, tibiae along with them: the belly leaves the ground."""
    share = min(tick / 100.0, 1.0)
    return sitting_joints(robot) + share * np.tile([0.0, 0.0, 1.0, -0.2, -0.7], robot.leg_count)


def test_it_is_a_body(sitting: SimulatedBody) -> None:
    body: Body = sitting
    assert body.kind == "SIM"
    assert body.wait_next() == 10_000_000
    assert body.wait_next() == 20_000_000


def test_a_sitting_robot_without_torque_stays_where_it_is(sitting: SimulatedBody, robot: RobotDescription) -> None:
    start = sitting_joints(robot)
    for _ in range(300):
        sitting.wait_next()
    assert np.abs(sitting.read().joint_position - start).max() < 0.02
    assert np.abs(sitting.truth().position_in_world).max() < 2e-3


def test_forces_carry_the_weight_and_the_readings_know_it(sitting: SimulatedBody, robot: RobotDescription) -> None:
    for tick in range(250):
        sitting.wait_next()
        sitting.write(order(robot, push_up(robot, tick)))
    feet, rest = sitting.contact_forces()
    assert sitting.truth().position_in_world[2] > 0.05
    assert np.allclose(rest, 0.0)
    assert feet[:, 2].sum() == pytest.approx(robot.mass * GRAVITY, rel=0.01)
    sensed = sitting.read()
    assert sensed.foot_contact.all()
    assert sensed.motor_power > 27.0
    assert sensed.supply_current * sensed.battery_voltage == pytest.approx(
        (sensed.motor_power + robot.power.electronics_power) / robot.power.converter_efficiency
    )


def test_orders_reach_the_servos_one_tick_late(robot: RobotDescription) -> None:
    speeds = []
    for wait in (0, 1, 2):
        body = SimulatedBody(robot, make_world("flat", 1), 1)
        body.wait_next()
        body.write(order(robot, sitting_joints(robot) + 0.3 * np.tile([1, 0, 0, 0, 0], 6)))
        for _ in range(wait):
            body.wait_next()
        speeds.append(float(np.abs(body.read().joint_velocity[::5]).max()))
        body.close()
    assert speeds[0] == speeds[1] < 0.05
    assert speeds[2] > 0.2


def test_two_runs_are_the_same_to_the_last_bit_and_another_seed_is_not(robot: RobotDescription) -> None:
    def digest(seed: int) -> str:
        body = SimulatedBody(robot, make_world("testbed", 1), seed)
        found = hashlib.sha256()
        for tick in range(90):
            body.wait_next()
            sensed = body.read()
            for values in (
                sensed.joint_position,
                sensed.joint_velocity,
                sensed.joint_torque,
                sensed.foot_contact,
                sensed.imu.angular_velocity_in_imu,
                sensed.imu.specific_force_in_imu,
                np.array([sensed.battery_voltage, sensed.supply_current, sensed.motor_power]),
                body.truth().position_in_world,
            ):
                found.update(np.ascontiguousarray(values).tobytes())
            body.write(order(robot, push_up(robot, tick)))
        body.close()
        return found.hexdigest()

    assert digest(1) == digest(1)
    assert digest(1) != digest(2)


def test_cameras_expose_on_the_control_clock(sitting: SimulatedBody) -> None:
    due = []
    for _ in range(20):
        stamp = sitting.wait_next()
        if sitting.camera_due():
            due.append(stamp)
            assert sitting.scene_state().stamp_ns == stamp
    assert due == [80_000_000, 160_000_000]


def test_a_servo_answers_a_step_as_quickly_as_measured(sitting: SimulatedBody, robot: RobotDescription) -> None:
    start = sitting_joints(robot)
    step = np.tile([0.0, 0.0, 0.0, 0.0, -0.4], robot.leg_count)  # the tarsi, which lifts the feet
    travelled = []
    for _ in range(60):
        sitting.wait_next()
        sitting.write(order(robot, start + step))
        travelled.append(float(np.mean((sitting.read().joint_position - start)[4::5] / -0.4)))
    rise = 0.01 * float(np.argmax(np.array(travelled) > 0.63)) - 0.01  # the bus's tick is not the servo's
    assert 0.03 <= rise <= 0.07
    assert max(travelled) < 1.2
    assert travelled[-1] == pytest.approx(1.0, abs=0.06)


def test_a_rate_that_does_not_fit_is_refused(robot: RobotDescription) -> None:
    imu = robot.imu.model_copy(update={"rate": 150.0})
    with pytest.raises(ConfigurationError, match=r"imu.rate is 150 Hz.*divides 400 Hz"):
        SimulatedBody(robot.model_copy(update={"imu": imu}), make_world("flat", 1), 1)
