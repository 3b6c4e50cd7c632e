"""A ramp up, a level top and a ramp down, at one angle: for climbing measured by itself."""

import numpy as np

from sim_agent.worlds.scene import Box, Plane, Segment, World
from weaver_shared.transforms import rotation_y

FOOT = 1.2  # m, world x at which the ramp begins
SLOPE_LENGTH = 1.8  # m along each ramp
TOP = 1.6  # m, level, longer than a robot
WIDTH = 2.4  # m
THICKNESS = 0.5  # m


def incline(degrees: float, seed: int) -> World:
    """Seeded like the other worlds; the seed changes only how it looks."""
    angle = float(np.deg2rad(degrees))
    run, rise = SLOPE_LENGTH * float(np.cos(angle)), SLOPE_LENGTH * float(np.sin(angle))
    crest, edge, end = FOOT + run, FOOT + run + TOP, FOOT + 2.0 * run + TOP
    return World(
        name=f"incline{degrees:g}",
        seed=seed,
        start=(0.0, 0.0, 0.0),
        bounds=(-2.0, end + 2.0, -WIDTH / 2, WIDTH / 2),
        planes=(Plane(height=0.0, material="board"),),
        boxes=(
            _ramp(FOOT, 0.0, angle),
            Box.under(x=(crest, edge), y=(-WIDTH / 2, WIDTH / 2), top=rise, depth=rise + 0.2, material="board"),
            _ramp(edge, rise, -angle),
        ),
        segments=(
            Segment(name="up", begin=FOOT, end=crest),
            Segment(name="top", begin=crest, end=edge),
            Segment(name="down", begin=edge, end=end),
        ),
    )


def _ramp(x: float, height: float, angle: float) -> Box:
    """A board whose upper face begins at (x, height) and rises by `angle` rad."""
    rotation = rotation_y(-angle)
    middle = np.array([x, 0.0, height]) + rotation @ np.array([SLOPE_LENGTH / 2, 0.0, -THICKNESS / 2])
    half = np.array([SLOPE_LENGTH / 2, WIDTH / 2, THICKNESS / 2])
    return Box(centre=middle, half=half, rotation=rotation, material="wood")
