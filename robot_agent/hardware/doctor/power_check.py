"""The power monitor: whether it speaks, loses lines, and what battery it sees."""

from __future__ import annotations

import numpy as np

from robot_agent.hardware.doctor.finding import Finding, Verdict
from robot_agent.hardware.power_monitor import RATE, PowerMonitor
from weaver_shared.clock import Clock
from weaver_shared.config.safety import SafetyLimits

CHECK = "power monitor"
POLL_NS = 5_000_000
LEAST_SHARE = 0.9
"""Of the lines that should have come."""
MOST_LOST = 0.05


def judge_power(monitor: PowerMonitor, limits: SafetyLimits, clock: Clock, seconds: float) -> Finding:
    """Listen for so long."""
    readings, end_ns = [], clock.now_ns() + round(seconds * 1e9)
    while clock.now_ns() < end_ns:
        clock.sleep_until(clock.now_ns() + POLL_NS)
        if (reading := monitor.take(clock.now_ns())) is not None:
            readings.append(reading)
    if not readings:
        return Finding(
            check=CHECK,
            verdict=Verdict.WRONG,
            found=f"nothing to read in {seconds:g} s",
            fix="check its cable and port, that the sketch is on it, and SDA and SCL between it and the sensor",
            figures={"readings": 0},
        )
    rate = len(readings) / seconds
    volts = np.array([reading.voltage for reading in readings])
    amperes = float(np.mean([reading.current for reading in readings]))
    voltage = float(np.median(volts))
    fixes = []
    if rate < LEAST_SHARE * RATE or monitor.lost > MOST_LOST * len(readings):
        fixes.append("lines are lost: check cable and ground between it and the computer")
    if voltage < limits.battery_warn:
        fixes.append("charge the battery")
    if amperes < 0.0:
        fixes.append("current flows backwards: turn the shunt round")
    return Finding(
        check=CHECK,
        verdict=Verdict.WRONG if fixes else Verdict.GOOD,
        found=f"{rate:.0f} readings a second, {monitor.lost} lines lost, battery {voltage:.2f} V, {amperes:.2f} A",
        fix="; ".join(fixes),
        figures={
            "rate_hz": round(rate, 1),
            "lost": monitor.lost,
            "battery_v": round(voltage, 3),
            "current_a": round(amperes, 3),
        },
    )
