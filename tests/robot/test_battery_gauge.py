"""What the battery's cut-off sees: the voltage at rest, without a step's sag and without a moment's dip."""

from __future__ import annotations

from math import isnan, nan

import pytest

from robot_agent.battery_gauge import RESISTANCE, TIME_CONSTANT, BatteryGauge


def test_the_sag_of_a_current_is_not_an_empty_battery():
    gauge = BatteryGauge()
    for tick in range(1000):
        current = 2.0 + 20.0 * (tick % 2)
        rest = gauge.step(25.9 - RESISTANCE * current, current, tick * 10_000_000)
    assert rest == pytest.approx(25.9)


def test_a_moment_hardly_counts_and_a_lasting_fall_does():
    gauge = BatteryGauge()
    gauge.step(25.9, 0.0, 0)
    assert gauge.step(22.0, 0.0, 10_000_000) == pytest.approx(25.9 - 3.9 * 0.01 / TIME_CONSTANT, abs=1e-3)
    after = gauge.step(22.0, 0.0, 10_000_000 + round(TIME_CONSTANT * 1e9))
    assert after == pytest.approx(22.0 + 3.9 / 2.718, abs=0.02)


def test_nothing_is_known_before_the_first_reading_and_the_last_one_stays():
    gauge = BatteryGauge()
    assert isnan(gauge.step(nan, 3.0, 0))
    assert gauge.step(25.0, 0.0, 10_000_000) == 25.0
    assert gauge.step(nan, nan, 20_000_000) == 25.0
    assert gauge.step(20.0, nan, 30_000_000) == 25.0
