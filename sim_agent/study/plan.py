"""What the study of the robots walks: courses on level ground, and climbs of the robots made for them."""

from __future__ import annotations

from dataclasses import dataclass

from sim_agent.study.climb import STEPS, climb
from sim_agent.study.manoeuvres import WAYS, walk_course
from sim_agent.study.result import Result
from weaver_shared.robots import load_robot

WORLDS = ("flat", *STEPS)
CLIMBERS = ("weaver", "bullet")
"""Names, or beginnings of names, of the robots that leave level ground."""
CLIMBING_GAIT = "tripod"


@dataclass(frozen=True, slots=True, kw_only=True)
class Course:
    """One simulation."""

    robot: str
    gait: str
    world: str
    seed: int
    ways: tuple[str, ...] = WAYS

    def walk(self) -> list[Result]:
        robot = load_robot(self.robot)
        if self.world == "flat":
            return walk_course(robot, self.gait, self.seed, self.ways)
        return [climb(robot, self.world, self.gait, self.seed)]


def courses(
    robots: tuple[str, ...], gaits: tuple[str, ...], worlds: tuple[str, ...], seed: int, ways: tuple[str, ...] = WAYS
) -> list[Course]:
    """Every robot in every one of `gaits` that it has (all if none are named); climbs in the climbing gait alone."""
    found = []
    for name in robots:
        own = load_robot(name).gaits
        for world in worlds:
            climbs = world != "flat"
            if climbs and not name.startswith(CLIMBERS):
                continue
            chosen = gaits or ((CLIMBING_GAIT,) if climbs else own)
            found += [
                Course(robot=name, gait=gait, world=world, seed=seed, ways=ways) for gait in chosen if gait in own
            ]
    return found
