"""Levels that follow each other by one rise are stairs; other flat places about them do not matter."""

import pytest

from robot_agent.perception.flat_tops import FlatTop
from robot_agent.perception.stairs import find_stairs


def levels(*heights):
    return [FlatTop(height=height, middle=height, area=0.5) for height in heights]


def test_a_flight_is_found_among_other_levels():
    stairs = find_stairs(levels(0.0, 0.08, 0.18, 0.26, 0.37, 0.55, 0.735))
    assert (stairs.rises, stairs.lowest) == (4, pytest.approx(0.0, abs=0.01))
    assert stairs.rise == pytest.approx(0.184, abs=0.002)
    assert 0.0 < stairs.rise_sigma < 0.005


def test_one_level_partly_something_else_does_not_move_the_rise():
    assert find_stairs(levels(0.0, 0.19, 0.395, 0.57, 0.76)).rise == pytest.approx(0.19, abs=0.001)


def test_two_boxes_are_no_stairs():
    assert find_stairs(levels(0.0, 0.06, 0.21)) is None
    assert find_stairs(levels(0.0)) is None
    assert find_stairs([]) is None
