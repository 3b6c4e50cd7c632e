"""Random robots: three to eight legs of three to six joints, some mirrored, some tilted, on Weaver's servos."""

from __future__ import annotations

from typing import Any

import numpy as np

from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.robots.gaits import predefined_gaits

QUARTER = 0.5 * np.pi
KINDS = {
    3: ("yaw", "pitch", "pitch"),
    4: ("yaw", "pitch", "pitch", "pitch"),
    5: ("yaw", "roll", "pitch", "pitch", "pitch"),
    6: ("yaw", "pitch", "pitch", "roll", "pitch", "pitch"),
}
"""What the joints of a leg do, from the hip."""
TURNS = {"yaw": (0.0, -QUARTER), "roll": (QUARTER, QUARTER), "pitch": (0.0, 0.0)}
"""theta and alpha of each kind, about which they scatter."""


def random_robot(rng: np.random.Generator, number: int) -> RobotDescription:
    """A robot that could be built; whether it can stand is not asked."""
    weaver = load_robot("weaver").model_dump(by_alias=True)
    legs, joints = int(rng.integers(3, 9)), int(rng.integers(3, 7))
    size = float(rng.uniform(0.5, 2.0))
    chain = [_joint(rng, index, kind, size) for index, kind in enumerate(KINDS[joints])]
    return RobotDescription.model_validate(
        weaver
        | {
            "name": f"random-{number}",
            "mass": weaver["body"]["mass"] + legs * sum(joint["mass"] for joint in chain),
            "clearance": 0.15 * size,
            "gaits": list(predefined_gaits(legs)),
            "custom_gaits": [],
            "joints": chain,
            "legs": [_leg(rng, index, legs, size) for index in range(legs)],
        }
    )


def _joint(rng: np.random.Generator, index: int, kind: str, size: float) -> dict[str, Any]:
    theta, alpha = TURNS[kind]
    exact = rng.random() < 0.5
    middle, half = float(rng.uniform(-0.4, 0.4)), float(rng.uniform(0.5, 2.2))
    return {
        "name": f"{kind}{index}",
        "servo": "mx106",
        "theta": theta + (0.0 if exact else float(rng.normal(0.0, 0.2))),
        "d": 0.0 if exact else float(rng.normal(0.0, 0.02)) * size,
        "r": float(rng.uniform(0.03, 0.12)) * size if kind != "roll" else 0.0,
        "alpha": alpha + (0.0 if exact else float(rng.normal(0.0, 0.1))),
        "lower": middle - half,
        "upper": middle + half,
        "mass": float(rng.uniform(0.05, 0.3)),
    }


def _leg(rng: np.random.Generator, index: int, legs: int, size: float) -> dict[str, Any]:
    around = -(index + 0.5) * 2.0 * np.pi / legs
    outwards = np.array([np.cos(around), np.sin(around)])
    hip, stance = 0.15 * size * outwards, float(rng.uniform(0.25, 0.4)) * size * outwards
    return {
        "name": f"L{index}",
        "hip_in_body": (float(hip[0]), float(hip[1]), float(rng.normal(0.0, 0.01))),
        "hip_yaw": float(around + rng.normal(0.0, 0.1)),
        "hip_roll": float(rng.normal(0.0, 0.1)) if rng.random() < 0.2 else 0.0,
        "mirrored": bool(rng.random() < 0.3),
        "stance_in_body": (float(stance[0]), float(stance[1])),
    }
