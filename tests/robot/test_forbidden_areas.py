"""No straight way leads into what an operator has forbidden, and the robot itself refuses it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.adaptation import ParameterOverrides
from robot_agent.commands import CommandDesk, Situation
from robot_agent.forbidden_areas import hit
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Answer, Command, CommandName, Waypoint
from weaver_shared.robots import load_robot

SQUARE = ((2.0, -0.5), (3.0, -0.5), (3.0, 0.5), (2.0, 0.5))
HALF_WIDTH = 0.3


def area(*corners: tuple[float, float]) -> tuple[Waypoint, ...]:
    return tuple(Waypoint(x=x, y=y) for x, y in corners)


@pytest.mark.parametrize(
    ("begin", "end", "number"),
    [
        ((0.0, 0.0), (5.0, 0.0), 1),  # right through
        ((0.0, 0.0), (2.5, 0.0), 1),  # into it
        ((0.0, 0.0), (1.5, 0.0), None),  # before it
        ((0.0, 0.0), (1.9, 0.0), 1),  # the feet would be in it
        ((0.0, 1.0), (5.0, 1.0), None),  # beside it
        ((0.0, 0.7), (5.0, 0.7), 1),  # too close beside it
        ((2.5, 0.0), (5.0, 0.0), None),  # out of it
        ((2.5, 0.0), (2.6, 0.0), 1),  # within it
    ],
)
def test_a_way_keeps_clear_of_an_area(begin: tuple[float, float], end: tuple[float, float], number: int | None) -> None:
    assert hit([area(*SQUARE)], begin, end, HALF_WIDTH) == number


def test_the_bay_of_an_area_is_not_in_it() -> None:
    bay = area((0, 0), (4, 0), (4, 3), (3, 3), (3, 1), (1, 1), (1, 3), (0, 3))
    assert hit([bay], (2.0, 5.0), (2.0, 2.0), HALF_WIDTH) is None
    assert hit([area(*SQUARE), bay], (2.0, 5.0), (2.0, 1.2), HALF_WIDTH) == 2


coordinate = st.floats(-5.0, 5.0).map(lambda value: round(value, 2))


@given(coordinate, coordinate, coordinate, coordinate)
def test_a_way_there_is_hit_as_the_way_back(x0: float, y0: float, x1: float, y1: float) -> None:
    square = [area(*SQUARE)]
    ends = [hit(square, place, place, HALF_WIDTH) for place in ((x0, y0), (x1, y1))]
    if ends == [None, None]:
        assert hit(square, (x0, y0), (x1, y1), HALF_WIDTH) == hit(square, (x1, y1), (x0, y0), HALF_WIDTH)


class Operator:
    def __init__(self) -> None:
        self.desk = CommandDesk(
            robot=load_robot(), overrides=ParameterOverrides(), wall_clock_ns=SimulatedClock(1_000_000_000).now_ns
        )
        self.epoch = self.sequence = 0
        self.stand_at(0.0, 0.0)
        self.epoch = self.says(CommandName.TAKE_CONTROL).lease_epoch

    def stand_at(self, x: float, y: float) -> None:
        self.desk.observe(Situation(stamp_ns=0, robot_xy=(x, y), mode="STAND", settled=False, stand_blockers=()))

    def says(self, command: CommandName, **fields: object) -> Answer:
        self.sequence += 1
        return self.desk.answer(
            Command(command=command, operator="ada", lease_epoch=self.epoch, sequence=self.sequence, **fields)
        )

    def forbids(self, *areas: tuple[Waypoint, ...]) -> Answer:
        corners = tuple(corner for one in areas for corner in one)
        return self.says(CommandName.SET_AREAS, name=" ".join(str(len(one)) for one in areas), waypoints=corners)


def test_a_mission_into_an_area_is_refused_with_its_number() -> None:
    ada = Operator()
    assert ada.forbids(area((8, 8), (9, 8), (9, 9)), area(*SQUARE)).applied_value == 2.0
    ada.says(CommandName.SET_MISSION, waypoints=area((1.0, 0.0), (4.0, 0.0)))
    answer = ada.says(CommandName.START_MISSION)
    assert not answer.accepted
    assert "the way to waypoint 2 leads into forbidden area 2" in answer.reason
    assert ada.forbids().accepted
    assert ada.says(CommandName.START_MISSION).accepted


def test_a_mission_under_way_pauses_before_a_new_area() -> None:
    ada = Operator()
    ada.says(CommandName.SET_MISSION, waypoints=area((1.0, 0.0), (4.0, 0.0)))
    assert ada.says(CommandName.START_MISSION).accepted
    answer = ada.forbids(area(*SQUARE))
    assert answer.accepted
    assert "the mission is paused: the way to waypoint 2" in answer.reason
    assert ada.desk.mission(0).phase == "paused"
    assert [len(one) for one in ada.desk.areas(0).areas] == [4]


def test_the_way_back_is_judged_like_any_other() -> None:
    ada = Operator()
    ada.says(CommandName.SET_MISSION, waypoints=area((5.0, 0.0)))
    ada.says(CommandName.START_MISSION)
    ada.stand_at(5.0, 0.0)
    ada.says(CommandName.PAUSE_MISSION)
    ada.forbids(area(*SQUARE))
    answer = ada.says(CommandName.RETURN_TO_START)
    assert not answer.accepted
    assert "the way to waypoint 1 leads into forbidden area 1" in answer.reason
    ada.forbids()
    assert ada.says(CommandName.RETURN_TO_START).accepted


@pytest.mark.parametrize(
    ("name", "corners"),
    [("2", 2), ("3 1", 4), ("4", 3), ("three", 3), ("-3 6", 3), ("", 3), ("3 " * 60, 180), ("3.5", 3)],
)
def test_what_is_no_area_is_refused(name: str, corners: int) -> None:
    ada = Operator()
    ada.forbids(area(*SQUARE))
    places = tuple(Waypoint(x=float(k), y=float(k * k)) for k in range(corners))
    answer = ada.says(CommandName.SET_AREAS, name=name, waypoints=places)
    assert not answer.accepted
    assert "corner" in answer.reason
    assert len(ada.desk.areas(0).areas) == 1


def test_corners_are_finite() -> None:
    corners = area((0, 0), (1, float("nan")), (1, 1))
    assert "finite" in Operator().forbids(corners).reason
