"""What the robot tells of its servos: every temperature and, from a body that can tell, every fault."""

from __future__ import annotations

import numpy as np
from hardware_bodies import KinematicBody

from robot_agent.loops import WalkLoop
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import ServoStates
from weaver_shared.robots import load_robot

WEAVER = load_robot("weaver")
STUCK = ("is stuck", *[""] * (WEAVER.joint_count - 1))


class WithOneStuck(KinematicBody):
    def joint_faults(self) -> tuple[str, ...]:
        return STUCK


def told_by(body: KinematicBody, ticks: int) -> list[ServoStates]:
    bus, told = MemoryBus(), list[ServoStates]()
    bus.subscribe("w", topics.SERVOS, lambda _id, _key, states: told.append(states))
    loop = WalkLoop(robot_id="w", body=body, bus=bus, wall_clock_ns=SimulatedClock(0).now_ns)
    for _ in range(ticks):
        loop.tick()
    return told


def test_temperatures_are_told_five_times_a_second() -> None:
    told = told_by(KinematicBody(WEAVER), 100)
    assert np.diff([states.stamp_ns for states in told]).tolist() == [200_000_000] * 4
    np.testing.assert_array_equal(told[0].temperature, np.full(WEAVER.joint_count, 30.0))


def test_a_body_tells_which_servo_is_not_well_or_that_it_can_not_tell() -> None:
    assert told_by(WithOneStuck(WEAVER), 1)[0].faults == STUCK
    assert told_by(KinematicBody(WEAVER), 1)[0].faults == ()
