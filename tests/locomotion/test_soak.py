"""A short soak in which nothing may go wrong, and proof that it would be noticed."""

import numpy as np
import pytest

from robot_agent.locomotion import Walker, WalkOutput
from robot_agent.locomotion.soak import soak
from robot_agent.locomotion.soak.leg_orders import random_foothold, random_posture
from robot_agent.locomotion.soak.robots import random_robot
from weaver_shared.robots import load_robot, robot_names


def test_random_lives_of_all_robots_violate_nothing():
    lives = 2 * len(robot_names())
    results = [soak(1, seed=3, first=life, life=200) for life in range(lives)]
    assert [result.violations for result in results] == [()] * lives
    assert set(robot_names()) <= {robot for result in results for robot in result.ticks_by_robot}
    seen = {posture for result in results for posture in result.ticks_by_posture}
    assert {"rising", "standing", "walking", "changing"} <= seen


def test_orders_for_legs_are_of_every_kind_and_often_wrong():
    rng, robot = np.random.default_rng(1), load_robot("weaver")
    footholds = [random_foothold(robot, rng) for _ in range(300)]
    assert {order.leg for order in footholds} == set(range(-1, robot.leg_count + 1))
    assert 10 < sum(not np.isfinite(order.place).all() for order in footholds) < 150
    postures = [random_posture(rng) for _ in range(300)]
    assert {"insectoid", "mammalian", ""} < {order.name for order in postures}
    assert len({order.serial for order in postures}) < 300


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda joints: joints + np.nan, "not finite"),
        (lambda joints: joints + 9.0, "beyond its limit"),
        (lambda joints: np.where(np.abs(joints) < 0.05, 0.3, joints), "more than its servo can"),
    ],
)
def test_a_walker_gone_wrong_is_noticed(change, said, monkeypatch):
    honest = WalkOutput.joint_position.fget

    monkeypatch.setattr(WalkOutput, "joint_position", property(lambda out: change(honest(out))))
    violations = soak(200, seed=3, life=100).violations
    assert any(said in violation.what for violation in violations)


def test_a_raised_exception_is_noticed(monkeypatch):
    def step(self, sensed):
        raise ZeroDivisionError("nothing to divide by")

    monkeypatch.setattr(Walker, "step", step)
    assert soak(1, seed=3, life=10).violations[0].what == "raised ZeroDivisionError: nothing to divide by"


def test_random_robots_are_of_every_kind():
    robots = [random_robot(np.random.default_rng(seed), seed) for seed in range(80)]
    assert {robot.leg_count for robot in robots} == set(range(3, 9))
    assert {robot.joints_per_leg for robot in robots} == set(range(3, 7))
    assert any(leg.mirrored for robot in robots for leg in robot.legs)
