"""Servos behave like their data sheets and draw the power they should."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.body import JointTargets
from sim_agent.servos import Battery, ServoBank, encoder_position
from weaver_shared.robots import RobotDescription

DT = 1.0 / 400.0
FEMUR = 2  # an MX-106


def bank_with(robot: RobotDescription, goal: float, *, limit: float = 100.0, torque_on: bool = True) -> ServoBank:
    bank = ServoBank(robot, DT)
    count = robot.joint_count
    bank.command(
        JointTargets(stamp_ns=0, position=np.full(count, goal), torque_limit=np.full(count, limit), torque_on=torque_on)
    )
    return bank


def torque_at(bank: ServoBank, position: float, speed: float) -> float:
    torque = np.zeros(30)
    bank.torque(np.full(30, position), np.full(30, speed), torque)
    return float(torque[FEMUR])


def test_a_blocked_servo_gives_its_stall_torque(robot: RobotDescription) -> None:
    assert torque_at(bank_with(robot, 1.0), 0.0, 0.0) == pytest.approx(robot.servos["mx106"].stall_torque)


def test_an_order_caps_the_torque(robot: RobotDescription) -> None:
    assert torque_at(bank_with(robot, 1.0, limit=2.0), 0.0, 0.0) == pytest.approx(2.0)


def test_near_its_goal_a_servo_is_a_spring_of_the_identified_stiffness(robot: RobotDescription) -> None:
    servo = robot.servos["mx106"]
    stiffness = 0.158 * servo.position_gain * servo.supply_voltage * servo.torque_constant / servo.resistance
    error = 20 * 2.0 * np.pi / 4096
    assert torque_at(bank_with(robot, error), 0.0, 0.0) == pytest.approx(stiffness * error, rel=1e-9)


def test_an_unloaded_servo_runs_no_faster_than_back_emf_allows(robot: RobotDescription) -> None:
    servo = robot.servos["mx106"]
    bank, speed, torque = bank_with(robot, 1.3), 0.0, np.zeros(30)
    for _ in range(2000):
        bank.torque(np.zeros(30), np.full(30, speed), torque)
        speed += float(torque[FEMUR]) / servo.armature * DT
    # The free speed by the identified constants, less what friction takes.
    free = 0.9625 * servo.supply_voltage / servo.torque_constant
    lost = (servo.coulomb_friction + servo.viscous_friction * speed) * servo.resistance / servo.torque_constant**2
    assert speed == pytest.approx(free - lost, rel=0.01)


def test_without_torque_friction_holds_what_is_below_it_and_lets_go_above(robot: RobotDescription) -> None:
    servo = robot.servos["mx106"]

    def drift_in_the_second_second(load: float) -> float:
        bank, angle, speed, torque = bank_with(robot, 0.0, torque_on=False), 0.0, 0.0, np.zeros(30)
        settled = 0.0
        for step in range(800):
            settled = angle if step == 400 else settled
            bank.torque(np.full(30, angle), np.full(30, speed), torque)
            speed += (float(torque[FEMUR]) + load * min(step / 200, 1.0)) / servo.armature * DT
            angle += speed * DT
        return angle - settled

    assert abs(drift_in_the_second_second(0.8 * servo.coulomb_friction)) < 0.002
    assert drift_in_the_second_second(2.0 * servo.coulomb_friction) > 0.3


@given(st.floats(-1.2, 1.3), st.floats(-0.5, 0.5), st.floats(-8.0, 8.0))
def test_nothing_is_recuperated_and_nothing_is_free(goal: float, position: float, speed: float) -> None:
    from weaver_shared.robots import load_robot

    robot = load_robot()
    bank = bank_with(robot, goal)
    torque_at(bank, position, speed)
    assert bank.end_of_tick() >= 30 * robot.servos["mx106"].idle_power - 1e-9


def test_stall_power_is_voltage_times_current(robot: RobotDescription) -> None:
    bank = bank_with(robot, 1.0)
    torque_at(bank, 0.0, 0.0)
    servos = [robot.servos[joint.servo] for joint in robot.joints] * 6
    # Some joints' limits end before the goal, but every error of 0.9 rad and more asks for full duty.
    copper = sum(
        min(s.stall_torque / s.torque_constant, 0.9625 * s.supply_voltage / s.resistance) ** 2 * s.resistance
        for s in servos
    )
    assert bank.end_of_tick() == pytest.approx(copper + sum(s.idle_power for s in servos), rel=1e-6)


def test_goals_beyond_the_limits_end_at_the_limits(robot: RobotDescription) -> None:
    bank = bank_with(robot, 99.0)
    upper = robot.joints[FEMUR].upper
    assert abs(torque_at(bank, upper, 0.0)) < 0.1


def test_a_working_servo_warms_up_and_an_idle_one_does_not(robot: RobotDescription) -> None:
    busy, idle = bank_with(robot, 1.0), bank_with(robot, 0.0)
    for _ in range(3000):
        for bank in (busy, idle):
            torque_at(bank, 0.0, 0.0)
            bank.end_of_tick()
    assert busy.present_temperature()[FEMUR] > idle.present_temperature()[FEMUR] + 1.0


@given(st.floats(-3.0, 3.0))
def test_an_encoder_is_off_by_half_a_tick_at_most(angle: float) -> None:
    assert abs(encoder_position(np.array([angle]))[0] - angle) <= np.pi / 4096 + 1e-12


def test_voltage_sags_so_that_the_load_gets_its_power(robot: RobotDescription) -> None:
    battery = Battery(robot.power, charge=0.6)
    rest = battery.voltage
    battery.draw(100.0, 0.01)
    assert battery.voltage < rest
    asked = (100.0 + robot.power.electronics_power) / robot.power.converter_efficiency
    assert battery.voltage * battery.current == pytest.approx(asked)


def test_a_pack_lasts_as_long_as_its_charge(robot: RobotDescription) -> None:
    battery = Battery(robot.power)
    drawn = 0.0
    for _ in range(1800):
        battery.draw(45.0, 1.0)
        drawn += battery.current
    assert 1.0 - battery.charge == pytest.approx(drawn / (3600.0 * robot.power.battery_capacity_ah))
    assert 0.3 < battery.charge < 0.7  # about an hour in all
