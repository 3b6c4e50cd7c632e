"""Pace and energy are means over the last metres of missions, and unknown before there are any."""

from math import isnan

import pytest

from robot_agent.walking_pace import WINDOW, WalkingPace, expected_speed
from weaver_shared.config.navigation import PathFollowerConfig
from weaver_shared.robots import load_robot


class Walk:
    """A robot that walks along x, ticked at 100 Hz."""

    def __init__(self) -> None:
        self.pace = WalkingPace(fastest=0.35)
        self.stamp_ns, self.x = 0, 0.0

    def goes(self, seconds: float, speed: float, power: float, *, walking: bool = True) -> None:
        for _ in range(round(100 * seconds)):
            self.stamp_ns += 10_000_000
            self.x += 0.01 * speed
            self.pace.add(self.stamp_ns, (self.x, 0.0), power, walking=walking)


@pytest.fixture
def walk() -> Walk:
    return Walk()


def test_nothing_is_said_before_half_a_metre(walk: Walk) -> None:
    walk.goes(4.0, 0.1, 100.0)
    assert isnan(walk.pace.speed)
    assert isnan(walk.pace.energy_per_metre)
    assert walk.pace.measured_over == 0.0


def test_speed_and_energy_of_a_steady_walk(walk: Walk) -> None:
    walk.goes(20.0, 0.1, 100.0)
    assert walk.pace.speed == pytest.approx(0.1, rel=0.02)
    assert walk.pace.energy_per_metre == pytest.approx(1000.0, rel=0.02)


def test_turning_on_the_spot_counts_and_a_pause_does_not(walk: Walk) -> None:
    walk.goes(10.0, 0.1, 100.0)
    walk.goes(60.0, 0.0, 50.0, walking=False)
    walk.goes(10.0, 0.1, 100.0)
    assert walk.pace.speed == pytest.approx(0.1, rel=0.05)
    walk.goes(20.0, 0.0, 100.0)
    walk.goes(2.0, 0.1, 100.0)
    assert walk.pace.speed == pytest.approx(0.05, rel=0.15)


def test_the_newest_metres_count(walk: Walk) -> None:
    walk.goes(50.0, 0.1, 100.0)
    walk.goes((WINDOW + 0.2) / 0.2, 0.2, 100.0)
    assert walk.pace.speed == pytest.approx(0.2, rel=0.02)
    assert WINDOW <= walk.pace.measured_over < WINDOW + 0.15


def test_a_lost_place_is_not_walked_from(walk: Walk) -> None:
    walk.goes(10.0, 0.1, 100.0)
    before = walk.pace.measured_over
    walk.pace.add(walk.stamp_ns, (float("nan"), 0.0), 100.0, walking=True)
    walk.x += 5.0
    walk.goes(0.1, 0.1, 100.0)
    assert walk.pace.measured_over == before


def test_a_correction_of_the_place_is_not_walked(walk: Walk) -> None:
    walk.goes(10.0, 0.1, 100.0)
    walk.x += 0.4
    walk.goes(10.0, 0.1, 100.0)
    assert walk.pace.speed == pytest.approx(0.1, rel=0.05)


def test_the_expected_speed_follows_the_stride_frequency_up_to_that_of_missions() -> None:
    robot = load_robot()
    slow = expected_speed(robot, "tripod", 0.3)
    assert slow == pytest.approx(robot.locomotion.largest_stride * 0.3 / robot.gait_table["tripod"].duty)
    assert expected_speed(robot, "wave", 0.3) < slow
    assert expected_speed(robot, "tripod", 5.0) == PathFollowerConfig().forward_speed
