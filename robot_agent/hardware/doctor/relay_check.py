"""The motors' relay: whether the power monitor opens it, and the servos lose their power and get it back."""

from __future__ import annotations

from collections.abc import Mapping

from robot_agent.hardware.doctor.bus_scan import ask_everybody
from robot_agent.hardware.doctor.finding import Finding, Verdict
from robot_agent.hardware.power_monitor import PowerMonitor
from robot_agent.hardware.servos.port import LineClock, ServoPort

CHECK = "motor relay"
SWITCHING_NS = 1_500_000_000
"""For capacitors to empty, and for servos to start."""
POLL_NS = 20_000_000


def judge_relay(monitor: PowerMonitor, ports: Mapping[str, ServoPort], clock: LineClock, margin: float) -> Finding:
    """Open it, look who still answers, close it again, and look who is back. The robot has to lie on its belly."""
    before = _answering(ports, clock, margin)
    opened, silent = True, 0
    try:
        opened = _switched(monitor, clock, closed=False)
        silent = before - _answering(ports, clock, margin)
    finally:
        closed = _switched(monitor, clock, closed=True)
    back = _answering(ports, clock, margin)
    fixes = []
    if not opened or not closed:
        fixes.append("the monitor does not say that it switched: check that its sketch is the one shipped here")
    elif silent < before:
        fixes.append("servos keep their power: check that the relay lies in the motors' supply, and its wire to pin 7")
    elif back < before:
        fixes.append("not all servos came back: check the supply behind the relay")
    return Finding(
        check=CHECK,
        verdict=Verdict.WRONG if fixes else Verdict.GOOD,
        found=f"of {before} servos {silent} lost their power when it opened, {back} answer when it is closed again",
        fix="; ".join(fixes),
        figures={"before": before, "silent": silent, "back": back},
    )


def _answering(ports: Mapping[str, ServoPort], clock: LineClock, margin: float) -> int:
    return sum(len(answers.servos) for answers in ask_everybody(ports, clock, margin).values())


def _switched(monitor: PowerMonitor, clock: LineClock, *, closed: bool) -> bool:
    """Whether the monitor says so in the end; returns when servos have had their time."""
    monitor.switch_relay(closed=closed)
    end_ns = clock.now_ns() + SWITCHING_NS
    while clock.now_ns() < end_ns:
        clock.sleep_until(clock.now_ns() + POLL_NS)
        monitor.take(clock.now_ns())
    return monitor.relay_closed is closed
