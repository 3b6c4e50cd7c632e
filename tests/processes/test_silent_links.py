"""A network that falls silent while the robot walks: it is still in time, and the page is told on return."""

import asyncio
from concurrent.futures import ThreadPoolExecutor

import pytest

pytest.importorskip("pybullet")

from weaver_console.measuring.bench_links import STILL_WITHIN, measure

CASES = ["network dropped between page and console", "network dropped between console and robot"]


@pytest.mark.realtime
def test_a_robot_that_can_not_be_reached_any_more_is_still_in_time() -> None:
    with ThreadPoolExecutor(1) as own_thread:  # browsers of other tests have a loop in this one
        figures = own_thread.submit(lambda: asyncio.run(measure(CASES, ["cruise"]))).result()
    for case, drives in figures["cases"].items():
        one = drives["cruise"]
        assert one["ordered_s"] < one["still_s"] <= STILL_WITHIN, case
        assert one["mode"] == "HOLD"
        assert one["refused"] == "nobody is in control; take control first"
        assert "silent" in one["told"] or "is lost" in one["told"]
