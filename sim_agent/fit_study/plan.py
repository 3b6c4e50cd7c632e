"""Which trials make up the study: gait parameters on a grid, on every ground, with every seed."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from itertools import product
from typing import Any

import numpy as np

from sim_agent.fit_study.grounds import GROUNDS, QUICK, Ground
from weaver_shared.config.adaptation import AdaptationConfig, Bounds
from weaver_shared.errors import InputError
from weaver_shared.robots import RobotDescription

LOWEST = 0.03
"""m, the lowest stride the study tries; lower, feet strike what perception rounds off."""
LEVELS = {"full": (4, 5, 4), "quick": (2, 4, 3)}
"""How many values of virtual stiffness, stride frequency and stride height are tried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """One walk over one ground with constant gait parameters."""

    robot: str
    ground: str
    seed: int
    virtual_stiffness: float  # N/m
    stride_frequency: float  # Hz
    stride_height: float  # m

    @property
    def name(self) -> str:
        c, f, h = self.virtual_stiffness, self.stride_frequency, self.stride_height
        return f"{self.robot}-{self.ground}-{self.seed}-{c:g}-{f:g}-{h:g}"

    @property
    def parameters(self) -> tuple[float, float, float]:
        return self.virtual_stiffness, self.stride_frequency, self.stride_height

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def widened(robot: RobotDescription) -> AdaptationConfig:
    """The robot's adaptation with the bounds between which the study looks, up to what its gait can do."""
    used, gait = robot.adaptation, robot.locomotion
    frequency = max(used.stride_frequency.upper, gait.frequency_bounds[1])
    height = min(used.stride_height.lower, max(LOWEST, gait.height_bounds[0]))
    return used.model_copy(
        update={
            "stride_frequency": used.stride_frequency.model_copy(update={"upper": frequency}),
            "stride_height": used.stride_height.model_copy(update={"lower": height}),
        }
    )


def trials(
    robot: str, adaptation: AdaptationConfig, grounds: list[Ground], seeds: range, *, quick: bool
) -> list[Trial]:
    """The grid between the bounds of `adaptation`; stiffness in equal ratios, the others in equal steps."""
    stiff, frequent, high = LEVELS["quick" if quick else "full"]
    grid = list(
        product(
            _values(adaptation.virtual_stiffness, stiff, ratio=True),
            _values(adaptation.stride_frequency, frequent),
            _values(adaptation.stride_height, high),
        )
    )
    return [
        Trial(robot=robot, ground=ground.name, seed=seed, virtual_stiffness=c, stride_frequency=f, stride_height=h)
        for ground in grounds
        for seed in seeds
        for c, f, h in grid
    ]


def grounds_named(names: str, *, quick: bool) -> list[Ground]:
    """Grounds by comma-separated names; all, or the quick form's, where none are named. Raises InputError."""
    known = {ground.name: ground for ground in GROUNDS}
    wanted = [name.strip() for name in names.split(",") if name.strip()] or (QUICK if quick else list(known))
    unknown = [name for name in wanted if name not in known]
    if unknown:
        raise InputError(f"ground {', '.join(unknown)} is unknown; known are {', '.join(known)}")
    return [known[name] for name in wanted]


def _values(bounds: Bounds, count: int, *, ratio: bool = False) -> list[float]:
    space = np.geomspace if ratio else np.linspace
    return [float(f"{value:.3g}") for value in space(bounds.lower, bounds.upper, count)]
