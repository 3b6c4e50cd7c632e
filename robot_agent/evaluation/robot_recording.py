"""A robot's own recording (MCAP) as its odometry had it: pictures, inertia and feet, and a simulated one's truth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from robot_agent.evaluation.asl_recording import inertia_up_to
from robot_agent.evaluation.trajectory import Trajectory
from robot_agent.recording import Recording, open_recording
from robot_agent.vision.camera import StereoCalibration
from weaver_shared import topics
from weaver_shared.errors import InputError
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.leg_batch import LegBatch
from weaver_shared.messages import ImuBatch, Proprioception, StereoFrame, TruthState
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose

OLDEST_NS = 100_000_000
"""Of a reading of the legs that still tells where they are in a picture."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotRecording:
    """What the body felt is in memory; pictures are only loaded when they are asked for."""

    calibration: StereoCalibration
    imu: Imu
    body_from_imu: Pose
    inertia: ImuBatch
    legs: LegBatch
    contacts: FootContacts | None
    truth: Trajectory | None
    picture_ns: NDArray[np.int64]  # (n,) stamps of the pairs
    recording: Recording

    def __len__(self) -> int:
        return len(self.picture_ns)

    def __iter__(self) -> Iterator[tuple[StereoFrame, ImuBatch]]:
        """Each pair with the inertia up to it."""
        parts = inertia_up_to(self.inertia, self.picture_ns.tolist())
        frames = self.recording.messages(topics.STEREO)
        for (_, _, frame), part in zip(frames, parts, strict=True):
            yield frame, part

    def legs_up_to(self, stamp_ns: int) -> LegBatch:
        """The newest reading of the legs when a picture was taken; none where it is older than OLDEST_NS."""
        end = int(np.searchsorted(self.legs.stamp_ns, stamp_ns, side="right"))
        begin = max(end - 1, int(np.searchsorted(self.legs.stamp_ns, stamp_ns - OLDEST_NS)))
        return LegBatch(
            stamp_ns=self.legs.stamp_ns[begin:end],
            joint_position=self.legs.joint_position[begin:end],
            joint_torque=self.legs.joint_torque[begin:end],
            foot_contact=self.legs.foot_contact[begin:end],
        )


def open_robot_recording(path: Path) -> RobotRecording:
    """Raises InputError that says what the file lacks."""
    recording = open_recording(path)
    if not recording.robot.has_camera:
        raise InputError(f"{path} is of the robot {recording.robot.name!r}, which has no camera")
    felt: list[Proprioception] = []
    truth: list[TruthState] = []
    stamps: list[int] = []
    for _, _, message in recording.messages(topics.STEREO, topics.PROPRIOCEPTION, topics.TRUTH):
        match message:
            case StereoFrame():
                stamps.append(message.stamp_ns)
            case Proprioception():
                felt.append(message)
            case TruthState():
                truth.append(message)
    if not stamps:
        raise InputError(f"{path} has no pictures; it was recorded without them, or cut before the first one")
    inertia = _in_order(ImuBatch.join([sensed.imu for sensed in felt]))
    if len(inertia.stamp_ns) < 2:
        raise InputError(f"{path} has no inertial samples")
    robot = recording.robot
    legs = LegBatch.of(sorted(felt, key=lambda sensed: sensed.stamp_ns))
    return RobotRecording(
        calibration=StereoCalibration.of_robot(robot),
        imu=robot.imu,
        body_from_imu=robot.imu.body_from_imu,
        inertia=inertia,
        legs=legs,
        contacts=FootContacts.of(robot, legs),
        truth=_trajectory(truth),
        picture_ns=np.array(stamps, dtype=np.int64),
        recording=recording,
    )


def _in_order(batch: ImuBatch) -> ImuBatch:
    order = np.argsort(batch.stamp_ns, kind="stable")
    return ImuBatch(
        stamp_ns=batch.stamp_ns[order],
        angular_velocity_in_imu=batch.angular_velocity_in_imu[order],
        specific_force_in_imu=batch.specific_force_in_imu[order],
    )


def _trajectory(truth: list[TruthState]) -> Trajectory | None:
    if len(truth) < 2:
        return None
    return Trajectory(
        stamp_ns=np.array([state.stamp_ns for state in truth], dtype=np.int64),
        position=np.array([state.position_in_world for state in truth]),
        wxyz=np.array([state.wxyz for state in truth]),
    )
