"""Missions kept by name."""

from __future__ import annotations

import json
import sqlite3
import time
from collections.abc import Callable
from dataclasses import dataclass

from weaver_console.database import Database
from weaver_shared.errors import InputError, ResourceError
from weaver_shared.messages import Waypoint

LONGEST_NAME = 60
MOST = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class SavedMission:
    """`saved` is unix time in s; waypoints are in the world of the robot that it was made with."""

    name: str
    waypoints: tuple[Waypoint, ...]
    operator: str
    robot: str
    saved: float
    areas: tuple[tuple[Waypoint, ...], ...] = ()  # ground that it keeps out of

    def to_page(self) -> dict[str, object]:
        return {
            "name": self.name,
            "waypoints": [{"x": place.x, "y": place.y} for place in self.waypoints],
            "areas": [[{"x": place.x, "y": place.y} for place in area] for area in self.areas],
            "operator": self.operator,
            "robot": self.robot,
            "saved": self.saved,
        }


class MissionStore:
    """Raises InputError on a name that is not valid, ResourceError when the database can not be written."""

    def __init__(self, database: Database, wall_time: Callable[[], float] = time.time) -> None:
        self._database = database
        self._wall_time = wall_time

    def all(self) -> list[SavedMission]:
        """Newest first."""
        rows = self._database.read("select name, waypoints, operator, robot, saved from mission order by saved desc")
        return [_mission(row) for row in rows]

    def save(
        self,
        name: str,
        waypoints: tuple[Waypoint, ...],
        operator: str,
        robot: str,
        *,
        areas: tuple[tuple[Waypoint, ...], ...] = (),
    ) -> SavedMission:
        """Keep under this name, in place of what was kept under it."""
        name = _valid(name)
        if not waypoints:
            raise InputError("a mission without waypoints is not kept")
        names = {mission.name for mission in self.all()}
        if name not in names and len(names) >= MOST:
            raise InputError(f"{MOST} missions are kept already; delete one first")
        mission = SavedMission(
            name=name,
            waypoints=waypoints,
            operator=operator,
            robot=robot,
            saved=round(self._wall_time(), 3),
            areas=areas,
        )
        places = json.dumps(
            {"waypoints": _pairs(waypoints), "areas": [_pairs(area) for area in areas]}, allow_nan=False
        )
        self._write("insert or replace into mission values (?, ?, ?, ?, ?)", name, places, operator, robot,
                    mission.saved)  # fmt: skip
        return mission

    def delete(self, name: str) -> bool:
        """Whether there was one of this name."""
        return self._write("delete from mission where name = ?", name) > 0

    def _write(self, statement: str, *row: object) -> int:
        try:
            return self._database.write(statement, [row])
        except sqlite3.Error as error:
            raise ResourceError(f"the mission could not be kept: {error}") from error


def _mission(row: tuple[object, ...]) -> SavedMission:
    name, places, operator, robot, saved = row
    kept = json.loads(str(places))
    if isinstance(kept, list):  # before there were areas
        kept = {"waypoints": kept, "areas": []}
    return SavedMission(
        name=str(name),
        waypoints=_places(kept["waypoints"]),
        operator=str(operator),
        robot=str(robot),
        saved=float(str(saved)),
        areas=tuple(_places(area) for area in kept["areas"]),
    )


def _pairs(places: tuple[Waypoint, ...]) -> list[list[float]]:
    return [[place.x, place.y] for place in places]


def _places(pairs: list[list[float]]) -> tuple[Waypoint, ...]:
    return tuple(Waypoint(x=x, y=y) for x, y in pairs)


def _valid(name: str) -> str:
    name = name.strip()
    if not name or len(name) > LONGEST_NAME or not name.isprintable():
        raise InputError(f"a mission's name has 1 to {LONGEST_NAME} printable characters")
    return name
