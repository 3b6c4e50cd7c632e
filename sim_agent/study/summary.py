"""The study's results in short: a row for each robot and gait on level ground, and one for each climb."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby

from sim_agent.markdown import number, row, word
from sim_agent.study.result import Result

LEVEL = (
    "robot",
    "gait",
    "forward: asked m/s, share walked",
    "sideways",
    "turn: rad/s",
    "lowest static margin, mm",
    "largest tilt, °",
    "fell",
    "sat",
)
CLIMBS = (
    "robot",
    "world",
    "gait",
    "result",
    "asked m/s, share walked",
    "lowest static margin, mm",
    "lowest energy margin, mm",
    "largest tilt, °",
    "largest torque / limit",
    "fell",
)


def summary(results: Iterable[Result]) -> str:
    """Markdown of the tables that have rows."""
    found = list(results)
    level = [result for result in found if result.world == "flat"]
    climbs = [result for result in found if result.world != "flat"]
    walks = [list(group) for _, group in groupby(level, key=lambda result: (result.robot, result.gait))]
    tables = (_table(LEVEL, map(_level_row, walks)), _table(CLIMBS, map(_climb_row, climbs)))
    return "\n".join(table for table in tables if table)


def _table(header: tuple[str, ...], rows: Iterable[str]) -> str:
    lines = list(rows)
    return "\n".join([row(header), row(["---"] * len(header)), *lines]) + "\n" if lines else ""


def _level_row(walks: list[Result]) -> str:
    first, margins = walks[0], [walk.static_margin_mm for walk in walks if walk.static_margin_mm is not None]
    speeds = {walk.manoeuvre: f"{walk.asked:.3f}, {walk.ratio:.2f}" for walk in walks}
    return row(
        [
            first.robot,
            first.gait,
            *(speeds.get(way, "–") for way in ("forward", "sideways", "turn")),
            number(min(margins, default=None), 0),
            number(max(walk.largest_tilt_deg for walk in walks), 1),
            word(any(walk.fell for walk in walks)),
            word(first.sat),
        ]
    )


def _climb_row(climb: Result) -> str:
    return row(
        [
            climb.robot,
            climb.world,
            climb.gait,
            climb.manoeuvre,
            f"{climb.asked:.3f}, {climb.ratio:.2f}",
            number(climb.static_margin_mm, 0),
            number(climb.energy_margin_mm, 1),
            number(climb.largest_tilt_deg, 1),
            number(climb.torque_share, 2),
            word(climb.fell),
        ]
    )
