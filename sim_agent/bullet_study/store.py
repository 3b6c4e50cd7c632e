"""Measured points, a line each: what was finished is found again after an interruption."""

from __future__ import annotations

import json
from pathlib import Path

from sim_agent.bullet_study.measure import Measured
from sim_agent.bullet_study.points import Point
from sim_agent.study_folder import made_folder

VERSION = 1


class PointStore:
    """Figures by their point, in one file of a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = made_folder(folder)
        self._file = folder / "points.jsonl"
        self._known = self._read()

    def load(self, point: Point) -> Measured | None:
        return self._known.get(point.key)

    def save(self, measured: Measured) -> None:
        """One whole line, on a line of its own; an interruption leaves at most its beginning, which is not read."""
        self._known[measured.point.key] = measured
        with self._file.open("a", encoding="utf-8") as file:
            file.write("\n" + json.dumps({"version": VERSION, **measured.as_dict()}) + "\n")

    def _read(self) -> dict[str, Measured]:
        known: dict[str, Measured] = {}
        if not self._file.is_file():
            return known
        for line in self._file.read_text(encoding="utf-8").splitlines():
            try:
                found = json.loads(line)
                if found.pop("version") != VERSION:
                    continue
                one = Measured(**{**found, "point": Point(**found["point"])})
            except (ValueError, TypeError, KeyError):
                continue
            known[one.point.key] = one
        return known
