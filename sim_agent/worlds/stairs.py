"""A straight flight up, a landing and the same flight down."""

import numpy as np

from sim_agent.worlds.scene import Box, Plane, World

FIRST_STEP = 1.2  # m, world x
RISE = 0.07  # m, within the stride height of 0.14 m
LOW_RISE = 0.06  # m
TREAD = 0.34  # m
STEPS = 4
LANDING = 1.2  # m
WIDTH = 1.6  # m


def stairs(seed: int) -> World:
    """Seeded like the other worlds; the seed varies treads by up to 2 cm."""
    return _flight("stairs", RISE, seed)


def low_stairs(seed: int) -> World:
    """The same with steps of 6 cm."""
    return _flight("stairs6", LOW_RISE, seed)


def _flight(name: str, rise: float, seed: int) -> World:
    treads = TREAD + np.random.default_rng([seed, 2]).uniform(-0.02, 0.02, 2 * STEPS)
    lengths = [*treads[: STEPS - 1], LANDING, *treads[STEPS : 2 * STEPS - 1]]
    tops = [rise * n for n in (*range(1, STEPS + 1), *range(STEPS - 1, 0, -1))]
    edges = FIRST_STEP + np.concatenate([[0.0], np.cumsum(lengths)])
    boxes = tuple(
        Box.under(
            x=(float(begin), float(end)),
            y=(-WIDTH / 2, WIDTH / 2),
            top=top,
            depth=top + 0.3,
            material="stone" if index % 2 else "wood",
        )
        for index, (begin, end, top) in enumerate(zip(edges[:-1], edges[1:], tops, strict=True))
    )
    return World(
        name=name,
        seed=seed,
        start=(0.0, 0.0, 0.0),
        bounds=(-2.0, float(edges[-1]) + 2.0, -3.0, 3.0),
        planes=(Plane(height=0.0, material="board"),),
        boxes=boxes,
    )
