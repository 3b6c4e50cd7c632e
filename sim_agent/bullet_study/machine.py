"""Bullet set up as in the paper's experiments: OpenSHC's gaits, feet down where and when planned, never slowed down."""

from __future__ import annotations

from typing import Any

from sim_agent.bullet_study.points import SWING
from weaver_shared.robots import RobotDescription, load_robot

HIGHEST_FREQUENCY = 3.0  # Hz, of strides
FASTEST = 2.0  # m/s
NEVER = -1.0
"""m of stability, below which the walker would warn, slow down and refuse; the paper's controller knew none."""


def bullet(name: str, variant: str = "") -> RobotDescription:
    """The robot, or a `variant` of it by which a difference is explained."""
    robot = load_robot(name)
    tables = robot.model_dump(by_alias=True)
    tables["custom_gaits"] = [
        {"name": gait, "duty": 1.0 - swing, "offsets": dict(zip(robot.leg_names, robot.gait(gait).offset, strict=True))}
        for gait, swing in SWING.items()
    ]
    walk = tables["locomotion"]
    walk |= {"feel_ground": False, "largest_speed": FASTEST, "frequency_bounds": (0.05, HIGHEST_FREQUENCY)}
    walk |= {"shortest_swing": 0.05, "frequency_rate": 10.0, "spare_servos": False, "overlapping_walkspaces": True}
    walk["stability"] |= {
        f"{level}_{margin}": NEVER for level in ("warn", "slow", "refuse") for margin in ("static", "energy")
    }
    _vary(tables, variant)
    return RobotDescription.model_validate(tables)


def _vary(tables: dict[str, Any], variant: str) -> None:
    if variant == "no_friction":
        for servo in tables["servos"].values():
            servo |= {"coulomb_friction": 0.0, "viscous_friction": 0.0}
    elif variant == "stiff":
        for servo in tables["servos"].values():
            servo["position_gain"] *= 2.0
    elif variant == "heavy_legs":
        added = 0.5 * len(tables["legs"]) * sum(joint["mass"] for joint in tables["joints"])
        for joint in tables["joints"]:
            joint["mass"] *= 1.5
        tables["body"]["mass"] -= added  # the robot as a whole weighs as much as before
