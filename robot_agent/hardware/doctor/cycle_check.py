"""The cyclic reading of all servos, many times: how long it takes, and how often somebody was not heard."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.doctor.finding import Finding, Verdict, named, not_tested
from robot_agent.hardware.servos.exchange import BusExchange, CyclicExchange
from robot_agent.hardware.servos.port import LineClock, ServoPort
from robot_agent.hardware.wiring import Wiring

LONGEST_MS = 8.0
"""99 of 100 cycles have to be over by then: the goals go out in the rest of the tick of 10 ms."""
MOST_FAILED = 0.01
BIN_MS = 0.5


def judge_cycles(
    wiring: Wiring, ports: Mapping[str, ServoPort], clock: LineClock, ready: NDArray[np.bool_], cycles: int
) -> Finding:
    """Read the servos that are `ready` (joints,) on these buses `cycles` times, one time after the other."""
    check = "cyclic reading"
    if not ready.any():
        return not_tested(check, "no servo is ready")
    buses = [
        BusExchange(
            ports[bus.name],
            [wiring.ids[joint] for joint in wiring.joints_of(bus.name)],
            wiring.joints_of(bus.name),
            baud=bus.baud,
        )
        for bus in wiring.config.buses
        if bus.name in ports
    ]
    # The exchange keeps one array of all joints, also where a bus could not be opened.
    exchange = CyclicExchange(buses, clock, answer_margin=wiring.config.servos.answer_margin, joints=ready.size)
    for bus in buses:
        bus.ask_only(ready[bus.joints])
    taken, missed = np.empty(cycles), np.zeros(ready.size, dtype=np.int64)
    failed = 0
    for cycle in range(cycles):
        begin_ns = clock.now_ns()
        exchange.read()
        taken[cycle] = (clock.now_ns() - begin_ns) * 1e-6
        silent = ready & ~exchange.answered
        missed += silent
        failed += bool(silent.any())
    computed = max(bus.least_duration for bus in buses) * 1e3
    return _judged(check, wiring, taken, failed, missed, computed)


def _judged(
    check: str, wiring: Wiring, taken: NDArray[np.float64], failed: int, missed: NDArray[np.int64], computed: float
) -> Finding:
    median, p99 = np.percentile(taken, [50, 99])
    worst = [int(joint) for joint in np.argsort(-missed, kind="stable")[:4] if missed[joint]]
    unheard = {wiring.robot.joint_names[joint]: int(missed[joint]) for joint in worst}
    too_slow, too_many = p99 > LONGEST_MS, failed > MOST_FAILED * taken.size
    fixes = []
    if too_slow:
        fixes.append(
            "set latency timer (1 ms) and return delay (0), take a higher baud rate or more buses: "
            f"the bytes alone take {computed:.1f} ms"
        )
    if failed:
        fixes.append(
            "check cable and plugs of " + named([f"{name} ({count} misses)" for name, count in unheard.items()])
        )
    edges = np.arange(np.floor(taken.min() / BIN_MS), np.ceil(taken.max() / BIN_MS) + 1.5) * BIN_MS
    counts = np.histogram(taken, edges)[0]
    return Finding(
        check=check,
        verdict=Verdict.WRONG if too_slow or too_many else Verdict.ATTENTION if failed else Verdict.GOOD,
        found=f"{taken.size} cycles: median {median:.2f} ms, p99 {p99:.2f} ms, {failed} failed",
        fix="; ".join(fixes),
        figures={
            "cycles": taken.size,
            "failed": failed,
            "median_ms": round(float(median), 3),
            "p99_ms": round(float(p99), 3),
            "longest_ms": round(float(taken.max()), 3),
            "wire_ms": round(computed, 3),
            "misses": unheard,
            "histogram": [
                {"from_ms": round(float(edge), 3), "cycles": int(count)}
                for edge, count in zip(edges, counts, strict=False)
                if count
            ],
        },
    )
