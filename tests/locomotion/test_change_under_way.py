"""Gait, frequency and stride height change while walking: feet move without a jump in place or velocity."""

from functools import cache
from itertools import permutations

import numpy as np
import pytest

from robot_agent.locomotion import Walker, WalkInput
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot

ROBOT = load_robot("weaver")
DT = 0.01
FREQUENCY = 0.6  # Hz
FASTEST, LARGEST_STEP = 1.6, 0.45
"""m/s of a foot seen from the body, and from one tick to the next, while a gait goes over into another."""
MORE = 1.25
"""Times a steady walk's fastest foot and largest change of its velocity in a tick."""


class Walk:
    def __init__(self, gait):
        config = ROBOT.locomotion.model_copy(update={"feel_ground": False, "compensate_servos": False})
        self.walker = Walker(ROBOT, config, DT)
        self.joints, self.gait = self.walker.begin_standing(), gait
        self.frequency, self.height = FREQUENCY, 0.05
        self.feet, self.speed = ROBOT.stance_in_body, np.zeros((6, 3))
        self.fastest = self.largest_step = 0.0

    def run(self, seconds):
        for _ in range(round(seconds / DT)):
            out = self.walker.step(
                WalkInput(
                    stamp_ns=0,
                    velocity=np.array([0.08, 0.02, 0.1]),
                    parameters=GaitParameters(
                        stamp_ns=0,
                        virtual_stiffness=2000.0,
                        stride_frequency=self.frequency,
                        stride_height=self.height,
                        confidence=1.0,
                    ),
                    gait=self.gait,
                    stand=True,
                    joint_position=self.joints,
                    joint_torque=np.zeros(30),
                    foot_contact=np.ones(6, dtype=np.bool_),
                    gravity_in_body=np.array([0.0, 0.0, -1.0]),
                )
            )
            self.joints, feet = out.joint_position, out.foot_in_body
            speed = (feet - self.feet) / DT
            self.fastest = max(self.fastest, np.linalg.norm(speed, axis=1).max())
            self.largest_step = max(self.largest_step, np.linalg.norm(speed - self.speed, axis=1).max())
            self.feet, self.speed = feet, speed
        return out


@cache
def steady(gait, frequency, height=0.05):
    """Fastest foot, m/s, and its largest change of velocity in a tick, in a walk that nobody changes."""
    walk = Walk(gait)
    walk.frequency, walk.height = frequency, height
    walk.run(5.0)
    return np.array([walk.fastest, walk.largest_step])


@pytest.mark.parametrize(("before", "after"), list(permutations(ROBOT.gaits, 2)))
def test_every_gait_goes_over_into_every_other(before, after):
    walk = Walk(before)
    walk.run(3.0 + 0.137 * len(before))
    walk.gait = after
    out = walk.run(14.0)
    # a robot that slows down for its stability draws the footholds of feet in the air nearer, late in a swing too
    assert walk.fastest < FASTEST
    assert walk.largest_step < LARGEST_STEP
    gait = ROBOT.gait(after)
    relative = (out.phase - out.phase[0] - gait.offsets + gait.offsets[0] + 0.5) % 1.0 - 0.5
    np.testing.assert_allclose(relative, 0.0, atol=1e-6)


@pytest.mark.parametrize("gait", ROBOT.gaits)
def test_frequency_and_height_may_change_at_any_moment(gait):
    rng, walk = np.random.default_rng(len(gait)), Walk(gait)
    for _ in range(20):
        walk.frequency, walk.height = rng.uniform(0.2, 1.2), rng.uniform(0.03, 0.12)
        walk.run(rng.uniform(0.2, 1.5))
    fastest, largest_step = MORE * steady(gait, 1.2, 0.12)
    assert walk.fastest < fastest
    assert walk.largest_step < largest_step


def test_the_frequency_walked_is_exactly_the_one_asked_for():
    walk = Walk("tripod")
    walk.frequency = 0.537
    out = walk.run(6.0)
    begin, turns = out.phase[0], 0.0
    for _ in range(2000):
        out = walk.run(DT)
        turns += (out.phase[0] - begin) % 1.0
        begin = out.phase[0]
    assert turns == pytest.approx(0.537 * 20.0, abs=1e-9)
