"""One trial: stand up, walk straight over the ground, note what it cost and how the body swayed."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.evaluation.energy import cost_of_transport
from sim_agent.fit_study.grounds import GROUNDS, measured_section
from sim_agent.fit_study.plan import Trial
from sim_agent.study.climb import climbing_order
from sim_agent.study.posture import rise
from sim_agent.study.rig import DT, Rig
from sim_agent.study.watch import Watch
from weaver_shared.config.navigation import PathFollowerConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot
from weaver_shared.transforms import rpy_from_rotation

SLOWEST = 0.02  # m/s; a robot that makes less way is stuck
GAIT = "tripod"  # the paper's


@dataclass(frozen=True, slots=True, kw_only=True)
class TrialResult:
    """`outcome` "reached", "stuck", "fell" or "did not stand"; figures of the measured section, NaN if not reached."""

    trial: Trial
    outcome: str
    speed: float  # m/s
    cost_total: float
    cost_motors: float
    roll_variance: float  # rad^2, about the section's mean
    pitch_variance: float

    def as_dict(self) -> dict[str, Any]:
        return {**self.trial.as_dict(), **{k: v for k, v in asdict(self).items() if k != "trial"}}


def walk_trial(trial: Trial) -> TrialResult:
    """Straight ahead by the walker alone: perception has no part in what a gait is worth on a ground."""
    robot = load_robot(trial.robot)
    ground = next(ground for ground in GROUNDS if ground.name == trial.ground)
    rig = Rig(robot, ground.world(robot, trial.seed), trial.seed)
    rig.parameters = GaitParameters(
        stamp_ns=0,
        virtual_stiffness=trial.virtual_stiffness,
        stride_frequency=trial.stride_frequency,
        stride_height=trial.stride_height,
        confidence=1.0,
    )
    try:
        if not rise(rig, GAIT):
            return _failed(trial, "did not stand")
        outcome, rows = _walk(rig)
        return _judged(trial, rows, robot.mass) if outcome == "reached" else _failed(trial, outcome)
    finally:
        rig.close()


def _walk(rig: Rig) -> tuple[str, NDArray[np.float64]]:
    """How it ended, and rows of x, roll, pitch, supply power, motor power on the measured section."""
    begin, end = measured_section()
    watch = Watch()
    rows: list[tuple[float, ...]] = []
    for _ in range(round(end / SLOWEST / DT)):
        sensed = rig.step(gait=GAIT, velocity=climbing_order(rig, PathFollowerConfig().forward_speed))
        if not watch.look(rig):
            return "fell", np.array(rows)
        pose = rig.truth()
        x = float(pose.position[0])
        if x >= end:
            return "reached", np.array(rows)
        if x >= begin:
            roll, pitch, _ = rpy_from_rotation(pose.rotation)
            rows.append((x, roll, pitch, sensed.battery_voltage * sensed.supply_current, sensed.motor_power))
    return "stuck", np.array(rows)


def _judged(trial: Trial, rows: NDArray[np.float64], mass: float) -> TrialResult:
    x, roll, pitch, supply, motors = rows.T
    distance = float(x[-1] - x[0])
    cost = cost_of_transport(supply_power=supply, motor_power=motors, dt=DT, distance=distance, mass=mass)
    return TrialResult(
        trial=trial,
        outcome="reached",
        speed=distance / (DT * len(x)),
        cost_total=cost.total,
        cost_motors=cost.motors,
        roll_variance=float(np.var(roll)),
        pitch_variance=float(np.var(pitch)),
    )


def _failed(trial: Trial, outcome: str) -> TrialResult:
    nothing = float("nan")
    return TrialResult(
        trial=trial,
        outcome=outcome,
        speed=nothing,
        cost_total=nothing,
        cost_motors=nothing,
        roll_variance=nothing,
        pitch_variance=nothing,
    )
