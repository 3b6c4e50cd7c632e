"""A mission knows its phase, keeps its progress over a pause, and forgets it when it is replaced."""

import numpy as np

from robot_agent.mission import Mission
from weaver_shared.config.command import CommandLimits
from weaver_shared.messages import Waypoint

A, B, C = Waypoint(x=1.0, y=0.0), Waypoint(x=2.0, y=0.0), Waypoint(x=3.0, y=0.0)


def started(*waypoints: Waypoint) -> Mission:
    mission = Mission(CommandLimits())
    assert mission.replace(waypoints, (0.0, 0.0)) == ""
    assert mission.start((0.0, 0.0)) == ""
    return mission


def advance(mission: Mission, index: int) -> None:
    mission.progress(index=index, cross_track_error=0.1, distance_left=1.0, lookahead=np.zeros(2))


def test_progress_survives_a_pause() -> None:
    mission = started(A, B)
    advance(mission, 1)
    mission.pause()
    assert mission.phase == "paused"
    mission.start((0.0, 0.0))
    assert mission.state(0).next_waypoint == 1


def test_too_many_waypoints_are_refused() -> None:
    mission = Mission(CommandLimits(waypoint_count=2))
    assert "at most 2" in mission.replace((A, B, C), (0.0, 0.0))
    assert mission.phase == "empty"


def test_a_finished_mission_must_be_replaced_to_go_on() -> None:
    mission = started(A)
    mission.finish()
    assert "done" in mission.start((0.0, 0.0))
    mission.replace((B,), (0.0, 0.0))
    assert mission.start((0.0, 0.0)) == ""


def test_changing_what_is_behind_begins_anew() -> None:
    mission = started(A, B)
    advance(mission, 1)
    before = mission.serial
    mission.replace((C, B), (0.0, 0.0))
    assert mission.phase == "ready"
    assert mission.serial > before


def test_dropping_all_that_lies_ahead_ends_the_mission() -> None:
    mission = started(A, B)
    advance(mission, 1)
    mission.replace((A,), (0.0, 0.0))
    assert mission.phase == "done"


def test_clearing_empties_it() -> None:
    mission = started(A)
    mission.replace((), (0.0, 0.0))
    assert mission.state(0).waypoints == ()
    assert mission.phase == "empty"


def test_a_skipped_waypoint_is_left_out_and_those_after_it_keep_their_numbers() -> None:
    mission = started(A, B, C)
    before = mission.serial
    assert mission.skip() == ""
    assert mission.serial > before  # the line walked begins where the robot is
    assert mission.walked == (B, C)
    assert mission.state(0).waypoints == (A, B, C)
    advance(mission, 1)
    assert mission.state(0).next_waypoint == 2


def test_skipping_the_last_waypoint_ends_the_mission() -> None:
    mission = started(A)
    assert mission.skip() == ""
    assert mission.phase == "done"
    assert "no mission is under way" in mission.skip()


def test_it_returns_through_the_waypoints_that_it_reached() -> None:
    mission = started(A, B, C)
    advance(mission, 1)
    mission.skip()
    advance(mission, 1)  # C is reached, B was not
    assert mission.turn_back((3.0, 0.0)) == ""
    assert mission.walked == (C, A, Waypoint(x=0.0, y=0.0))
    assert mission.phase == "active"


def test_returning_again_goes_on_with_the_way_back() -> None:
    mission = started(A, B)
    advance(mission, 2)
    mission.turn_back((2.0, 0.0))
    advance(mission, 1)
    mission.pause()
    assert mission.turn_back((1.5, 0.0)) == ""
    assert mission.walked == (A, Waypoint(x=0.0, y=0.0))


def test_a_robot_that_finds_its_way_needs_no_waypoints_to_return() -> None:
    mission = Mission(CommandLimits())
    mission.replace((A, B), (0.5, 0.0), "auto")
    mission.start((0.5, 0.0))
    advance(mission, 1)
    mission.turn_back((1.0, 0.0))
    assert mission.walked == (Waypoint(x=0.5, y=0.0),)
    assert mission.find_way


def test_before_a_mission_the_start_is_where_the_world_of_the_robot_begins() -> None:
    mission = Mission(CommandLimits())
    assert "at the start already" in mission.turn_back((0.1, 0.0))
    assert mission.phase == "empty"
    assert mission.turn_back((2.0, 1.0)) == ""
    assert mission.walked == (Waypoint(x=0.0, y=0.0),)
