"""One walk over the testbed in lock step, and the record it leaves."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.evaluation.trajectory import Trajectory, evaluate
from robot_agent.loops import CONTROL_RATE
from sim_agent.lock_step import LockStep, Moment
from sim_agent.mission import begin_mission
from sim_agent.testbed_study.plan import PlannedWalk
from sim_agent.worlds import World
from weaver_shared.errors import InputError, WeaverError
from weaver_shared.messages import Waypoint
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose, rotation_from_wxyz, rotation_z, rpy_from_rotation

COLUMNS = (
    "time",  # s since the mission began
    "x",  # m, true place in the course
    "y",
    "z",
    "roll",  # rad, true
    "pitch",
    "supply_power",  # W
    "motor_power",
    "roughness",  # 0..1 as the robot took it, NaN unknown
    "step_height",
    "virtual_stiffness",  # N/m
    "stride_frequency",  # Hz
    "stride_height",  # m
    "estimated_x",  # m in the robot's own world
    "estimated_y",
    "estimated_z",
)
EVERY = 5  # ticks a row: 20 Hz, the rate of the paper's power recordings
SLOWEST = 0.015  # m/s; a robot that makes less way is stuck
BEYOND_FALL = np.deg2rad(60.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkRecord:
    """A finished walk: `outcome` "reached", "stuck", "fell" or "stopped", and a row every 50 ms."""

    plan: PlannedWalk
    outcome: str
    duration: float  # s
    drift_percent: float  # NaN when not reached
    rows: dict[str, NDArray[np.float64]] = field(repr=False)  # by COLUMNS, (n,) each


def walk_testbed(plan: PlannedWalk) -> WalkRecord:
    """Stand up, walk the course's middle line to its end. Never raises for what happens to the robot on the way."""
    robot, world = load_robot(), plan.world()
    run = LockStep(robot, world, plan.seed)
    recorder = _Recorder()
    try:
        outcome = _mission(run, plan, world, recorder)
    except WeaverError:
        outcome = "stopped"
    finally:
        run.close()
    rows = recorder.rows()
    return WalkRecord(
        plan=plan,
        outcome=outcome,
        duration=float(rows["time"][-1]) if len(rows["time"]) else 0.0,
        drift_percent=recorder.drift() if outcome == "reached" else float("nan"),
        rows=rows,
    )


def _mission(run: LockStep, plan: PlannedWalk, world: World, recorder: _Recorder) -> str:
    begin_mission(run, _waypoints(plan, world), constant=plan.parameters)
    for tick in range(round(plan.distance / SLOWEST * CONTROL_RATE)):
        moment = run.step()
        recorder.add(moment, tick)
        phase = run.walk.desk.mission(moment.walk.stamp_ns).phase
        if phase == "done":
            return "reached"
        if moment.truth is not None and _has_fallen(moment):
            return "fell"
        if phase == "paused" or moment.walk.permission.mode == "FAULT":
            return "stopped"
    return "stuck"


def _waypoints(plan: PlannedWalk, world: World) -> tuple[Waypoint, ...]:
    """The middle line of the course as an operator would click it, every 1.5 m, in the robot's own world.

    That world begins where the robot sits, heading along x.
    """
    x, y, heading = world.start
    robot_from_course = Pose(rotation=rotation_z(heading), position=np.array([x, y, 0.0])).inverse()
    ends = np.append(np.arange(1.5, plan.distance - 0.5, 1.5), plan.distance)
    points = [robot_from_course.transform(np.array([end, 0.0, 0.0])) for end in ends]
    return tuple(Waypoint(x=float(point[0]), y=float(point[1])) for point in points)


def _has_fallen(moment: Moment) -> bool:
    assert moment.truth is not None
    roll, pitch, _ = rpy_from_rotation(rotation_from_wxyz(moment.truth.wxyz))
    return bool(max(abs(roll), abs(pitch)) > BEYOND_FALL)


class _Recorder:
    def __init__(self) -> None:
        self._rows: list[tuple[float, ...]] = []
        self._true: tuple[list[int], list[Pose]] = ([], [])
        self._estimated: tuple[list[int], list[Pose]] = ([], [])

    def add(self, moment: Moment, tick: int) -> None:
        if moment.vision is not None:
            odometry = moment.vision.odometry
            self._estimated[0].append(odometry.stamp_ns)
            self._estimated[1].append(odometry.world_from_body)
        if moment.truth is None:
            return
        pose = Pose.of(moment.truth.position_in_world, moment.truth.wxyz)
        self._true[0].append(moment.truth.stamp_ns)
        self._true[1].append(pose)
        if tick % EVERY:
            return
        roll, pitch, _ = rpy_from_rotation(pose.rotation)
        sensed, report = moment.sensed, moment.walk.report
        applied = report.applied
        self._rows.append(
            (
                tick / CONTROL_RATE,
                *pose.position,
                float(roll),
                float(pitch),
                sensed.battery_voltage * sensed.supply_current,
                sensed.motor_power,
                report.roughness,
                report.step_height,
                applied.virtual_stiffness,
                applied.stride_frequency,
                applied.stride_height,
                *moment.walk.state.world_from_body.position,
            )
        )

    def rows(self) -> dict[str, NDArray[np.float64]]:
        table = np.array(self._rows, dtype=np.float64).reshape(-1, len(COLUMNS))
        return {name: table[:, index].copy() for index, name in enumerate(COLUMNS)}

    def drift(self) -> float:
        try:
            return evaluate(Trajectory.of(*self._estimated), Trajectory.of(*self._true)).drift_percent
        except InputError:
            return float("nan")


def outcome_of(record: WalkRecord) -> dict[str, Any]:
    """All of a record but its rows."""
    return {
        **record.plan.as_dict(),
        "outcome": record.outcome,
        "duration": record.duration,
        "drift_percent": record.drift_percent,
    }
