"""The simulated robot behind its servos' bytes: the simulator's clock, its pictures' stamps, and joints as without."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing

import numpy as np
import pytest
from hardware_bodies import order

from robot_agent.body import Body
from sim_agent.body import SimulatedBody
from sim_agent.servo_bus.twin_body import TwinBody
from sim_agent.worlds import make_world
from weaver_shared.robots import load_robot

WEAVER = load_robot("weaver")


@pytest.fixture
def twin() -> Iterator[TwinBody]:
    with closing(TwinBody(WEAVER, make_world("flat", 1), 1)) as body:
        yield body


def driven(body: Body, ticks: int) -> np.ndarray:
    """Joint angles (ticks, joints) of a robot that swings its yaw joints on the ground, orders by the tick."""
    body.wait_next()
    start = body.read().joint_position
    angles = []
    for tick in range(ticks):
        swing = np.zeros(start.size)
        # After torque has come on softly; no faster than a soft start goes.
        swing[0::5] = 0.2 * np.sin(2.0 * np.pi * 0.5 * max(tick - 210, 0) / 100.0)
        body.write(order(start + swing))
        body.wait_next()
        angles.append(body.read().joint_position)
    return np.array(angles)


def test_it_begins_sitting_with_all_servos_well(twin: TwinBody) -> None:
    twin.wait_next()
    assert twin.read().joint_valid.all()
    assert twin.troubles() == []
    assert twin.kind == "EMULATED BUS"


def test_bus_and_simulator_tell_the_same_time(twin: TwinBody) -> None:
    begun_ns = twin.scene_state().stamp_ns
    for tick in range(1, 8):
        stamp_ns = twin.wait_next()
        assert stamp_ns == begun_ns + tick * 10_000_000
        assert twin.scene_state().stamp_ns == twin.truth().stamp_ns == stamp_ns == twin.read().stamp_ns
        # Odometry bears no delay between what the sensor felt and what the eyes saw.
        samples = twin.read().imu.stamp_ns
        assert tick < 3 or samples.tolist() == [stamp_ns - 5_000_000, stamp_ns]


def test_joints_go_as_without_servos_between(twin: TwinBody) -> None:
    behind = driven(twin, 400)
    with closing(SimulatedBody(WEAVER, make_world("flat", 1), 1)) as simulated:
        alone = driven(simulated, 400)
    assert np.ptp(behind[:, 0]) > 0.3
    apart = np.degrees(np.sqrt(np.mean((behind - alone)[210:] ** 2)))
    assert apart < 0.2


def test_two_runs_are_the_same_bit_for_bit(twin: TwinBody) -> None:
    with closing(TwinBody(WEAVER, make_world("flat", 1), 1)) as other:
        assert driven(twin, 30).tobytes() == driven(other, 30).tobytes()
