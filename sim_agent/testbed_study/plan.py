"""Which walks make up the study, and what differs from one to the next."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any, Literal

import numpy as np

from sim_agent.worlds import World, make_world

Kind = Literal["adaptive", "fixed"]

KINDS: tuple[Kind, ...] = ("adaptive", "fixed")
START_SPREAD = 0.04  # m beside the middle of the course, standard deviation
HEADING_SPREAD = np.deg2rad(2.0)  # standard deviation
FRICTION_RANGE = (0.85, 1.15)  # of the materials' coefficients


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedWalk:
    """One walk over the testbed. The course is that of `world_seed`; all that varies comes from `seed`."""

    kind: Kind
    seed: int
    world_seed: int
    distance: float  # m along the course
    parameters: dict[str, float] | None = None  # of the gait, held all the way; None: adapted

    @property
    def name(self) -> str:
        return f"{self.kind}-{self.seed:03d}"

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)

    def world(self) -> World:
        """The course with this walk's start and friction; adaptive and fixed walks of a seed begin alike."""
        random = np.random.default_rng([self.seed, 41])
        world = make_world("testbed", self.world_seed)
        x, y, heading = world.start
        start = (x, y + START_SPREAD * random.normal(), heading + HEADING_SPREAD * random.normal())
        return replace(world, start=start, friction=float(random.uniform(*FRICTION_RANGE)))


def adaptive_walks(runs: int, seed: int, world_seed: int, distance: float) -> list[PlannedWalk]:
    """`runs` adaptive walks with seeds from `seed` on."""
    return [
        PlannedWalk(kind="adaptive", seed=number, world_seed=world_seed, distance=distance)
        for number in range(seed, seed + runs)
    ]


def fixed_walks(adaptive: list[PlannedWalk], parameters: dict[str, float]) -> list[PlannedWalk]:
    """The counterparts of adaptive walks, with constant gait parameters."""
    return [replace(walk, kind="fixed", parameters=parameters) for walk in adaptive]
