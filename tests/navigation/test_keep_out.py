"""A robot that is steered never comes into a forbidden area, obeys late as it may, and is never caught by one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.navigation import AreaFence
from robot_agent.navigation.keep_out import depths
from weaver_shared.messages import Waypoint

RADIUS, HALF_WIDTH = 0.45, 0.33
AHEAD = np.array([1.0, 0.0])
SQUARE = ((2.0, -0.5), (3.0, -0.5), (3.0, 0.5), (2.0, 0.5))
BAY = ((-1.5, -1.5), (1.5, -1.5), (1.5, 1.5), (0.8, 1.5), (0.8, -0.8), (-0.8, -0.8), (-0.8, 1.5), (-1.5, 1.5))
FENCE = AreaFence(RADIUS, HALF_WIDTH)
LATE = 30  # ticks of 10 ms after which the robot does what it is told


def area(*corners: tuple[float, float]) -> tuple[Waypoint, ...]:
    return tuple(Waypoint(x=x, y=y) for x, y in corners)


def depth(areas: list[tuple[Waypoint, ...]], place: np.ndarray) -> float:
    return min(float(depths(one, place[None])[0]) for one in areas)


def drive(areas: list[tuple[Waypoint, ...]], place: np.ndarray, asked: np.ndarray, seconds: float) -> np.ndarray:
    """Places (n, 2) of a robot that obeys 0.3 s late."""
    told, places = [np.zeros(3)] * LATE, [place]
    for _ in range(round(seconds * 100)):
        told.append(FENCE.limit(areas, asked, places[-1], AHEAD).velocity)
        places.append(places[-1] + 0.01 * told[-1 - LATE][:2])
    return np.array(places)


@pytest.mark.parametrize("asked", [(0.25, 0.0, 0.3), (0.25, 0.1, 0.0), (0.2, -0.1, 0.0)])
def test_a_robot_steered_straight_at_an_area_slows_down_and_stops_before_it(asked: tuple[float, float, float]) -> None:
    places = drive([area(*SQUARE)], np.array([0.0, 0.2]), np.array(asked), 25.0)
    left = depths(area(*SQUARE), places)
    assert left.min() > RADIUS
    assert left[-1] < RADIUS + 0.15
    speeds = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert speeds[-1] == 0.0
    assert np.abs(np.diff(speeds[LATE + 1 :])).max() < 3e-4  # without a jerk: 0.03 m/s between ticks


def test_the_turn_is_left_as_it_is_so_that_the_robot_can_be_steered_away() -> None:
    fenced = FENCE.limit([area(*SQUARE)], np.array([0.2, 0.0, 0.4]), np.array([1.49, 0.0]), AHEAD)
    assert (fenced.area, fenced.halted) == (1, True)
    assert fenced.velocity.tolist() == [0.0, 0.0, 0.4]


def test_beside_an_area_and_away_from_it_nothing_is_slowed() -> None:
    for place, asked in (((1.4, 0.0), (-0.2, 0.0, 0.0)), ((1.4, 0.0), (0.0, 0.1, 0.0)), ((2.8, 1.1), (0.25, 0.0, 0.1))):
        fenced = FENCE.limit([area(*SQUARE)], np.array(asked), np.array(place), AHEAD)
        assert fenced.velocity.tolist() == list(asked)
        assert fenced.area == 0


def test_the_area_that_stops_the_robot_is_told_by_its_number() -> None:
    far = area((8, 8), (9, 8), (9, 9))
    assert FENCE.limit([far, area(*SQUARE)], np.array([0.25, 0.0, 0.0]), np.array([1.5, 0.0]), AHEAD).area == 2


coordinate = st.floats(-3.0, 4.0).map(lambda value: round(value, 3))
turn = st.floats(0.0, 2.0 * np.pi)


@settings(max_examples=12)
@given(coordinate, coordinate, st.lists(turn, min_size=1, max_size=4))
def test_whatever_is_steered_outside_stays_outside(x: float, y: float, turns: list[float]) -> None:
    areas, place = [area(*SQUARE), area(*BAY)], np.array([x, y])
    before = depth(areas, place)
    for angle in turns:
        asked = 0.25 * np.array([np.cos(angle), np.sin(angle), 0.0])
        for step in drive(areas, place, asked, 3.0)[:: LATE // 2]:
            place = step
            assert depth(areas, place) > min(before, HALF_WIDTH) - 0.1 * HALF_WIDTH
            before = max(before, min(depth(areas, place), HALF_WIDTH))


@settings(max_examples=30)
@given(coordinate, coordinate)
def test_a_robot_that_stands_in_an_area_can_always_be_driven_out(x: float, y: float) -> None:
    areas, place = [area(*SQUARE), area(*BAY)], np.array([x, y])
    directions = [np.array([np.cos(a), np.sin(a), 0.0]) for a in np.linspace(0.0, 2.0 * np.pi, 36, endpoint=False)]
    for _ in range(400):
        if depth(areas, place) >= HALF_WIDTH:
            return
        moves = [FENCE.limit(areas, 0.2 * way, place, AHEAD).velocity[:2] for way in directions]
        places = [place + 0.1 * move for move in moves]
        place = places[int(np.argmax([depth(areas, to) for to in places]))]
    raise AssertionError(f"still {depth(areas, place):.2f} m from the border at {place}")


@given(coordinate, coordinate)
def test_a_place_is_inside_where_its_depth_is_negative(x: float, y: float) -> None:
    (found,) = depths(area(*SQUARE), np.array([[x, y]]))
    aside = np.maximum(np.abs([x - 2.5, y]) - 0.5, 0.0)
    inside = max(abs(x - 2.5), abs(y)) - 0.5
    assert found == pytest.approx(np.hypot(*aside) if inside > 0.0 else inside, abs=1e-9)
