"""One walk seen again and again, each time with another trouble in its pictures: how far off, and back by itself?"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from robot_agent.evaluation.trajectory import Trajectory, same_heading
from robot_agent.felt_queue import Felt
from robot_agent.odometry import StereoInertialOdometry
from robot_agent.vision.camera import StereoCalibration
from sim_agent.drift_study import pattern_of, true_trajectory, walk_waypoints
from sim_agent.lock_step import LockStep
from sim_agent.picture_troubles import BareGround, Moment, PasserBy, Trouble, blurred, dark, dropped, one_eyed
from sim_agent.worlds import make_world
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.leg_batch import LegBatch
from weaver_shared.messages import ImuBatch, OdometryEstimate, OdometryQuality, StereoFrame, TruthState
from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.transforms import Pose

AHEAD = 0.6
"""m before the body, where trouble on the ground lies when it begins."""

SETTLED = 0.5
"""Share of the walk after which troubles begin."""

WHOLE_WALK = 1e3
"""s: a trouble that does not end."""

GOOD, LOST = OdometryQuality.GOOD, OdometryQuality.LOST


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedWalk:
    robot: RobotDescription
    frames: list[StereoFrame]
    felt: list[Felt]
    truth: Trajectory


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """Errors in m of the position, the start's laid on the truth's."""

    trouble: str
    seconds: float  # it lasted
    error_before: float
    error_worst: float
    error_after: float  # when it ended
    error_final: float
    error_final_without: float  # of the same walk without trouble
    recovered: bool  # good at the end, and never lost
    recovery_seconds: float | None  # from its end until good again; None if never
    worst_quality: str
    reasons: list[str]  # that were told meanwhile

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def troubles(calibration: StereoCalibration) -> dict[str, tuple[float, Trouble]]:
    """Seconds it lasts, and what it does, by name."""
    return {
        "darkness": (3.0, dark),
        "one eye": (5.0, one_eyed),
        "dropped frames": (WHOLE_WALK, dropped),
        "bare ground": (WHOLE_WALK, BareGround(calibration, side=1.2)),
        "motion blur": (3.0, blurred),
        "passer-by": (4.0, PasserBy(calibration)),
    }


def record_walk(world: str, seed: int, metres: float) -> RecordedWalk:
    """Walk the world's pattern, shrunk to `metres`, and keep all the odometry is given. Raises StuckError."""
    robot = load_robot()
    run = LockStep(robot, make_world(world, seed), seed)
    frames: list[StereoFrame] = []
    felt: list[Felt] = []
    truth: list[TruthState] = []

    def keep(frame: StereoFrame, part: Felt) -> None:
        frames.append(frame)
        felt.append(part)

    run.on_picture = keep
    try:
        walk_waypoints(run, pattern_of(world, metres), [], truth)
    finally:
        run.close()
    true = true_trajectory(truth)
    covered = [n for n, frame in enumerate(frames) if true.stamp_ns[0] <= frame.stamp_ns <= true.stamp_ns[-1]]
    return RecordedWalk(robot=robot, frames=[frames[n] for n in covered], felt=[felt[n] for n in covered], truth=true)


def suffer(walk: RecordedWalk, seed: int = 1) -> list[Outcome]:
    """Every trouble in turn, on the same walk."""
    calibration = StereoCalibration.of_robot(walk.robot)
    clean = follow(walk, calibration, None, 0.0, seed)
    final = _errors(walk, clean)[-1]
    return [
        _outcome(name, seconds, walk, follow(walk, calibration, trouble, seconds, seed), float(final))
        for name, (seconds, trouble) in troubles(calibration).items()
    ]


def follow(
    walk: RecordedWalk, calibration: StereoCalibration, trouble: Trouble | None, seconds: float, seed: int
) -> list[OdometryEstimate]:
    """The odometry over the walk's pictures with a trouble in the second half of the walk."""
    start = walk.truth.pose_at(walk.frames[0].stamp_ns)
    odometry = StereoInertialOdometry(
        calibration=calibration, imu=walk.robot.imu, initial=Pose(rotation=np.eye(3), position=start.position)
    )
    begin_ns = _begin_ns(walk)
    ahead = walk.truth.pose_at(begin_ns).transform(np.array([[AHEAD, 0.0, 0.0]]))[0, :2]
    random = np.random.default_rng(seed)
    estimates: list[OdometryEstimate] = []
    waiting: list[Felt] = []
    for frame, felt in zip(walk.frames, walk.felt, strict=True):
        waiting.append(felt)
        since = (frame.stamp_ns - begin_ns) * 1e-9
        shown: StereoFrame | None = frame
        if trouble is not None and 0.0 <= since < seconds:
            body = walk.truth.pose_at(frame.stamp_ns)
            shown = trouble(frame, Moment(seconds=since, world_from_body=body, place=ahead, random=random))
        if shown is None:
            continue
        contacts = FootContacts.of(walk.robot, _joined([part.legs for part in waiting]))
        estimates.append(odometry.step(shown, ImuBatch.join([part.imu for part in waiting]), contacts))
        waiting = []
    return estimates


def _begin_ns(walk: RecordedWalk) -> int:
    """When half of the way is walked."""
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(walk.truth.position, axis=0), axis=1))])
    return int(walk.truth.stamp_ns[np.searchsorted(way, SETTLED * way[-1])])


def _errors(walk: RecordedWalk, estimates: list[OdometryEstimate]) -> np.ndarray[Any, np.dtype[np.float64]]:
    told = next(e for e in estimates if e.quality is not OdometryQuality.INITIALISING)
    truth_from_world = same_heading(told.world_from_body, walk.truth.pose_at(told.stamp_ns))
    return np.array(
        [
            np.linalg.norm((truth_from_world @ e.world_from_body).position - walk.truth.pose_at(e.stamp_ns).position)
            for e in estimates
        ]
    )


def _outcome(
    name: str, seconds: float, walk: RecordedWalk, estimates: list[OdometryEstimate], final_without: float
) -> Outcome:
    begin_ns, errors = _begin_ns(walk), _errors(walk, estimates)
    since = np.array([(e.stamp_ns - begin_ns) * 1e-9 for e in estimates])
    during = np.flatnonzero((since >= 0.0) & (since < seconds))
    after = np.flatnonzero(since >= seconds)
    good_again = [since[n] - seconds for n in after if estimates[n].quality is GOOD]
    recovery = 0.0 if not len(after) and estimates[-1].quality is GOOD else (good_again[0] if good_again else None)
    qualities = [estimates[n].quality for n in during]
    lost = any(estimates[n].quality is LOST for n in np.concatenate([during, after]))
    reasons = dict.fromkeys(estimates[n].reason for n in during if estimates[n].reason)
    worst = LOST if LOST in qualities else (next((q for q in qualities if q is not GOOD), GOOD))
    return Outcome(
        trouble=name,
        seconds=float(since[during[-1]] - since[during[0]]),
        error_before=float(errors[during[0]]),
        error_worst=float(errors[during].max()),
        error_after=float(errors[during[-1]]),
        error_final=float(errors[-1]),
        error_final_without=final_without,
        recovered=estimates[-1].quality is GOOD and not lost,
        recovery_seconds=None if recovery is None else float(recovery),
        worst_quality=str(worst),
        reasons=list(reasons)[:5],
    )


def _joined(parts: list[LegBatch]) -> LegBatch:
    parts = [part for part in parts if len(part.stamp_ns)]
    if not parts:
        return LegBatch.empty()
    return LegBatch(
        stamp_ns=np.concatenate([part.stamp_ns for part in parts]),
        joint_position=np.concatenate([part.joint_position for part in parts]),
        joint_torque=np.concatenate([part.joint_torque for part in parts]),
        foot_contact=np.concatenate([part.foot_contact for part in parts]),
    )
