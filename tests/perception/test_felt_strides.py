"""What repeats from stride to stride says nothing of the ground; what changes does."""

import numpy as np
import pytest

from robot_agent.perception.felt_strides import StrideChanges

LEGS = 6
FIRST, SECOND = np.array([0, 2, 4]), np.array([1, 3, 5])


def walk(changes, strides, load, tilt):
    """A tripod gait of five looks a stance; `load(stride, leg)` in N, `tilt(stride, look)` (2,) in rad."""
    for stride in range(strides):
        for half, feet in enumerate((FIRST, SECOND)):
            for look in range(5):
                loads = np.full(LEGS, np.nan)
                loads[feet] = [load(stride, leg) for leg in feet]
                changes.step(loads, np.asarray(tilt(stride, 5 * half + look)))
    return changes


def uneven_gait(_stride, leg):
    return 10.0 + 4.0 * leg


def rocking(_stride, look):
    return 0.02 * np.sin(0.6 * look), 0.01 * np.cos(0.6 * look)


def test_loads_and_tilt_that_repeat_are_the_gait():
    changes = walk(StrideChanges(LEGS, 2), 6, uneven_gait, rocking)
    assert changes.load_change == pytest.approx(0.0)
    assert changes.tilt_change == pytest.approx(0.0)


def test_a_leg_that_bears_more_and_less_tells_uneven_ground():
    changes = walk(StrideChanges(LEGS, 2), 6, lambda stride, leg: 20.0 + 3.0 * (-1) ** (stride + leg), rocking)
    assert changes.load_change == pytest.approx(6.0)
    assert changes.tilt_change == pytest.approx(0.0)


def test_a_body_that_leans_anew_with_every_stride_tells_uneven_ground():
    def leaning(stride, look):
        return np.array(rocking(stride, look)) + 0.03 * (-1) ** stride

    changes = walk(StrideChanges(LEGS, 2), 6, uneven_gait, leaning)
    assert changes.tilt_change == pytest.approx(0.06, rel=0.01)  # both axes by 0.06, over the square root of two


def test_a_constant_slope_is_no_roughness():
    changes = walk(StrideChanges(LEGS, 2), 6, uneven_gait, lambda stride, look: np.array(rocking(stride, look)) + 0.2)
    assert changes.tilt_change == pytest.approx(0.0)


def test_nothing_is_said_before_there_is_something_to_compare():
    changes = StrideChanges(LEGS, 2)
    assert np.isnan([changes.load_change, changes.tilt_change]).all()
    walk(changes, 1, uneven_gait, rocking)
    assert np.isnan([changes.load_change, changes.tilt_change]).all()
    walk(changes, 2, uneven_gait, rocking)
    assert np.isnan(changes.load_change)  # still gathering way
    standing = StrideChanges(LEGS, 2)
    for _ in range(100):
        standing.step(np.full(LEGS, 17.0), np.zeros(2))
    assert np.isnan([standing.load_change, standing.tilt_change]).all()


def test_old_strides_are_forgotten():
    changes = walk(StrideChanges(LEGS, 2), 4, lambda stride, leg: 20.0 + 5.0 * (-1) ** stride, rocking)
    walk(changes, 4, uneven_gait, rocking)
    assert changes.load_change == pytest.approx(0.0)


def test_setting_off_and_stopping_tell_nothing_of_the_ground():
    """Standing, all feet share the load; walking, three of them bear it."""
    changes = StrideChanges(LEGS, 2)
    for _ in range(3):
        for _ in range(30):
            changes.step(np.full(LEGS, 17.0), np.zeros(2))
        walk(changes, 4, lambda stride, leg: 33.0, lambda stride, look: (0.0, 0.01))
    assert changes.load_change == pytest.approx(0.0)
    assert changes.tilt_change == pytest.approx(0.0)
