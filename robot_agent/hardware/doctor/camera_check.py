"""The stereo cameras: whether pairs come at their rate, whole, and at even times."""

from __future__ import annotations

import numpy as np

from robot_agent.hardware.cameras.source import StereoSource
from robot_agent.hardware.doctor.finding import Finding, Verdict
from weaver_shared.clock import Clock

CHECK = "cameras"
WAIT = 0.2  # s
RATE_ERROR = 0.02
MOST_LOST = 0.02
MOST_UNEVEN_MS = 2.0
"""By which 95 of 100 steps between stamps may differ from the usual one."""
BINS = 12


def judge_cameras(source: StereoSource, rate: float | None, clock: Clock, seconds: float) -> Finding:
    """Watch for so long; `rate` is what they are set to, Hz, if anything."""
    stamps, end_ns = [], clock.now_ns() + round(seconds * 1e9)
    while clock.now_ns() < end_ns:
        if (frame := source.read(WAIT)) is not None:
            stamps.append(frame.stamp_ns)
    health = source.health()
    if len(stamps) < 3:
        return Finding(
            check=CHECK,
            verdict=Verdict.WRONG,
            found=f"{len(stamps)} pairs in {seconds:g} s; {health.trouble or 'nothing is said to be wrong'}",
            fix="check power, cables and serial numbers, and the trigger's wire from the first camera to the second",
            figures={"pairs": len(stamps), "lost": health.lost},
        )
    steps = np.diff(stamps) * 1e-6
    usual = float(np.median(steps))
    uneven = float(np.percentile(np.abs(steps - usual), 95))
    fixes = []
    if rate is not None and abs(usual * rate * 1e-3 - 1.0) > RATE_ERROR:
        fixes.append(f"they are set to {rate:g} Hz: shorten the exposure, or divide the link between the two")
    if health.lost > MOST_LOST * 2 * len(stamps):
        fixes.append("pictures are lost: check the cables, and the memory for USB (usbfs_memory_mb)")
    if uneven > MOST_UNEVEN_MS:
        fixes.append("stamps are uneven: the second camera does not follow the first, or the computer is too busy")
    counts, edges = np.histogram(steps, BINS)
    return Finding(
        check=CHECK,
        verdict=Verdict.WRONG if fixes else Verdict.GOOD,
        found=f"{1e3 / usual:.1f} pairs a second, {health.lost} pictures lost, stamps even to {uneven:.2f} ms",
        fix="; ".join(fixes),
        figures={
            "pairs": len(stamps),
            "lost": health.lost,
            "step_ms": round(usual, 3),
            "uneven_ms": round(uneven, 3),
            "histogram": [
                {"from_ms": round(float(edge), 3), "cycles": int(count)}
                for edge, count in zip(edges, counts, strict=False)
                if count
            ],
        },
    )
