"""The three robots OpenSHC 0.5.11 is recorded with: `default`, `bullet_insectoid` and `bullet_mammalian`.

Numbers are the packages' shipped parameters (facts, not code), quarter turns rounded as there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import ConfigurationError

Array = NDArray[np.float64]

LEGS = ("AR", "BR", "CR", "CL", "BL", "AL")
QUARTER = 1.571


@dataclass(frozen=True, slots=True, kw_only=True)
class Robot:
    """Chains are classical DH rows theta, d, r, alpha; row 0 is the fixed base link."""

    name: str
    dt: float  # s
    clearance: float  # m
    step_frequency: float  # Hz, of OpenSHC's meaning: one over the swing time
    swing_height: float  # m
    time_to_start: float  # s
    gait: str
    stance: Array  # (legs, 2) m, in body
    dh: Array  # (legs, n + 1, 4)
    limits: Array  # (legs, n, 2) rad
    unpacked: Array  # (legs, n) rad
    max_rate: float  # rad/s
    clamp_rate: bool

    @property
    def joints(self) -> int:
        return int(self.limits.shape[1])


def _default() -> Robot:
    right = [-0.523, -1.571, -2.617]
    base = [*right, *(-theta for theta in reversed(right))]
    chain = [[0.0, 0.0, 0.05, 1.571], [0.0, 0.0, 0.05, 0.0], [-0.1, 0.0, 0.1, 0.0]]
    limits = [[-0.55, 0.55], [-1.5, 1.5], [-2.355, -0.1]]
    stance = [[0.13, -0.075], [0.0, -0.15], [-0.13, -0.075]]
    return Robot(
        name="default",
        dt=0.02,
        clearance=0.1,
        step_frequency=1.0,
        swing_height=0.02,
        time_to_start=6.0,
        gait="tripod_gait",
        stance=_mirrored(stance),
        dh=np.array([[[theta, 0.0, 0.05, 0.0], *chain] for theta in base]),
        limits=np.tile(np.array(limits), (6, 1, 1)),
        unpacked=np.tile([0.0, 0.785, -1.138], (6, 1)),
        max_rate=5.0,
        clamp_rate=True,
    )


def _bullet(
    name: str,
    *,
    base: tuple[float, tuple[float, float, float]],
    coxa_r: float,
    coxat_d: float,
    stance: list[list[float]],
    coxat: tuple[float, float],
    femur: tuple[float, float],
    tarsus: list[tuple[float, float]],
    swing_height: float,
    gait: str,
) -> Robot:
    base_d, base_r = base
    dh, limits = [], []
    for leg, row in enumerate((0, 1, 2, 2, 1, 0)):
        side = 1.0 if leg < 3 else -1.0  # right legs mirror left ones
        dh.append(
            [
                [0.0, base_d, base_r[row], side * QUARTER],
                [0.0, 0.195, coxa_r, -side * QUARTER],
                [-side * QUARTER, coxat_d, 0.035, QUARTER],
                [0.0, 0.0, 0.114, 0.0],
                [0.0, 0.0, 0.114, 0.0],
                [0.0, 0.0, 0.173, 0.0],
            ]
        )
        turn = 1.571 if leg == 0 else 1.57
        roll = coxat if side > 0 else (-coxat[1], -coxat[0])
        limits.append([(-turn, turn), roll, femur, (-2.355, 0.001), tarsus[leg]])
    return Robot(
        name=name,
        dt=0.01,
        clearance=0.25,
        step_frequency=1.1,
        swing_height=swing_height,
        time_to_start=5.0,
        gait=gait,
        stance=_mirrored(stance),
        dh=np.array(dh),
        limits=np.array(limits),
        unpacked=np.tile([0.0, 0.0, 1.088, -0.765, -1.212], (6, 1)),
        max_rate=5.0,
        clamp_rate=False,
    )


def _mirrored(right: list[list[float]]) -> Array:
    return np.array([*right, *([x, -y] for x, y in reversed(right))])


ROBOTS = {
    robot.name: robot
    for robot in (
        _default(),
        _bullet(
            "bullet_insectoid",
            base=(0.051, (0.25, 0.0, -0.25)),
            coxa_r=-0.047,
            coxat_d=-0.06,
            stance=[[0.3, -0.35], [-0.02, -0.35], [-0.35, -0.35]],
            coxat=(-2.355, 2.355),
            femur=(-1.571, 1.45),
            tarsus=[(-2.355, 2.355)] * 6,
            swing_height=0.09,
            gait="tripod_gait",
        ),
        _bullet(
            "bullet_mammalian",
            base=(0.055, (0.268, 0.018, -0.232)),
            coxa_r=0.0,
            coxat_d=-0.058,
            stance=[[0.325, -0.225], [0.0, -0.375], [-0.325, -0.225]],
            coxat=(-3.142, 0.0),
            femur=(-2.355, 2.355),
            tarsus=[(-3.142, 0.001), *[(-2.355, 0.001)] * 4, (-3.142, 0.001)],
            swing_height=0.07,
            gait="bipod_gait",
        ),
    )
}


def robot_of(name: str) -> Robot:
    """Raises ConfigurationError that names the robots OpenSHC is reproduced for."""
    if name not in ROBOTS:
        raise ConfigurationError(f"robot {name!r} has no OpenSHC recordings; known are {', '.join(ROBOTS)}")
    return ROBOTS[name]
