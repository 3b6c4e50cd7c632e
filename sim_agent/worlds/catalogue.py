"""Worlds by name."""

from collections.abc import Callable
from functools import partial

from sim_agent.worlds.flat import flat
from sim_agent.worlds.incline import incline
from sim_agent.worlds.obstacles import pen, wall
from sim_agent.worlds.outdoor import outdoor
from sim_agent.worlds.scene import World
from sim_agent.worlds.stairs import low_stairs, stairs
from sim_agent.worlds.testbed import paper_testbed
from weaver_shared.errors import ConfigurationError

_WORLDS: dict[str, Callable[[int], World]] = {
    "flat": flat,
    "testbed": paper_testbed,
    "outdoor": outdoor,
    "stairs": stairs,
    "wall": wall,
    "pen": pen,
    "stairs6": low_stairs,
    "incline10": partial(incline, 10.0),
    "incline20": partial(incline, 20.0),
}

WORLD_NAMES: tuple[str, ...] = tuple(_WORLDS)


def make_world(name: str, seed: int) -> World:
    """The world of that name; the same name and seed give the same world. Raises ConfigurationError on others."""
    if name not in _WORLDS:
        raise ConfigurationError(f"world {name!r} is unknown; known are {', '.join(WORLD_NAMES)}")
    if seed < 0:
        raise ConfigurationError(f"seed {seed} is not valid; use a whole number from 0 up")
    return _WORLDS[name](seed)
