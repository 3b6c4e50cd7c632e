"""Swing curves: apex exact, ends at the ground's own velocity, one smooth path."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.locomotion.bezier import quartic, quartic_derivative
from robot_agent.locomotion.stride import foot_velocity, stride_of, swing_nodes, swing_point

UP = np.array([0.0, 0.0, 1.0])
HALF_TIME = 0.25
small = st.floats(-0.1, 0.1)


def curves(lift_off, foothold, height, ground, touchdown=0.0, up=UP, along_up=False, outward=(0.0, 0.0, 0.0)):
    first, second = np.zeros((5, 3)), np.zeros((5, 3))
    swing_nodes(
        np.array(lift_off, dtype=float), np.array(foothold, dtype=float), up, height, np.array(ground, dtype=float),
        touchdown, HALF_TIME, along_up, np.array(outward), first, second,
    )  # fmt: skip
    return first, second


def path(first, second, n=401):
    points = np.zeros((n, 3))
    for i, progress in enumerate(np.linspace(0.0, 1.0, n)):
        swing_point(progress, first, second, points[i])
    return points


@given(st.lists(small, min_size=3, max_size=3), st.lists(small, min_size=3, max_size=3), st.floats(0.02, 0.14), small)
def test_the_apex_is_exactly_the_asked_height_above_the_higher_end(lift_off, foothold, height, speed):
    points = path(*curves(lift_off, foothold, height, [speed, 0.0, 0.0]))
    higher = max(lift_off[2], foothold[2])
    assert points[200, 2] == pytest.approx(higher + height, abs=1e-12)
    assert points[:, 2].max() == pytest.approx(higher + height, abs=1e-9)
    np.testing.assert_allclose(points[0], lift_off, atol=1e-12)
    np.testing.assert_allclose(points[-1], foothold, atol=1e-12)


def test_the_apex_is_measured_along_gravity_on_a_tilted_body():
    up = np.array([0.17, 0.05, 0.0])
    up[2] = np.sqrt(1.0 - up @ up)
    points = path(*curves([0.2, 0.1, -0.15], [0.3, 0.1, -0.13], 0.06, [-0.1, 0.0, 0.0], up=up))
    heights = points @ up
    assert heights.max() == pytest.approx(max(heights[0], heights[-1]) + 0.06, abs=1e-9)


def test_a_foot_leaves_and_meets_the_ground_at_the_grounds_velocity():
    ground = np.array([-0.2, 0.05, 0.0])
    first, second = curves([0.2, -0.3, -0.15], [0.35, -0.3, -0.15], 0.05, ground, touchdown=0.08)
    slope = np.zeros(3)
    quartic_derivative(first, 0.0, slope)
    np.testing.assert_allclose(slope / HALF_TIME, ground, atol=1e-12)
    quartic_derivative(second, 1.0, slope)
    np.testing.assert_allclose(slope / HALF_TIME, ground - 0.08 * UP, atol=1e-12)


@given(st.lists(small, min_size=3, max_size=3), st.lists(small, min_size=3, max_size=3), small)
def test_velocity_does_not_jump_at_the_apex(lift_off, foothold, speed):
    first, second = curves(lift_off, foothold, 0.05, [speed, 0.0, 0.0], touchdown=0.05)
    before, after = np.zeros(3), np.zeros(3)
    quartic_derivative(first, 1.0, before)
    quartic_derivative(second, 0.0, after)
    np.testing.assert_allclose(before, after, atol=1e-12)


normal = st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3)).map(
    lambda slopes: np.array([-slopes[0], -slopes[1], 1.0]) / np.sqrt(1.0 + slopes[0] ** 2 + slopes[1] ** 2)
)


@given(normal, st.lists(small, min_size=2, max_size=2))
def test_a_foot_comes_down_along_the_normal_as_seen_from_the_ground(up, velocity):
    ground = np.array([*velocity, 0.0])
    ground -= (ground @ up) * up
    lift_off, foothold = np.array([0.2, 0.1, -0.15]), np.array([0.3, 0.12, -0.13])
    points = path(*curves(lift_off, foothold, 0.06, ground, touchdown=0.05, up=up, along_up=True))
    left = 2.0 * HALF_TIME * (1.0 - np.linspace(0.0, 1.0, 401))[200:, None]
    over_foothold = points[200:] - (foothold - left * ground)
    aside = over_foothold - (over_foothold @ up)[:, None] * up
    np.testing.assert_allclose(aside, 0.0, atol=1e-12)
    heights = points @ up
    assert heights.max() == pytest.approx(max(heights[0], heights[-1]) + 0.06, abs=1e-9)
    np.testing.assert_allclose(points[[0, -1]], [lift_off, foothold], atol=1e-12)


@given(small, st.booleans())
def test_a_swing_bulges_by_its_width_at_the_apex_and_nowhere_more(width, along_up):
    places = ([0.2, -0.3, -0.15], [0.35, -0.3, -0.15])
    first, second = curves(*places, 0.05, [-0.1, 0.0, 0.0], outward=(0.0, width, 0.0), along_up=along_up)
    points = path(first, second)
    assert points[200, 1] + 0.3 == pytest.approx(width, abs=1e-12)
    assert np.abs(points[:, 1] + 0.3).max() == pytest.approx(abs(width), abs=1e-9)
    np.testing.assert_allclose(points[[0, -1], 1], -0.3, atol=1e-12)
    before, after = np.zeros(3), np.zeros(3)
    quartic_derivative(first, 1.0, before)
    quartic_derivative(second, 0.0, after)
    np.testing.assert_allclose(before, after, atol=1e-12)


@given(st.lists(st.lists(small, min_size=3, max_size=3), min_size=5, max_size=5), st.floats(0.01, 0.99))
def test_the_derivative_is_that_of_the_curve(nodes, t):
    nodes, slope, before, after = np.array(nodes), np.zeros(3), np.zeros(3), np.zeros(3)
    quartic_derivative(nodes, t, slope)
    quartic(nodes, t + 1e-6, after)
    quartic(nodes, t - 1e-6, before)
    np.testing.assert_allclose(slope, (after - before) / 2e-6, atol=1e-7)


def test_equally_spaced_nodes_make_a_stance_of_constant_speed():
    stride = np.array([0.18, 0.02, 0.0])
    nodes = -np.arange(5)[:, None] * stride / 4.0
    slope = np.zeros(3)
    for t in np.linspace(0.0, 1.0, 11):
        quartic_derivative(nodes, t, slope)
        np.testing.assert_allclose(slope, -stride, atol=1e-12)


def test_the_stride_is_equation_16():
    stride, foot = np.zeros(3), np.array([0.3, -0.3, -0.15])
    stride_of(np.array([0.35, 0.0, 0.0]), foot, 0.5, 1.0, stride)
    np.testing.assert_allclose(stride, [0.175, 0.0, 0.0])
    stride_of(np.array([0.0, 0.0, 0.4]), foot, 0.5, 1.0, stride)
    np.testing.assert_allclose(stride, 0.2 * np.array([0.3, 0.3, 0.0]))


def test_a_standing_foot_moves_against_the_body():
    velocity = np.zeros(3)
    foot_velocity(np.array([0.1, -0.05, 0.2]), np.array([0.3, 0.2, -0.15]), velocity)
    np.testing.assert_allclose(velocity, [-0.1 + 0.04, 0.05 - 0.06, 0.0])
