"""Loops keep their period on the clock they are given, count what they miss and never bunch up."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from weaver_shared.clock import MonotonicClock, SimulatedClock
from weaver_shared.rate import RateKeeper


def test_simulated_time_moves_only_when_told_to() -> None:
    clock = SimulatedClock(start_ns=5)
    assert clock.now_ns() == clock.now_ns() == 5
    clock.forward(seconds=1.5, nanoseconds=2)
    assert clock.now_ns() == 1_500_000_007
    clock.sleep_until(3)
    assert clock.now_ns() == 1_500_000_007
    clock.sleep_until(2_000_000_000)
    assert clock.now_ns() == 2_000_000_000


def test_time_does_not_run_backwards() -> None:
    with pytest.raises(ValueError, match="backwards"):
        SimulatedClock().forward(seconds=-1e-3)


def test_the_monotonic_clock_reaches_what_it_sleeps_for() -> None:
    clock = MonotonicClock()
    wanted = clock.now_ns() + 1_000_000
    clock.sleep_until(wanted)
    assert clock.now_ns() >= wanted
    clock.sleep_until(wanted)  # already past: returns at once


def test_a_punctual_loop_has_no_errors_and_no_overruns() -> None:
    clock = SimulatedClock()
    keeper = RateKeeper(clock=clock, rate=100.0)
    assert [keeper.wait() for _ in range(5)] == [10_000_000 * n for n in range(1, 6)]
    report = keeper.report()
    assert report.rate == pytest.approx(100.0)
    assert (report.period_error_median, report.period_error_p99, report.overruns) == (0.0, 0.0, 0)


def test_a_late_step_is_counted_and_the_schedule_caught_up() -> None:
    clock = SimulatedClock()
    keeper = RateKeeper(clock=clock, rate=100.0)
    keeper.wait()
    clock.forward(seconds=0.035)
    assert keeper.wait() == 45_000_000  # at once, late
    assert keeper.wait() == 50_000_000  # back on the grid; the missed ones are not made up
    assert keeper.wait() == 60_000_000
    assert keeper.report().overruns == 1


@given(works=st.lists(st.floats(0.0, 0.05), min_size=1, max_size=30))
def test_whatever_the_load_wake_ups_are_apart_and_on_the_grid(works: list[float]) -> None:
    clock = SimulatedClock()
    keeper = RateKeeper(clock=clock, rate=100.0)
    missed = 0
    for work in works:
        deadline = (clock.now_ns() // 10_000_000 + 1) * 10_000_000
        clock.forward(seconds=work)
        missed += clock.now_ns() > deadline
        woke = keeper.wait()
        assert woke % 10_000_000 == 0 or woke > deadline
    assert keeper.report().overruns == missed


def test_a_report_begins_afresh() -> None:
    clock = SimulatedClock()
    keeper = RateKeeper(clock=clock, rate=10.0)
    clock.forward(seconds=0.5)
    keeper.wait()
    assert keeper.report().overruns == 1
    assert keeper.report().overruns == 0
    assert keeper.report().rate == 0.0


@pytest.mark.parametrize("rate", [0.0, -1.0, float("nan")])
def test_a_loop_needs_a_rate(rate: float) -> None:
    with pytest.raises(ValueError, match="above 0 Hz"):
        RateKeeper(clock=SimulatedClock(), rate=rate)
