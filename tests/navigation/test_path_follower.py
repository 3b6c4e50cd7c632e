"""The follower brings the robot onto the line and to the last waypoint, from anywhere."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.navigation import PathFollower
from weaver_shared.config.navigation import PathFollowerConfig
from weaver_shared.messages import Waypoint
from weaver_shared.transforms import Pose, rotation_z

PATH = (Waypoint(x=0.0, y=0.0), Waypoint(x=4.0, y=0.0))


def pose(x: float, y: float, yaw: float = 0.0) -> Pose:
    return Pose(rotation=rotation_z(yaw), position=np.array([x, y, 0.15]))


def walk(waypoints, x, y, yaw, *, seconds=300.0, dt=0.1):
    """Places (n, 3) of an ideal robot that obeys the follower, and whether it was done."""
    follower, index, places = PathFollower(), 1, []
    for _ in range(round(seconds / dt)):
        answer = follower.step(pose(x, y, yaw), waypoints, index)
        index = answer.index
        if answer.done:
            return np.array(places), True
        vx, vy, turn = answer.velocity
        x += (vx * np.cos(yaw) - vy * np.sin(yaw)) * dt
        y += (vx * np.sin(yaw) + vy * np.cos(yaw)) * dt
        yaw += turn * dt
        places.append((x, y, yaw))
    return np.array(places), False


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_robot_beside_the_line_is_pushed_and_turned_towards_it(side):
    answer = PathFollower().step(pose(1.0, 0.2 * side), PATH, 1)
    assert answer.cross_track_error == pytest.approx(0.2 * side)
    assert np.sign(answer.velocity[1]) == -side
    assert np.sign(answer.velocity[2]) == -side


@pytest.mark.parametrize("off", [0.3, 1.0, 2.5])
def test_the_cross_track_error_dies_out_within_the_line(off):
    places, done = walk(PATH, 0.0, off, 0.0)
    past_middle = places[places[:, 0] > 3.0]
    assert done
    assert np.abs(past_middle[:, 1]).max() < 0.1 + 0.15 * off


def test_forward_speed_follows_equation_1_on_the_line():
    config = PathFollowerConfig()
    for ahead in (3.0, 1.0, 0.6):
        velocity = PathFollower().step(pose(4.0 - ahead, 0.0), PATH, 1).velocity
        expected = config.forward_speed * ahead / np.hypot(ahead, config.acceptance_radius)
        assert velocity[0] == pytest.approx(expected)


def test_beyond_the_radius_the_robot_heads_straight_for_the_line():
    answer = PathFollower().step(pose(1.0, 0.8, -np.pi / 2), PATH, 1)
    assert answer.velocity[2] == pytest.approx(0.0, abs=1e-9)
    assert answer.velocity[0] > 0.2


def test_sideways_speed_is_bounded_where_equation_2_is_not():
    limit = PathFollowerConfig().side_speed
    for e in np.linspace(-3.0, 3.0, 61):
        assert abs(PathFollower().step(pose(1.0, e, 1e-9), PATH, 1).velocity[1]) <= limit


def test_a_robot_that_has_to_turn_round_stays_near_its_path():
    there_and_back = (*PATH, Waypoint(x=0.0, y=0.0))
    places, done = walk(there_and_back, 3.0, 0.0, 0.0)
    assert done
    assert 0.0 < np.abs(places[:, 1]).max() < 0.16


def test_the_next_segment_begins_inside_the_circle_of_acceptance():
    corner = (*PATH, Waypoint(x=4.0, y=3.0))
    assert PathFollower().step(pose(3.45, 0.0), corner, 1).index == 1
    assert PathFollower().step(pose(3.55, 0.0), corner, 1).index == 2


@settings(max_examples=60)
@given(x=st.floats(-2.0, 6.0), y=st.floats(-3.0, 3.0), yaw=st.floats(-np.pi, np.pi), goal_y=st.floats(-2.0, 2.0))
def test_the_last_waypoint_is_reached_from_anywhere(x, y, yaw, goal_y):
    waypoints = (*PATH, Waypoint(x=5.0, y=goal_y))
    places, done = walk(waypoints, x, y, yaw)
    assert done
    if len(places):
        assert np.hypot(places[-1, 0] - 5.0, places[-1, 1] - goal_y) <= 0.15


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_pose_that_is_not_finite_asks_for_no_motion(bad):
    answer = PathFollower().step(pose(bad, 0.0), PATH, 1)
    assert not answer.velocity.any()
    assert not answer.done
    assert answer.index == 1


def test_no_waypoints_left_is_done():
    assert PathFollower().step(pose(0.0, 0.0), (), 0).done
    assert PathFollower().step(pose(0.0, 0.0), PATH, 2).done


def test_the_distance_left_runs_along_the_waypoints():
    corner = (*PATH, Waypoint(x=4.0, y=3.0))
    assert PathFollower().step(pose(1.0, 0.0), corner, 1).distance_left == pytest.approx(6.0)
