"""The testbed of the Weaver paper (ICRA'17, Fig. 6): seven stretches from flat board to rough blocks.

Stated in the paper: A flat 2.93 m, B inclined 10 degrees 1.2 m, the largest height difference of C, D, E and F (113,
28, 11 and 72 % of the body height) and the width (145 % of the robot's). Lengths of C to G and the block sizes are
ours. A begins 0.5 m behind the start, so a world x equals the distance walked: A -0.5..2.43, B ..3.61, C ..4.81,
D ..5.71, E ..6.61, F ..7.81, G ..9.01.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim_agent.worlds.block_field import block_field, smooth_random_heights
from sim_agent.worlds.scene import Box, Plane, Segment, World
from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.transforms import rotation_y

BEHIND_START = 0.5  # m
LENGTH_A = 2.93  # m (paper)
LENGTH_B = 1.2  # m along the slope (paper)
SLOPE = np.deg2rad(10.0)  # (paper)
LENGTH_G = 1.2  # m
WIDTH_RATIO = 1.45  # of the robot's width (paper)
BOARD = 0.30  # m, thickness of flat parts
APRON_DROP = 0.03  # m, ground beside the course below its edge
APRON_WIDTH = 2.0  # m


@dataclass(frozen=True, slots=True, kw_only=True)
class _Rough:
    name: str
    length: float  # m
    cell: float  # m
    difference: float  # of the body height
    smoothing: float  # blocks
    material: str


# The smoothing keeps neighbouring 10 cm blocks within about 7 cm, so that a 34 cm leg can pass segment C.
_ROUGH = (
    _Rough(name="C", length=1.2, cell=0.10, difference=1.13, smoothing=1.1, material="wood"),
    _Rough(name="D", length=0.9, cell=0.06, difference=0.28, smoothing=1.2, material="sand"),
    _Rough(name="E", length=0.9, cell=0.06, difference=0.11, smoothing=1.0, material="gravel"),
    _Rough(name="F", length=1.2, cell=0.12, difference=0.72, smoothing=1.0, material="stone"),
)


def paper_testbed(seed: int, robot: RobotDescription | None = None) -> World:
    """The course for a robot (Weaver unless told otherwise), whose size sets width and height differences."""
    robot = load_robot() if robot is None else robot
    half_width = 0.5 * WIDTH_RATIO * robot_width(robot)
    generator = np.random.default_rng([seed, 1])
    end_a = LENGTH_A - BEHIND_START
    end_b = end_a + LENGTH_B * float(np.cos(SLOPE))
    rise = LENGTH_B * float(np.sin(SLOPE))

    boxes = [_flat((-BEHIND_START, end_a), (-half_width, half_width), 0.0)]
    boxes += [_ramp(end_a, (-half_width, half_width), 0.0)]
    boxes += _aprons((-3.0, end_a), half_width, -APRON_DROP)
    boxes += [_flat((-3.0, -BEHIND_START), (-half_width, half_width), -APRON_DROP, "earth")]
    boxes += [_ramp(end_a, side, -APRON_DROP, "earth") for side in _sides(half_width)]
    segments = [
        Segment(name="A", begin=-BEHIND_START, end=end_a),
        Segment(name="B", begin=end_a, end=end_b),
    ]
    x = end_b
    for rough in _ROUGH:
        rows = round(rough.length / rough.cell)
        columns = int(np.ceil(2 * half_width / rough.cell - 1e-9))
        heights = smooth_random_heights(
            rows,
            columns,
            difference=rough.difference * robot.clearance,
            smoothing=rough.smoothing,
            generator=generator,
        )
        boxes += block_field(heights, x0=x, cell=rough.cell, base=rise, material=rough.material)
        edge = columns * rough.cell / 2
        boxes += _aprons((x, x + rough.length), edge, rise + float(heights.min()) - APRON_DROP)
        segments.append(Segment(name=rough.name, begin=x, end=x + rough.length))
        x += rough.length
    boxes += [_flat((x, x + LENGTH_G), (-half_width, half_width), rise)]
    boxes += _aprons((x, x + LENGTH_G), half_width, rise - APRON_DROP)
    boxes += [_flat((x + LENGTH_G, x + LENGTH_G + 3.0), (-3.0, 3.0), rise - APRON_DROP, "earth")]
    segments.append(Segment(name="G", begin=x, end=x + LENGTH_G))
    return World(
        name="testbed",
        seed=seed,
        start=(0.0, 0.0, 0.0),
        bounds=(-BEHIND_START, x + LENGTH_G, -half_width, half_width),
        planes=(Plane(height=-0.6, material="grass"),),
        boxes=tuple(boxes),
        segments=tuple(segments),
    )


def robot_width(robot: RobotDescription) -> float:
    """Outer width of the standing robot over its feet (m)."""
    y = robot.stance_in_body[:, 1]
    return float(y.max() - y.min()) + 2.0 * robot.foot_radius


def _flat(x: tuple[float, float], y: tuple[float, float], top: float, material: str = "board") -> Box:
    return Box.under(x=x, y=y, top=top, depth=BOARD, material=material)


def _sides(half_width: float) -> tuple[tuple[float, float], tuple[float, float]]:
    return (-half_width - APRON_WIDTH, -half_width), (half_width, half_width + APRON_WIDTH)


def _aprons(x: tuple[float, float], half_width: float, top: float) -> list[Box]:
    return [_flat(x, side, top, "earth") for side in _sides(half_width)]


def _ramp(x0: float, y: tuple[float, float], top: float, material: str = "board") -> Box:
    """A board whose upper face rises from (x0, top) over LENGTH_B at SLOPE."""
    rotation = rotation_y(-SLOPE)
    middle = np.array([x0, (y[0] + y[1]) / 2, top]) + rotation @ np.array([LENGTH_B / 2, 0.0, -BOARD / 2])
    half = np.array([LENGTH_B / 2, (y[1] - y[0]) / 2, BOARD / 2])
    return Box(centre=middle, half=half, rotation=rotation, material=material)
