"""A loop's own report says its true rate, however often it is asked."""

import pytest

from robot_agent import timing


class Wall:
    def __init__(self) -> None:
        self.now = 100.0

    def monotonic(self) -> float:
        return self.now

    def process_time(self) -> float:
        return 0.25 * self.now


@pytest.mark.parametrize("turns", [2, 5, 50])
def test_the_rate_is_that_of_the_turns_and_not_of_the_fences_between(
    monkeypatch: pytest.MonkeyPatch, turns: int
) -> None:
    wall = Wall()
    monkeypatch.setattr(timing, "time", wall)
    meter = timing.LoopMeter("vision", 10.0)
    reports = []
    for turn in range(4 * turns + 1):
        meter.woke(turn * 100_000_000)
        if turn % turns == 0 and turn > 0:
            reports.append(meter.report(turn * 100_000_000))
        wall.now += 0.1
    assert [report.rate for report in reports] == pytest.approx([10.0] * 4)
    assert [report.real_time_factor for report in reports] == pytest.approx([1.0] * 4)
    assert [report.cpu_fraction for report in reports[1:]] == pytest.approx([0.25] * 3)
    assert all(report.overruns == 0 for report in reports)
