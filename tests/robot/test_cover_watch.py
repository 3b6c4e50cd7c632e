"""Grass is told once when the feet sink through it, and once when they stand on bare ground again."""

import numpy as np

from robot_agent.cover_watch import CoverWatch
from robot_agent.mapping import Cover
from weaver_shared.messages import Severity


def cover(height: float, spread: float = 0.005) -> Cover:
    return Cover(height=height, spread=spread, footholds=20)


def test_grass_is_told_when_it_begins_and_when_it_ends() -> None:
    watch = CoverWatch()
    told = [watch.step(cover(height), k) for k, height in enumerate([0.004, 0.03, 0.035, 0.02, 0.026, 0.01, 0.005])]
    said = [event for event in told if event is not None]
    assert [event.stamp_ns for event in said] == [1, 5]
    assert "30 mm below" in said[0].text
    assert "grass" in said[0].text
    assert [event.severity for event in said] == [Severity.WARNING, Severity.INFO]


def test_a_map_that_lies_too_low_is_no_grass() -> None:
    event = CoverWatch().step(cover(-0.04), 7)
    assert event is not None
    assert "40 mm above" in event.text
    assert "grass" not in event.text


def test_few_or_scattered_footholds_say_nothing() -> None:
    watch = CoverWatch()
    assert watch.step(Cover(height=np.nan, spread=np.nan, footholds=3), 0) is None
    assert watch.step(cover(0.03, spread=0.05), 0) is None
