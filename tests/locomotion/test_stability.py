"""Margins of stability against cases worked out by hand, and what they lead to."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.locomotion.energy_margin import energy_margin, tipping_height
from robot_agent.locomotion.stability import static_margin
from robot_agent.locomotion.stability_watch import StabilityWatch, is_static
from weaver_shared.config.locomotion import StabilityConfig
from weaver_shared.robots import load_robot
from weaver_shared.robots.gaits import Gait, predefined_gaits
from weaver_shared.transforms import rotation_from_rpy

UP = np.array([0.0, 0.0, 1.0])
SQUARE = np.array([[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]])
ALL = np.ones(4, dtype=bool)
CONFIG = StabilityConfig()
DT = 0.01


def test_on_level_ground_the_height_is_that_of_a_quarter_circle_about_the_edge():
    # The mass 1 m above the middle, 1 m from each edge: it rises from 1 m to sqrt(2) m.
    assert energy_margin(SQUARE, ALL, np.array([0.0, 0.0, 1.0]), UP) == pytest.approx(np.sqrt(2.0) - 1.0, rel=1e-12)
    # 3 m high and 0.5 m from the nearest edge.
    high = np.array([0.5, 0.0, 3.0])
    assert energy_margin(SQUARE, ALL, high, UP) == pytest.approx(np.hypot(0.5, 3.0) - 3.0, rel=1e-12)


def test_a_slope_takes_from_the_edge_below_and_a_lower_mass_gives():
    tilt = 0.3  # the ground falls along x: gravity's up leans back
    up = np.array([-np.sin(tilt), 0.0, np.cos(tilt)])
    # About the lower edge, x = 1: R = (-1, 0, 1), so the height is |R| - R . up.
    expected = np.sqrt(2.0) - (np.sin(tilt) + np.cos(tilt))
    assert energy_margin(SQUARE, ALL, np.array([0.0, 0.0, 1.0]), up) == pytest.approx(expected, rel=1e-9)
    low = energy_margin(SQUARE, ALL, np.array([0.0, 0.0, 0.2]), up)
    assert low > 3.0 * expected


def test_an_edge_that_climbs_is_easier_to_tip_over():
    # psi: the mass turns in a plane leaning by the edge's slope, so what it rises shrinks by cos psi.
    level = tipping_height(np.array([0.0, -1.0, 0.0]), np.array([0.0, 1.0, 0.0]), np.array([-1.0, 0.0, 1.0]), UP)
    slope = rotation_from_rpy(0.4, 0.0, 0.0)
    turned = [slope @ np.array(p) for p in ([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 1.0])]
    assert tipping_height(*turned, UP) == pytest.approx(level * np.cos(0.4), rel=1e-12)


places = st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), st.floats(0.1, 2.0)).map(np.array)
angles = st.floats(-0.5, 0.5)


@given(places, angles, angles)
def test_both_margins_have_the_same_sign(centre, roll, pitch):
    up = rotation_from_rpy(roll, pitch, 0.0).T @ UP
    static, energy = static_margin(SQUARE, ALL, centre, up), energy_margin(SQUARE, ALL, centre, up)
    assert np.isfinite(static)
    assert np.isfinite(energy)
    if abs(static) > 1e-6:
        assert np.sign(static) == np.sign(energy)


@given(places, angles, angles, st.floats(-3.0, 3.0))
def test_the_energy_margin_does_not_depend_on_the_frame_it_is_seen_from(centre, roll, pitch, yaw):
    rotation = rotation_from_rpy(roll, pitch, yaw)
    feet, seen, up = SQUARE @ rotation.T, rotation @ centre, rotation @ UP
    assert energy_margin(feet, ALL, seen, up) == pytest.approx(energy_margin(SQUARE, ALL, centre, UP), abs=1e-9)


def test_without_a_polygon_there_is_no_energy_margin():
    two = np.array([True, True, False, False])
    assert energy_margin(SQUARE, two, np.array([0.0, 0.0, 1.0]), UP) == 0.0
    assert energy_margin(SQUARE, np.zeros(4, dtype=bool), np.zeros(3), UP) == 0.0


def test_weaver_on_level_ground_has_the_height_its_nearest_edge_gives():
    robot = load_robot("weaver")
    feet, centre = robot.stance_in_body, np.zeros(3)
    static = static_margin(feet, np.ones(6, dtype=bool), centre, UP)
    height = -float(feet[0, 2])
    # Feet at one height: every edge has the same rise for the same distance, the nearest gives both margins.
    assert energy_margin(feet, np.ones(6, dtype=bool), centre, UP) == pytest.approx(
        np.hypot(static, height) - height, rel=1e-9
    )


def test_the_level_follows_the_margins_and_comes_back_late():
    watch = StabilityWatch(CONFIG, DT)
    good = (CONFIG.warn_static + CONFIG.recovery_static, CONFIG.warn_energy + CONFIG.recovery_energy)
    for _ in range(100):
        watch.update(*good)
    assert (watch.level, watch.factor, watch.reasons) == ("good", 1.0, ())
    low = (CONFIG.slow_static - 1e-4, good[1])
    watch.update(*low)
    assert watch.level == "good"  # one reading is not enough
    for _ in range(3):
        watch.update(*low)
    assert (watch.level, watch.factor) == ("slow", CONFIG.slow_factor)
    for _ in range(5):
        watch.update(CONFIG.refuse_static - 1e-4, good[1])
    assert (watch.level, watch.factor) == ("refuse", 0.0)
    ticks = 0
    while watch.level != "good":
        watch.update(*good)
        ticks += 1
    assert ticks * DT == pytest.approx(3.0 * CONFIG.hold_time, abs=4 * DT)


def refused(static):
    watch = StabilityWatch(CONFIG, DT)
    for _ in range(5):
        watch.update(static, 1.0)
    assert watch.level == "refuse"
    return watch


def test_a_body_that_rests_may_walk_slowly_though_its_margins_say_that_it_tips_over():
    low, ticks = CONFIG.refuse_static - 0.02, 0
    watch = refused(low)
    while watch.level == "refuse":
        watch.update(low, 1.0, resting=True)
        ticks += 1
        assert ticks < 10_000
    assert watch.level == "slow"
    assert ticks * DT == pytest.approx(CONFIG.rest_time + CONFIG.hold_time, abs=4 * DT)
    for _ in range(100):
        watch.update(low, 1.0)  # walking, and no worse than at rest
    assert watch.level == "slow"
    for _ in range(5):
        watch.update(low - 0.03, 1.0)
    assert watch.level == "refuse"


def test_a_body_that_moves_is_believed_to_tip_over():
    watch = refused(CONFIG.refuse_static - 0.02)
    for _ in range(1000):
        watch.update(CONFIG.refuse_static - 0.02, 1.0)
    assert watch.level == "refuse"
    for _ in range(1000):
        watch.update(float("nan"), 1.0, resting=True)
    assert watch.level == "refuse"


def test_what_margins_lacked_is_forgotten_once_they_are_good():
    low = CONFIG.refuse_static - 0.02
    watch = refused(low)
    for _ in range(round(2.0 * (CONFIG.rest_time + CONFIG.hold_time) / DT)):
        watch.update(low, 1.0, resting=True)
    for _ in range(round(4.0 * CONFIG.hold_time / DT)):
        watch.update(CONFIG.warn_static + CONFIG.recovery_static, 1.0)
    assert watch.idle
    for _ in range(5):
        watch.update(low, 1.0)
    assert watch.level == "refuse"


def test_margins_between_threshold_and_recovery_keep_the_level():
    watch = StabilityWatch(CONFIG, DT)
    for _ in range(10):
        watch.update(CONFIG.slow_static - 1e-3, 1.0)
    for _ in range(1000):
        watch.update(CONFIG.slow_static + 0.5 * CONFIG.recovery_static, 1.0)
    assert watch.level == "slow"


def test_a_margin_that_is_no_number_is_no_margin():
    watch = StabilityWatch(CONFIG, DT)
    for _ in range(5):
        watch.update(float("nan"), 1.0)
    assert watch.level == "refuse"


@given(st.lists(st.tuples(st.floats(-0.1, 0.2), st.floats(-0.01, 0.02)), min_size=1, max_size=200))
def test_the_level_never_changes_twice_within_the_dwell_time(margins):
    watch, changes, before = StabilityWatch(CONFIG, DT), [], "good"
    for tick, pair in enumerate(margins):
        watch.update(*pair)
        if watch.level != before:
            changes.append((tick, before, watch.level))
            before = watch.level
    order = ("good", "warn", "slow", "refuse")
    for (then, _, _), (now, old, new) in pairwise(changes):
        if order.index(new) < order.index(old):
            assert (now - then) * DT >= CONFIG.hold_time - 1e-9


def test_static_gaits_are_told_from_dynamic_ones():
    assert all(
        is_static(gait) for name, gait in predefined_gaits(6).items() if name in ("tripod", "ripple", "amble", "wave")
    )
    assert not is_static(Gait(name="bipod", duty=1.0 / 3.0, offset=(0.0, 1 / 3, 2 / 3, 0.0, 1 / 3, 2 / 3)))
