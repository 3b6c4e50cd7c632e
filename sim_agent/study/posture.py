"""Standing up and sitting down, judged by the truth."""

from __future__ import annotations

import numpy as np

from sim_agent.study.rig import DT, Rig
from sim_agent.study.watch import FALLEN_TILT

LONGEST = 30.0  # s
REST = 0.5  # s of stillness before it is judged
ON_BELLY = 0.2
"""Of the weight."""


def rise(rig: Rig, gait: str) -> bool:
    """Whether it stands, as high as described, within the longest time."""
    for _ in range(round(LONGEST / DT)):
        rig.step(gait=gait)
        if rig.out.posture == "standing":
            break
    for _ in range(round(REST / DT)):
        rig.step(gait=gait)
    return rig.out.posture == "standing" and rig.truth().position[2] > 0.9 * rig.robot.clearance


def sit(rig: Rig, gait: str) -> bool:
    """Whether it ends sitting, level, with its joints still."""
    for _ in range(round(LONGEST / DT)):
        rig.step(gait=gait, stand=False)
        if rig.out.posture == "sitting":
            break
    for _ in range(round(REST / DT)):
        rig.step(gait=gait, stand=False)
    still = float(np.abs(rig.sensed.joint_velocity).max()) < 0.3
    return rig.out.posture == "sitting" and still and rig.tilt() < FALLEN_TILT


def belly_on_ground(rig: Rig) -> bool:
    """Whether the trunk bears some of the weight."""
    forces, rest = rig.body.contact_forces()
    return bool(rest[2] > ON_BELLY * (forces[:, 2].sum() + rest[2]))
