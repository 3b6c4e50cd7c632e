"""The time of an emulated robot, as another process reads it while it is being written."""

from __future__ import annotations

import multiprocessing
from pathlib import Path

from robot_agent.hardware.emulated_clock import EmulatedClock
from sim_agent.twin.twin_time import TwinTime

TICK_NS = 10_000_000
TICKS = 30_000


def hurry(path: Path) -> None:
    """Ticks as fast as they go."""
    time = TwinTime(path)
    for tick in range(1, TICKS):
        time.tick(time.begun_ns + tick * TICK_NS)


def test_time_never_jumps_for_who_reads_while_it_is_written(tmp_path: Path) -> None:
    path = tmp_path / "time"
    begun_ns = TwinTime(path).begun_ns
    clock = EmulatedClock(path)
    writer = multiprocessing.get_context("spawn").Process(target=hurry, args=(path,))
    writer.start()
    last_ns = clock.now_ns()
    end_ns = begun_ns + TICKS * TICK_NS
    while last_ns < end_ns and writer.exitcode is None:
        now_ns = clock.now_ns()
        # Between two ticks it goes on by itself, at most to the next one.
        assert last_ns - TICK_NS <= now_ns <= end_ns + TICK_NS
        last_ns = now_ns
    writer.join()
    assert writer.exitcode == 0


def test_an_emulator_goes_on_from_where_one_before_it_ended(tmp_path: Path) -> None:
    path = tmp_path / "time"
    first = TwinTime(path)
    first.tick(first.begun_ns + 5 * TICK_NS)
    assert TwinTime(path).begun_ns == first.begun_ns + 6 * TICK_NS
