"""An OpenSHC walk as rows of text, with the columns and the order of its recordings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.robots import LEGS, Robot
from robot_agent.locomotion.openshc.walk import Walk
from weaver_shared.transforms import wxyz_from_rotation

IDLE_TICKS = 5
ADMITTANCE_STIFFNESS_FORCE = np.zeros(7)
"""Applied offset, reported stiffness and estimated force: admittance is off in these runs."""


def rows(robot: Robot, gait: str, velocity: NDArray[np.float64], ticks: int) -> Iterator[list[str]]:
    """Ticks 0..ticks; `velocity` (3,) is the throttle vx, vy, turn, each in -1..1, given once before tick 6."""
    walk = Walk(robot, gait)
    for tick in range(ticks + 1):
        if tick:
            command = velocity if tick > IDLE_TICKS else np.zeros(3)
            walk.tick(command[:2], float(command[2]))
        for leg, name in enumerate(LEGS):
            numbers = _numbers(walk, leg)
            yield [str(tick), name, str(walk.step_state[leg]), *(f"{value:.10g}" for value in numbers)]


def _numbers(walk: Walk, leg: int) -> NDArray[np.float64]:
    path, chain = walk.paths[leg], walk.legs[leg]
    frame = chain.tip_frame()
    wanted = path.tip - np.array([0.0, 0.0, walk.robot.clearance])
    timing = [walk.phase[leg], *walk.progress[leg]]
    vectors = [path.tip, path.velocity, path.target, path.default, path.stride, wanted, frame[:3, 3]]
    rotation = wxyz_from_rotation(frame[:3, :3])
    joints = np.column_stack([chain.position, chain.rate]).ravel()
    return np.concatenate([timing, *vectors, rotation, ADMITTANCE_STIFFNESS_FORCE, joints]) + 0.0
