"""No straight way leads into what an operator has forbidden, and the robot itself refuses it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.adaptation import ParameterOverrides
from robot_agent.commands import CommandDesk, Situation
from robot_agent.navigation.keep_out import hit
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Answer, Command, CommandName, TeleopFrame, Waypoint
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

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


class Driver(Operator):
    """Steers a robot that goes where the desk lets it, at 100 Hz of simulated time, heading along x."""

    def __init__(self) -> None:
        self.clock = SimulatedClock(1_000_000_000)
        self.desk = CommandDesk(robot=load_robot(), overrides=ParameterOverrides(), wall_clock_ns=self.clock.now_ns)
        self.epoch = self.sequence = 0
        self.place = np.zeros(2)
        self.stand()
        self.epoch = self.says(CommandName.TAKE_CONTROL).lease_epoch

    def stand(self) -> None:
        x, y = self.place.tolist()
        pose = Pose(rotation=np.eye(3), position=np.array([x, y, 0.2]))
        self.desk.observe(
            Situation(
                stamp_ns=self.clock.now_ns(), robot_xy=(x, y), mode="STAND", settled=False, stand_blockers=(),
                world_from_body=pose,
            )
        )  # fmt: skip

    def go(self, seconds: float, stick: tuple[float, float, float] | None = None) -> float:
        """Returns how far the robot has gone along x; without a stick only a cruise moves it."""
        begin = float(self.place[0])
        for tick in range(round(100 * seconds)):
            if tick % 5 == 0:
                self.says(CommandName.RETAIN_CONTROL)
                self.sequence += 1
                if stick is not None:
                    forward, left, turn = stick
                    self.desk.teleoperate(
                        TeleopFrame(
                            operator="ada", lease_epoch=self.epoch, sequence=self.sequence, dead_man=True,
                            forward=forward, left=left, turn=turn,
                        )
                    )  # fmt: skip
            velocity = self.desk.orders().teleop_velocity
            if velocity is not None:
                self.place = self.place + 0.01 * velocity[:2]
            self.clock.forward(seconds=0.01)
            self.stand()
        return float(self.place[0]) - begin

    @property
    def warnings(self) -> list[str]:
        return [event.text for event in self.desk.take_events() if "the robot stops before" in event.text]


CIRCLE = float(np.hypot(*load_robot().stance_in_body[:, :2].T).max()) + load_robot().foot_radius


def test_a_robot_driven_by_hand_stops_before_an_area_says_why_once_and_drives_away() -> None:
    ada = Driver()
    ada.forbids(area(*SQUARE))
    ada.go(20.0, (1.0, 0.0, 0.0))
    assert 2.0 - CIRCLE - 0.15 < ada.place[0] < 2.0 - CIRCLE
    assert ada.go(2.0, (1.0, 0.0, 0.0)) == 0.0
    assert len(ada.warnings) == 1
    assert ada.go(2.0, (-1.0, 0.0, 0.0)) == pytest.approx(-0.5, abs=0.05)
    ada.go(20.0, (1.0, 0.0, 0.0))
    assert "forbidden area 1" in ada.warnings[0]  # again, as it is a new attempt
    assert ada.forbids().accepted
    assert ada.go(4.0, (1.0, 0.0, 0.0)) > 0.9


def test_a_robot_that_stands_in_an_area_is_driven_out_of_it_but_no_deeper() -> None:
    ada = Driver()
    ada.place = np.array([2.2, 0.0])
    ada.stand()
    ada.forbids(area(*SQUARE))
    assert ada.go(2.0, (1.0, 0.0, 0.0)) == 0.0
    assert ada.go(6.0, (-1.0, 0.0, 0.0)) == pytest.approx(-1.5, abs=0.05)


def test_a_cruise_ends_before_an_area_and_does_not_begin_right_before_it() -> None:
    ada = Driver()
    ada.forbids(area(*SQUARE))
    assert ada.says(CommandName.START_CRUISE, name="forward", value=0.2, seconds=60.0).accepted
    ada.go(30.0)
    assert 2.0 - CIRCLE - 0.15 < ada.place[0] < 2.0 - CIRCLE
    assert ada.desk.motion().cruise_seconds_left == 0.0
    assert len(ada.warnings) == 1
    refused = ada.says(CommandName.START_CRUISE, name="forward", value=0.2, seconds=60.0)
    assert "forbidden area 1" in refused.reason
    assert ada.desk.orders().teleop_velocity is None
    assert ada.says(CommandName.START_CRUISE, name="forward", value=-0.2, seconds=5.0).accepted


def test_goals_in_an_area_are_refused_where_the_robot_finds_its_own_way() -> None:
    ada = Operator()
    ada.forbids(area(*SQUARE))
    ada.says(CommandName.SET_MISSION, name="auto", waypoints=area((1.0, 0.0), (2.2, 0.3)))
    assert "waypoint 2 is in forbidden area 1" in ada.says(CommandName.START_MISSION).reason
    ada.says(CommandName.SET_MISSION, name="auto", waypoints=area((4.0, 0.0)))
    assert ada.says(CommandName.START_MISSION).accepted
    assert ada.desk.orders().areas == (area(*SQUARE),)
    answer = ada.forbids(area((3.8, -0.2), (4.2, -0.2), (4.2, 0.2)))
    assert "the mission is paused: waypoint 1 is in forbidden area 1" in answer.reason
