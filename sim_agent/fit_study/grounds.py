"""Courses of one kind of ground each, whose roughness and step height are known from their true surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim_agent.true_indices import worst_along
from sim_agent.worlds import World
from sim_agent.worlds.block_field import block_field, smooth_random_heights
from sim_agent.worlds.scene import Box, Plane
from weaver_shared.robots import RobotDescription

RUN_UP = 0.4  # m of level board before the ground that counts
LENGTH = 1.8  # m of that ground
RUN_OUT = 1.0  # m of level board behind it
HALF_WIDTH = 0.75  # m
BOARD = 0.3  # m, thickness
GROUND_SEED = 1
BESIDE = 0.05
"""m, standard deviation of the start."""
PLANK = 3
"""Rows of blocks from one plank to the next."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Ground:
    """Blocks of `cell` m whose heights differ by at most `difference` times the robot's clearance."""

    name: str
    difference: float
    cell: float = 0.10  # m
    smoothing: float = 1.0  # blocks; neighbours step less when it is larger
    material: str = "wood"
    planks: bool = False  # whole rows, level or raised: steps without roughness in between

    def world(self, robot: RobotDescription, seed: int = 0) -> World:
        """Always the same ground; what differs with `seed` is where beside its middle the walk begins."""
        rows, columns = round(LENGTH / self.cell), int(np.ceil(2.0 * HALF_WIDTH / self.cell - 1e-9))
        generator = np.random.default_rng(GROUND_SEED)
        height = self.difference * robot.clearance
        if self.planks:
            heights = np.zeros((rows, columns))
            heights[int(generator.integers(PLANK)) :: PLANK] = height
        else:
            heights = smooth_random_heights(
                rows, columns, difference=height, smoothing=self.smoothing, generator=generator
            )
        y = (-HALF_WIDTH - 0.5, HALF_WIDTH + 0.5)
        boards = [
            Box.under(x=x, y=y, top=0.0, depth=BOARD, material="board")
            for x in ((-1.5, RUN_UP), (RUN_UP + LENGTH, RUN_UP + LENGTH + RUN_OUT))
        ]
        if height > 0.0:
            boards += block_field(heights, x0=RUN_UP, cell=self.cell, base=0.0, material=self.material)
        else:
            boards.append(Box.under(x=(RUN_UP, RUN_UP + LENGTH), y=y, top=0.0, depth=BOARD, material=self.material))
        return World(
            name=f"ground {self.name}",
            seed=seed,
            start=(0.0, float(np.random.default_rng([seed, 43]).normal(scale=BESIDE)), 0.0),
            bounds=(-1.5, RUN_UP + LENGTH + RUN_OUT, -HALF_WIDTH, HALF_WIDTH),
            planes=(Plane(height=-0.6, material="grass"),),
            boxes=tuple(boards),
        )


GROUNDS = (
    Ground(name="level", difference=0.0, material="board"),
    Ground(name="gravel", difference=0.11, cell=0.06, material="gravel"),
    Ground(name="sand", difference=0.28, cell=0.06, smoothing=1.2, material="sand"),
    Ground(name="stones", difference=0.50, cell=0.12, material="stone"),
    Ground(name="planks", difference=0.15, planks=True),
    Ground(name="rubble", difference=0.72, cell=0.12, material="stone"),
    Ground(name="blocks", difference=1.13, smoothing=1.1),
    Ground(name="broken", difference=1.13, smoothing=0.8),
    Ground(name="boulders", difference=1.50, smoothing=0.9),
)
QUICK = ("level", "sand", "stones", "rubble", "broken")


def measured_section() -> tuple[float, float]:
    """Where along the course (m) the body is while all its feet are on the ground that counts, or nearly."""
    return RUN_UP + 0.1, RUN_UP + LENGTH - 0.4


def true_indices(world: World) -> tuple[float, float]:
    """Roughness and step height that rule the gait on the measured section: means along the way."""
    roughness, step_height = worst_along(world, np.arange(*measured_section(), 0.1)).mean(axis=0)
    return float(roughness), float(step_height)
