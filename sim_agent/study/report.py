"""The study's results as a Markdown table."""

from __future__ import annotations

from collections.abc import Iterable

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
    lines = [_row(HEADER), _row(["---"] * len(HEADER))]
    lines += [_row(_cells(result)) for result in results]
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
        _number(result.static_margin_mm, 0),
        _number(result.energy_margin_mm, 1),
        f"{result.largest_tilt_deg:.1f}",
        f"{result.torque_share:.2f}",
        _word(result.stood),
        _word(result.fell),
        _sat(result),
        f"{result.real_time_factor:.1f}",
        "" if result.passed else "**failed**",
    ]


def _sat(result: Result) -> str:
    if not result.sat:
        return _word(result.sat)
    return "on its belly" if result.belly_on_ground else "on its legs"


def _word(value: bool | None) -> str:
    return "–" if value is None else "yes" if value else "no"


def _number(value: float | None, digits: int) -> str:
    return "–" if value is None else f"{value:.{digits}f}"


def _row(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"
