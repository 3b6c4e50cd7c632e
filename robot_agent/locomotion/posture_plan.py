"""How every leg goes from one posture to another: up, over its place, round in the air, and down (OpenSHC'20 VI-B)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body
from weaver_shared.robots.reach import joints_reaching, leg_length

Array = NDArray[np.float64]

LIFTS = (0.12, 0.18, 0.26)
"""Of the leg's length, that feet are lifted before they turn; the lowest with which all clear the ground is taken."""
BODY_HEIGHTS = (0.0, 0.5, 1.0)
"""From the lower to the higher posture's; the lowest in which all legs can turn is taken."""
CLEARANCE = 0.06
"""Of the leg's length, between the ground and everything that turns in the air."""
SAMPLES = 25
REACHED = 2e-3
"""Of the leg's length."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PosturePlan:
    """Heights are those of foot centres in body; angles are rad, one row a leg."""

    height: float  # m, of feet on the ground while legs are moved
    sitting_height: float  # m, of feet when the belly is down
    lift: float  # m
    stance: Array  # (legs, 2) m, where feet are lifted over before the legs turn
    goal: Array  # (legs, 2) m, where they are put down
    lifted: Array  # (legs, n) over the stance
    turned: Array  # (legs, n) over the goal
    lifted_links: Array  # (legs, 3) directions in body of the last links, of the one
    turned_links: Array  # (legs, 3) and of the other
    order: tuple[int, ...]  # of the legs


def plan_change(here: RobotDescription, there: RobotDescription) -> PosturePlan:
    """The way of every leg from one description of a machine to the other.

    Raises ConfigurationError where a leg can not get there without touching the ground.
    """
    size, heights = leg_length(here), [float(robot.stance_in_body[0, 2]) for robot in (here, there)]
    for body, lift in product(BODY_HEIGHTS, LIFTS):
        height = max(heights) + body * (min(heights) - max(heights))
        lifted, short = _over(here, height + lift * size)
        turned, short_there = _over(there, height + lift * size)
        if max(short, short_there) < REACHED * size and _lowest(here, lifted, turned) > height + CLEARANCE * size:
            return PosturePlan(
                height=height,
                sitting_height=min(float(robot.sitting_in_body[0, 2]) for robot in (here, there)),
                lift=lift * size,
                stance=here.stance_in_body[:, :2],
                goal=there.stance_in_body[:, :2],
                lifted=lifted,
                turned=turned,
                lifted_links=_last_links(here, lifted),
                turned_links=_last_links(there, turned),
                order=_order(here, there),
            )
    raise ConfigurationError(
        f"robot {here.name!r}: posture.counterpart: lifted by up to {LIFTS[-1] * size:.3f} m, the legs do "
        f"not turn into the posture of {there.name!r} without touching the ground"
    )


def _over(robot: RobotDescription, height: float) -> tuple[Array, float]:
    """Angles (legs, n) with the feet over their stance, and the distance (m) that is left."""
    feet = robot.stance_in_body.copy()
    feet[:, 2] = height
    angles, left = joints_reaching(robot, feet, robot.sitting_search, steps=60)
    return angles, float(left.max())


def _last_links(robot: RobotDescription, angles: Array) -> Array:
    """Directions in body of every leg's last link, (legs, 3)."""
    frames = joint_frames_in_body(robot, angles)
    links = frames[:, -1, :3, 3] - frames[:, -2, :3, 3]
    result: Array = links / np.linalg.norm(links, axis=1, keepdims=True)
    return result


def _lowest(robot: RobotDescription, start: Array, end: Array) -> float:
    """Height in body (m) of the lowest joint or foot of any leg on the straight way in joint space."""
    heights = [
        joint_frames_in_body(robot, start + share * (end - start))[:, 2:, 2, 3].min()
        for share in np.linspace(0.0, 1.0, SAMPLES)
    ]
    return float(np.min(heights))


def _order(here: RobotDescription, there: RobotDescription) -> tuple[int, ...]:
    """Legs one after the other from the end towards which feet move, so that no leg turns into its neighbour."""
    forward = float((there.stance_in_body - here.stance_in_body)[:, 0].sum()) > 0.0
    along = here.hips_in_body[:, 0]
    return tuple(int(leg) for leg in np.argsort(-along if forward else along, kind="stable"))
