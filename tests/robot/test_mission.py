"""A mission knows its phase, keeps its progress over a pause, and forgets it when it is replaced."""

import numpy as np

from robot_agent.mission import Mission
from weaver_shared.config.command import CommandLimits
from weaver_shared.messages import Waypoint

A, B, C = Waypoint(x=1.0, y=0.0), Waypoint(x=2.0, y=0.0), Waypoint(x=3.0, y=0.0)


def started(*waypoints: Waypoint) -> Mission:
    mission = Mission(CommandLimits())
    assert mission.replace(waypoints, (0.0, 0.0)) == ""
    assert mission.start() == ""
    return mission


def advance(mission: Mission, index: int) -> None:
    mission.progress(index=index, cross_track_error=0.1, distance_left=1.0, lookahead=np.zeros(2))


def test_progress_survives_a_pause() -> None:
    mission = started(A, B)
    advance(mission, 1)
    mission.pause()
    assert mission.phase == "paused"
    mission.start()
    assert mission.state(0).next_waypoint == 1


def test_too_many_waypoints_are_refused() -> None:
    mission = Mission(CommandLimits(waypoint_count=2))
    assert "at most 2" in mission.replace((A, B, C), (0.0, 0.0))
    assert mission.phase == "empty"


def test_a_finished_mission_must_be_replaced_to_go_on() -> None:
    mission = started(A)
    mission.finish()
    assert "done" in mission.start()
    mission.replace((B,), (0.0, 0.0))
    assert mission.start() == ""


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
