"""The study's results as a Markdown table, whole."""

from __future__ import annotations

from collections.abc import Iterable

from sim_agent.markdown import number, row, word
from sim_agent.study.result import Result

HEADER = (
    "robot",
    "gait",
    "world",
    "manoeuvre",
    "asked",
    "achieved / asked",
    "static margin, mm",
    "energy margin, mm",
    "tilt, °",
    "torque / limit",
    "stood",
    "fell",
    "sat",
    "× real time",
    "",
)


def table(results: Iterable[Result]) -> str:
    """One row a result; margins are the lowest of the walk, tilt and torque the largest."""
    lines = [row(HEADER), row(["---"] * len(HEADER))]
    lines += [row(_cells(result)) for result in results]
    return "\n".join(lines) + "\n"


def _cells(result: Result) -> list[str]:
    unit = "rad/s" if result.manoeuvre == "turn" else "m/s"
    return [
        result.robot,
        result.gait,
        result.world,
        result.manoeuvre,
        f"{result.asked:.3f} {unit}",
        f"{result.ratio:.2f}",
        number(result.static_margin_mm, 0),
        number(result.energy_margin_mm, 1),
        f"{result.largest_tilt_deg:.1f}",
        f"{result.torque_share:.2f}",
        word(result.stood),
        word(result.fell),
        _sat(result),
        f"{result.real_time_factor:.1f}",
        "" if result.passed else "**failed**",
    ]


def _sat(result: Result) -> str:
    if not result.sat:
        return word(result.sat)
    return "on its belly" if result.belly_on_ground else "on its legs"
