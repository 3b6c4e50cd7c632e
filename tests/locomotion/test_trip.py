"""A foot that strikes something on its way up goes back, up and over it; one that does not keeps to its path."""

import numpy as np
import pytest

from robot_agent.locomotion.trip import CLEAR, FREED, STRUCK, lead_around, notice_trip
from robot_agent.locomotion.walk_state import WalkState, write
from weaver_shared.config.locomotion import LocomotionConfig

DT = 0.01
FOOTHOLD = np.array([0.10, 0.0, -0.15])


@pytest.fixture
def walk():
    state = WalkState(6, 5)
    record = state.record
    write(record["settings"], LocomotionConfig())
    record["model"]["dt"] = DT
    record["model"]["headroom"][:] = 0.12
    record["feet"]["stance"][:, 2] = -0.15
    record["feet"]["lift_off"][0] = [-0.10, 0.0, -0.15]
    record["feet"]["place"][0] = [-0.05, 0.0, -0.13]
    record["senses"]["unposed_feet"][0] = [-0.06, 0.0, -0.13]
    return state.memory[0]


def touch(walk, progress, touches):
    walk["senses"]["contact"][0] = touches
    notice_trip(walk, 0, progress)
    return walk["feet"]["tripped"][0]


def test_only_a_touch_on_the_way_up_is_something_struck(walk):
    assert touch(walk, 0.1, True) == CLEAR  # the foot is still leaving the ground
    assert touch(walk, 0.6, True) == CLEAR  # coming down: that is the ground
    assert touch(walk, 0.3, True) == STRUCK
    assert touch(walk, 0.7, True) == STRUCK  # still along it
    assert touch(walk, 0.72, False) == FREED
    assert touch(walk, 0.75, True) == FREED
    assert touch(walk, 0.3, True) == STRUCK


def test_what_is_never_left_is_taken_for_ground_in_the_end(walk):
    assert touch(walk, 0.3, True) == STRUCK
    assert touch(walk, 0.81, True) == FREED


def test_it_is_drawn_back_from_where_it_is_and_rises_up_to_what_the_leg_can(walk):
    touch(walk, 0.3, True)
    place, heights = walk["feet"]["place"], []
    for k in range(100):
        before = place[0].copy()
        lead_around(walk, 0, np.array([-0.05 + 0.003 * k, 0.0, -0.12]), FOOTHOLD)
        assert np.hypot(*(place[0] - before)[:2]) <= 0.25 * DT + 1e-9
        assert place[0, 2] >= before[2]
        heights.append(place[0, 2])
    assert place[0, 0] == pytest.approx(-0.06 - 0.008, abs=1e-9)
    assert heights[1] - heights[0] == pytest.approx(0.25 * DT)
    assert heights[-1] == pytest.approx(-0.15 + 0.12)


def test_clear_of_it_the_foot_comes_back_to_its_path_without_a_jump(walk):
    touch(walk, 0.3, True)
    for _ in range(20):
        lead_around(walk, 0, np.array([-0.05, 0.0, -0.12]), FOOTHOLD)
    touch(walk, 0.5, False)
    place, path = walk["feet"]["place"], np.array([-0.02, 0.01, -0.10])
    walk["feet"]["detour"][0] = place[0] - path
    for _ in range(200):
        before = place[0].copy()
        lead_around(walk, 0, path, FOOTHOLD)
        assert np.hypot(*(place[0] - before)[:2]) <= 0.25 * DT + 1e-9
        assert abs(place[0, 2] - before[2]) <= 0.08 * DT + 1e-9
    assert place[0] == pytest.approx(path, abs=1e-9)
