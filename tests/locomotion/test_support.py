"""Weight sharing, ground plane, posture and stability: plain statics."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.kinematics import LegModel, all_leg_frames
from robot_agent.locomotion.feet import carry
from robot_agent.locomotion.ground_plane import fit_plane
from robot_agent.locomotion.load import share_load
from robot_agent.locomotion.posture import attitude_rate, height_rate, support_shift, wanted_up
from robot_agent.locomotion.stability import centre_of_mass, static_margin
from weaver_shared.robots import load_robot

ROBOT = load_robot("weaver")
FEET = ROBOT.stance_in_body
UP = np.array([0.0, 0.0, 1.0])
CENTRE = np.array([0.01, -0.005, 0.02])
shares = st.lists(st.floats(0.2, 1.0), min_size=6, max_size=6)


def up_of(roll, pitch):
    up = np.array([-np.sin(pitch), np.sin(roll) * np.cos(pitch), np.cos(roll) * np.cos(pitch)])
    return up / np.linalg.norm(up)


@given(shares, st.floats(-0.2, 0.2), st.floats(-0.2, 0.2))
def test_shared_loads_balance_weight_and_moments(share, roll, pitch):
    load, up = np.zeros(6), up_of(roll, pitch)
    share_load(FEET, CENTRE, up, np.array(share), 101.0, load)
    assert load.sum() == pytest.approx(101.0)
    if (load > 0.0).all():
        moment = np.cross(FEET - CENTRE, load[:, None] * up).sum(axis=0)
        np.testing.assert_allclose(moment, 0.0, atol=0.02)


def test_three_feet_carry_what_statics_says():
    share, load = np.array([1.0, 0.0, 1.0, 0.0, 1.0, 0.0]), np.zeros(6)
    share_load(FEET, np.zeros(3), UP, share, 101.0, load)
    matrix = np.array([[1.0, 1.0, 1.0], FEET[[0, 2, 4], 0], FEET[[0, 2, 4], 1]])
    np.testing.assert_allclose(load[[0, 2, 4]], np.linalg.solve(matrix, [101.0, 0.0, 0.0]), rtol=1e-3)
    assert not load[[1, 3, 5]].any()


def test_nobody_on_the_ground_carries_nothing():
    load = np.ones(6)
    share_load(FEET, CENTRE, UP, np.zeros(6), 101.0, load)
    assert not load.any()


@given(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_the_plane_of_feet_on_a_plane_is_that_plane(a, b, c):
    feet, plane = FEET.copy(), np.zeros(3)
    feet[:, 2] = a * feet[:, 0] + b * feet[:, 1] + c
    residual = fit_plane(feet, np.ones(6), plane)
    np.testing.assert_allclose(plane, [a, b, c], atol=1e-9)
    assert residual == pytest.approx(0.0, abs=1e-9)


def test_feet_on_a_line_make_a_level_plane():
    feet, plane = np.zeros((3, 3)), np.zeros(3)
    feet[:, 0] = [0.0, 0.1, 0.2]
    feet[:, 2] = [-0.1, -0.15, -0.2]
    fit_plane(feet, np.ones(3), plane)
    np.testing.assert_allclose(plane, [0.0, 0.0, -0.15], atol=1e-12)


def test_the_posture_turns_the_body_towards_the_wanted_direction():
    wanted, rate = np.zeros(3), np.zeros(2)
    wanted_up(up_of(0.2, 0.0), np.zeros(3), 0.0, wanted)
    attitude_rate(wanted, 2.0, 1.0, 0.0, rate)
    assert rate[0] < 0.0  # rolled to the right by 0.2: roll back
    assert rate[1] == pytest.approx(0.0)
    wanted_up(UP, np.array([0.3, 0.0, -0.15]), 1.0, wanted)
    attitude_rate(wanted, 2.0, 1.0, 0.0, rate)
    assert rate[1] < 0.0  # the ground rises ahead: nose up


@given(st.floats(-0.1, 0.1))
def test_height_errors_die_out_at_a_bounded_speed(error):
    plane = np.array([0.0, 0.0, -0.15 + error])
    for _ in range(1000):
        speed = height_rate(plane, 0.15, 2.0, 0.06, 0.001)
        assert abs(speed) <= 0.06
        plane[2] -= speed * 0.01
    assert plane[2] == pytest.approx(-0.15, abs=0.0011)


@given(st.floats(-0.25, 0.25), st.floats(-0.25, 0.25))
def test_the_shift_puts_the_mass_over_the_middle_of_the_feet(roll, pitch):
    shift, up = np.zeros(2), up_of(roll, pitch)
    support_shift(up, 0.17, 1.0, 1.0, shift)
    below = -up * 0.17 / up[2]  # where the mass, 0.17 m over the feet, is seen along gravity
    np.testing.assert_allclose(shift, below[:2], atol=1e-12)


def test_the_margin_is_the_distance_to_the_nearest_edge():
    square = np.array([[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]])
    all_down = np.ones(4, dtype=bool)
    assert static_margin(square, all_down, np.array([0.3, 0.0, 1.0]), UP) == pytest.approx(0.7)
    assert static_margin(square, all_down, np.array([1.5, 0.0, 1.0]), UP) < 0.0
    tilted = up_of(0.0, 0.3)
    assert static_margin(square, all_down, np.array([0.0, 0.0, 1.0]), tilted) == pytest.approx(1.0 - np.tan(0.3))
    assert static_margin(square, np.array([True, True, False, False]), np.zeros(3), UP) < 0.0
    assert static_margin(square, np.zeros(4, dtype=bool), np.zeros(3), UP) < 0.0


def test_the_centre_of_mass_is_that_of_all_parts():
    model = LegModel.of_robot(ROBOT)
    origins, axes, centre = np.zeros((6, 6, 3)), np.zeros((6, 5, 3)), np.zeros(3)
    all_leg_frames(model.dh, model.hips, model.hip_axes, np.zeros((6, 5)), origins, axes)
    trunk = np.array(ROBOT.body.centre_of_mass_in_body)
    centre_of_mass(origins, model.link_mass, ROBOT.body.mass, trunk, centre)
    middles = 0.5 * (origins[:, :-1] + origins[:, 1:])
    expected = ROBOT.body.mass * trunk + (model.link_mass[:, None] * middles).sum(axis=(0, 1))
    np.testing.assert_allclose(centre, expected / (ROBOT.body.mass + 6 * model.link_mass.sum()), atol=1e-12)


@given(st.lists(st.floats(-0.5, 0.5), min_size=3, max_size=3), st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3))
def test_feet_carried_by_a_turning_body_keep_their_distances(linear, angular):
    feet = FEET.copy()
    for _ in range(100):
        carry(feet, np.array(linear), np.array(angular), 0.01)
    for a in range(6):
        for b in range(a):
            before = np.linalg.norm(FEET[a] - FEET[b])
            assert np.linalg.norm(feet[a] - feet[b]) == pytest.approx(before, abs=1e-12)
