"""What control may rely on with any body: simulated, on emulated buses in process and on terminals, and on
a recording of what went over a robot's lines."""

from __future__ import annotations

import numpy as np
import pytest
from hardware_bodies import order

from robot_agent.body import Body
from weaver_shared.messages import Proprioception

WAY = 0.15  # rad


def follow(body: Body, target: np.ndarray, ticks: int, *, torque: float = 6.0, on: bool = True) -> Proprioception:
    for _ in range(ticks):
        body.wait_next()
        body.read()
        body.write(order(target, torque=torque, on=on))
    body.wait_next()
    return body.read()


def test_readings_have_the_shapes_and_order_of_the_robot(body: Body) -> None:
    body.wait_next()
    sensed = body.read()
    joints, legs = body.robot.joint_count, body.robot.leg_count
    for values in (sensed.joint_position, sensed.joint_velocity, sensed.joint_torque, sensed.joint_temperature):
        assert values.shape == (joints,)
        assert np.isfinite(values).all()
    assert sensed.joint_valid.all()
    assert sensed.foot_contact.shape == (legs,)
    assert sensed.foot_contact.dtype == np.bool_


def test_ticks_are_ten_milliseconds_apart_and_stamp_their_readings(body: Body) -> None:
    stamps = []
    for _ in range(12):
        stamps.append(body.wait_next())
        assert body.read().stamp_ns == stamps[-1]
    assert np.median(np.diff(stamps)) >= 9_900_000
    assert min(np.diff(stamps)) > 0


def test_a_joint_goes_where_it_is_wanted_and_no_other_does(body: Body) -> None:
    body.wait_next()
    start = body.read().joint_position
    target = start.copy()
    target[7] += WAY
    sensed = follow(body, target, 50)
    assert sensed.joint_position[7] - start[7] == pytest.approx(WAY, abs=0.03)
    assert np.abs(np.delete(sensed.joint_position - start, 7)).max() < 0.05


def test_goals_end_at_the_joints_limits(body: Body) -> None:
    body.wait_next()
    target = body.read().joint_position
    upper = np.tile(body.robot.joint_limits[:, 1], body.robot.leg_count)
    target[4] = upper[4] + 0.5
    assert follow(body, target, 60).joint_position[4] <= upper[4] + 0.02


def test_without_torque_nothing_is_driven(body: Body) -> None:
    body.wait_next()
    start = body.read().joint_position
    sensed = follow(body, start + WAY, 20, on=False)
    assert np.abs(sensed.joint_torque).max() < 0.01
    assert np.abs(sensed.joint_position[0::5] - start[0::5]).max() < 0.02


def test_torque_limits_bound_what_the_servos_draw(body: Body) -> None:
    body.wait_next()
    target = body.read().joint_position
    target[0::5] += 3 * WAY
    for _ in range(30):
        body.wait_next()
        assert np.abs(body.read().joint_torque).max() < 1.0 + 0.02
        body.write(order(target, torque=1.0))
