"""One walk of the drift study: the waypoint pattern in lock step, and how far the odometry was off at its end."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from robot_agent.evaluation.consistency import normalised_error
from robot_agent.evaluation.trajectory import Trajectory, evaluate, same_heading
from robot_agent.felt_queue import Felt
from robot_agent.loops import CONTROL_RATE
from robot_agent.odometry import StereoInertialOdometry
from robot_agent.vision.camera import StereoCalibration
from sim_agent.lock_step import LockStep
from sim_agent.worlds import make_world
from weaver_shared.errors import WeaverError
from weaver_shared.messages import (
    Answer,
    CommandName,
    OdometryEstimate,
    OdometryQuality,
    StereoFrame,
    TruthState,
    Waypoint,
)
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

PATTERNS: dict[str, tuple[tuple[float, float], ...]] = {
    "flat": ((5.0, 0.0), (5.0, 4.0), (0.5, 4.0), (0.5, 0.5), (4.5, 1.5)),
    "testbed": ((4.1, 0.0), (8.2, 0.0), (4.1, 0.0), (0.2, 0.0), (4.3, 0.0)),
}
"""Five waypoints (m): 21 m about a square as in the paper's Fig. 8; the testbed there, back and half there again."""

STAND_SECONDS = 30.0
SLOWEST = 0.02  # m/s; a robot that makes less way is stuck
HELD_SECONDS, HELD_WITHIN = 60.0, 0.15
"""A robot that stays this long (s) within this distance (m) is stuck as well."""


class StuckError(WeaverError):
    """The robot did not come to the pattern's end."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DriftErrors:
    drift_percent: float
    final_error: float  # m
    ate_m: float
    path_length: float  # m
    final_rotation_deg: float
    normalised_error: float  # squared, of the last pose; 6 for a covariance that is right
    good_percent: float  # of the frames


@dataclass(frozen=True, slots=True, kw_only=True)
class DriftRun:
    world: str
    seed: int
    seconds: float  # simulated
    stuck: str  # why the robot did not come to the end; empty when it did. The errors are of the way it made.
    with_contacts: DriftErrors  # of the odometry that led the walk
    without_contacts: DriftErrors  # on the same pictures and inertia

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def pattern_of(world: str, metres: float | None) -> tuple[Waypoint, ...]:
    """The world's pattern, shrunk to a path of `metres` if given."""
    corners = np.array([(0.0, 0.0), *PATTERNS[world]])
    length = float(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum())
    scale = 1.0 if metres is None else metres / length
    return tuple(Waypoint(x=float(x * scale), y=float(y * scale)) for x, y in corners[1:])


def walk_pattern(world: str, seed: int, metres: float | None = None) -> DriftRun:
    """A robot that gets stuck is judged by the way it made, and the run says so."""
    robot = load_robot()
    run = LockStep(robot, make_world(world, seed), seed)
    estimates: list[OdometryEstimate] = []
    alone: list[OdometryEstimate] = []
    truth: list[TruthState] = []
    waypoints = pattern_of(world, metres)
    blind_feet: StereoInertialOdometry | None = None

    def look_again(frame: StereoFrame, felt: Felt) -> None:
        nonlocal blind_feet
        if blind_feet is None:
            first = truth[-1] if truth else None
            initial = Pose.of(first.position_in_world, [1.0, 0.0, 0.0, 0.0]) if first else Pose.identity()
            blind_feet = StereoInertialOdometry(
                calibration=StereoCalibration.of_robot(robot), imu=robot.imu, initial=initial
            )
        estimate = blind_feet.step(frame, felt.imu)
        if estimate.quality is not OdometryQuality.INITIALISING:
            alone.append(estimate)

    run.on_picture = look_again
    stuck = ""
    begin = run.clock.now_ns()
    try:
        walk_waypoints(run, waypoints, estimates, truth)
    except StuckError as why:
        stuck = str(why)
    finally:
        run.close()
    return DriftRun(
        world=world,
        seed=seed,
        seconds=(run.clock.now_ns() - begin) * 1e-9,
        stuck=stuck,
        with_contacts=_judge(estimates, truth),
        without_contacts=_judge(alone, truth),
    )


def walk_waypoints(
    run: LockStep, waypoints: tuple[Waypoint, ...], estimates: list[OdometryEstimate], truth: list[TruthState]
) -> float:
    """Stand up and walk; simulated seconds on the way. Raises StuckError when the last waypoint is not reached."""

    def step() -> str:
        moment = run.step()
        if moment.truth is not None:
            truth.append(moment.truth)
        if moment.vision is not None and moment.vision.odometry.quality is not OdometryQuality.INITIALISING:
            estimates.append(moment.vision.odometry)
        return moment.walk.walk.posture

    step()
    for command in (CommandName.TAKE_CONTROL, CommandName.STAND):
        _must(run.operator.send(command))
    _must(run.operator.send(CommandName.SET_MISSION, waypoints=waypoints))
    for _ in range(round(STAND_SECONDS * CONTROL_RATE)):
        if step() == "standing":
            break
    _must(run.operator.send(CommandName.START_MISSION))
    begin = run.clock.now_ns()
    longest = np.linalg.norm(np.diff([(0.0, 0.0), *((w.x, w.y) for w in waypoints)], axis=0), axis=1).sum() / SLOWEST
    place, left = truth[-1].position_in_world, run.clock.now_ns()
    for _ in range(round(float(longest) * CONTROL_RATE)):
        step()
        now_ns = run.clock.now_ns()
        mission = run.walk.desk.mission(now_ns)
        if mission.phase == "done":
            return (now_ns - begin) * 1e-9
        if np.linalg.norm(truth[-1].position_in_world - place) > HELD_WITHIN:
            place, left = truth[-1].position_in_world, now_ns
        elif now_ns - left > HELD_SECONDS * 1e9:
            where = ", ".join(f"{metres:.2f}" for metres in place[:2])
            raise StuckError(
                f"the robot stayed {HELD_SECONDS:.0f} s at ({where}) m, {mission.distance_left:.2f} m before its end"
            )
    raise StuckError(f"the robot did not reach its last waypoint within {longest:.0f} simulated seconds")


def _judge(estimates: list[OdometryEstimate], truth: list[TruthState]) -> DriftErrors:
    true = true_trajectory(truth)
    estimates = [e for e in estimates if e.stamp_ns <= true.stamp_ns[-1]]
    estimated = Trajectory.of([e.stamp_ns for e in estimates], [e.world_from_body for e in estimates])
    errors = evaluate(estimated, true)
    # Where the robot woke up defines the odometry's world: the truth's is laid over it there.
    truth_from_world = same_heading(estimates[0].world_from_body, true.pose_at(estimates[0].stamp_ns))
    last = estimates[-1]
    in_world = truth_from_world.inverse() @ true.pose_at(last.stamp_ns)
    return DriftErrors(
        drift_percent=errors.drift_percent,
        final_error=errors.final_error,
        ate_m=errors.ate_m,
        path_length=errors.path_length,
        final_rotation_deg=errors.final_rotation_deg,
        normalised_error=normalised_error(last.world_from_body, in_world, last.covariance),
        good_percent=100.0 * sum(e.quality is OdometryQuality.GOOD for e in estimates) / len(estimates),
    )


def true_trajectory(truth: list[TruthState]) -> Trajectory:
    return Trajectory(
        stamp_ns=np.array([t.stamp_ns for t in truth], dtype=np.int64),
        position=np.array([t.position_in_world for t in truth]),
        wxyz=np.array([t.wxyz for t in truth]),
    )


def _must(answer: Answer) -> None:
    if not answer.accepted:
        raise StuckError(f"the robot refused: {answer.reason}")
