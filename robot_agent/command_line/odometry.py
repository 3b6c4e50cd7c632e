"""`weaver odometry DIR` or `FILE.mcap`: run the robot's odometry over a stereo-inertial recording."""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from tqdm import tqdm

from robot_agent.evaluation.asl_recording import AslRecording, open_asl
from robot_agent.evaluation.contact_recording import (
    ContactRecording,
    is_contact_recording,
    open_contacts,
    read_contacts,
)
from robot_agent.evaluation.evo_metrics import evo_errors
from robot_agent.evaluation.odometry_plots import draw
from robot_agent.evaluation.robot_recording import RobotRecording, open_robot_recording
from robot_agent.evaluation.track_recording import TrackRecording, open_tracks
from robot_agent.evaluation.trajectory import Trajectory, evaluate, path_length, read_tum, write_tum
from robot_agent.odometry import OwnLegs, RecordedTracks, StereoInertialOdometry, warm_up
from robot_agent.recording import is_recording
from robot_agent.vision.camchain import read_camchain_on_imu
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import FailureConfig, FeetConfig, OdometryConfig, StartConfig, WindowConfig
from weaver_shared.errors import InputError
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.messages import OdometryEstimate, OdometryQuality, StereoFrame
from weaver_shared.transforms import Pose, rotation_log


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    cv2.setNumThreads(1)
    recording, odometry = _source(options)
    truth = read_tum(options.groundtruth) if options.groundtruth else None
    if truth is None and isinstance(recording, AslRecording | RobotRecording):
        truth = recording.truth
    warm_up()
    estimates, milliseconds = _run(recording, odometry, options)
    trajectory = Trajectory.of([e.stamp_ns for e in estimates], [e.world_from_body for e in estimates])
    if options.out:
        try:
            write_tum(options.out, trajectory)
        except OSError as error:
            raise InputError(f"trajectory {options.out} can not be written: {error}") from error
    if options.plots:
        draw(options.plots, estimates, trajectory, truth)
    report = _report(estimates, milliseconds, trajectory, truth) | {
        "contacts": _has_contacts(recording, options),
        "gyro_bias_sigma": odometry.bias_sigmas[:3].tolist(),
        "accel_bias_sigma": odometry.bias_sigmas[3:].tolist(),
        "time_offset_s": odometry.time_offset,
        "mounting_turn_deg": np.degrees(rotation_log(odometry.mounting.rotation)).tolist(),
        "mounting_shift_m": odometry.mounting.position.tolist(),
    }
    if options.json:
        print(json.dumps(report))
    else:
        _print(report, truth is not None)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver odometry",
        description="Stereo-inertial odometry over a recording; lengths in m, angles in degrees.",
    )
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument(
        "folder",
        metavar="DIR",
        type=Path,
        nargs="?",
        help="EuRoC/ASL folder (mav0/cam0, cam1, imu0), one of inertia and feet alone (imu.csv, contacts.csv), "
        "or a robot's own recording (.mcap)",
    )
    source.add_argument("--tracks", metavar="FILE", type=Path, help="CSV of one camera's feature tracks and inertia")
    parser.add_argument("--groundtruth", metavar="FILE", type=Path, help="true poses in TUM format, s and m")
    parser.add_argument(
        "--calibration", metavar="FILE", type=Path, help="Kalibr's camchain.yaml with T_cam_imu, instead of DIR's own"
    )
    parser.add_argument(
        "--contacts",
        action="store_true",
        help="also walk on the feet: those of a robot's own recording, or of DIR's contacts.csv (body frame, m)",
    )
    parser.add_argument(
        "--out", "--output", metavar="FILE", type=Path, help="write the trajectory in TUM format, s and m"
    )
    parser.add_argument("--plots", metavar="DIR", type=Path, help="write plots of the path (m) and its errors (mm)")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser


SPARSE = OdometryConfig(
    window=WindowConfig(keyframes=12, iterations=3, pixel_sigma=1.2, gate=8.0, parallax=0.01, correlation=0.0),
    failure=FailureConfig(good_features=15),
)
"""For tracks of one eye, twenty a frame and 1.3 px noisy: more keyframes, and observations given up later."""

STRIDING = OdometryConfig(
    start=StartConfig(moving_velocity_sigma=1.0),
    feet=FeetConfig(
        settling=0.0,
        slip_way=0.01,
        slip_speed=0.3,
        reading_sigma=0.01,
        slip_density=0.03,
        longest_guess=1.0,
        guess_speed=0.3,
    ),
)
"""For a trotting quadruped whose feet are told ten times a second: two stand at a time, and further from where they
are said to be."""


Recording = AslRecording | RobotRecording | TrackRecording | ContactRecording


def _source(options: argparse.Namespace) -> tuple[Recording, StereoInertialOdometry]:
    if options.tracks:
        return _tracks(options.tracks)
    if is_recording(options.folder):
        return _pictures(open_robot_recording(options.folder), options.calibration)
    if options.folder.is_dir() and is_contact_recording(options.folder) and not (options.folder / "mav0").is_dir():
        return _feet(options.folder)
    if options.contacts and not (options.folder / "contacts.csv").is_file():
        raise InputError(f"{options.folder} has no contacts.csv: leave --contacts out to go by pictures and inertia")
    return _pictures(open_asl(options.folder), options.calibration)


def _has_contacts(recording: Recording, options: argparse.Namespace) -> bool:
    return isinstance(recording, ContactRecording) or bool(options.contacts)


def _feet(folder: Path) -> tuple[ContactRecording, StereoInertialOdometry]:
    recording = open_contacts(folder)
    odometry = StereoInertialOdometry(
        calibration=recording.calibration,
        imu=recording.imu,
        initial=Pose.identity(),
        config=STRIDING,
        body_from_imu=recording.body_from_imu,
    )
    return recording, odometry


def _pictures(
    recording: AslRecording | RobotRecording, calibration: Path | None
) -> tuple[Recording, StereoInertialOdometry]:
    if calibration is not None:
        recording = replace(recording, calibration=_on_body(read_camchain_on_imu(calibration), recording))
    odometry = StereoInertialOdometry(
        calibration=recording.calibration,
        imu=recording.imu,
        initial=Pose.identity(),
        body_from_imu=recording.body_from_imu,
    )
    return recording, odometry


def _on_body(pair: StereoCalibration, recording: AslRecording | RobotRecording) -> StereoCalibration:
    """A calibration on the IMU, carried to the recording's body."""
    left, right = (
        replace(eye, body_from_camera=recording.body_from_imu @ eye.body_from_camera) for eye in (pair.left, pair.right)
    )
    return replace(pair, left=left, right=right)


def _tracks(path: Path) -> tuple[TrackRecording, StereoInertialOdometry]:
    recording = open_tracks(path)
    odometry = StereoInertialOdometry(
        calibration=recording.calibration,
        imu=recording.imu,
        initial=Pose.identity(),
        config=SPARSE,
        body_from_imu=Pose.identity(),
        front_end=RecordedTracks(recording.sightings, recording.calibration.left.fx),
    )
    return recording, odometry


def _run(
    recording: Recording, odometry: StereoInertialOdometry, options: argparse.Namespace
) -> tuple[list[OdometryEstimate], list[float]]:
    estimates: list[OdometryEstimate] = []
    milliseconds: list[float] = []
    felt = _feet_of(recording, options)
    for item in tqdm(recording, desc="odometry", unit=" frames", file=sys.stderr, disable=options.quiet):
        frame, inertia, *rest = item
        contacts = rest[0] if rest else felt
        felt = None  # the stream keeps all there is for the pictures to come
        begin = time.process_time()
        estimates.append(odometry.step(frame, inertia, contacts, _legs_in(recording, frame)))
        milliseconds.append(1e3 * (time.process_time() - begin))
    return estimates, milliseconds


def _legs_in(recording: Recording, frame: StereoFrame) -> OwnLegs | None:
    """The robot's own legs as they were when a pair was taken; only its own recordings tell."""
    if not isinstance(recording, RobotRecording):
        return None
    return OwnLegs.of(recording.recording.robot, recording.legs_up_to(frame.stamp_ns))


def _feet_of(recording: Recording, options: argparse.Namespace) -> FootContacts | None:
    """What the feet felt in a recording of pictures, if they are asked for."""
    if not options.contacts:
        return None
    if isinstance(recording, RobotRecording):
        return recording.contacts
    return read_contacts(options.folder / "contacts.csv") if isinstance(recording, AslRecording) else None


def _report(
    estimates: list[OdometryEstimate], milliseconds: list[float], trajectory: Trajectory, truth: Trajectory | None
) -> dict[str, Any]:
    last = estimates[-1]
    report: dict[str, Any] = {
        "frames": len(estimates),
        "good_frames": sum(e.quality is OdometryQuality.GOOD for e in estimates),
        "lost_frames": sum(e.quality is OdometryQuality.LOST for e in estimates),
        "estimated_path_length": path_length(trajectory.position),
        "final_position": trajectory.position[-1].tolist(),
        "quality": str(last.quality),
        "reason": last.reason,
        "gyro_bias": last.gyro_bias.tolist(),
        "accel_bias": last.accel_bias.tolist(),
        "position_sigma": np.sqrt(np.diag(last.covariance)[3:]).tolist(),
        "ms_per_frame": {
            "median": float(np.median(milliseconds)),
            "p95": float(np.percentile(milliseconds, 95)),
        },
        "ate_m": None,
        "drift_percent": None,
        "final_error": None,
        "evo": None,
    }
    if truth is not None:
        evo = evo_errors(trajectory, truth)
        report["evo"] = asdict(evo) if evo is not None else None
        errors = asdict(evaluate(trajectory, truth))
        report |= {key: None if isinstance(x, float) and math.isnan(x) else x for key, x in errors.items()}
    return report


def _print(report: dict[str, Any], compared: bool) -> None:
    ms = report["ms_per_frame"]
    print(f"{report['frames']} frames, {report['good_frames']} good, {ms['median']:.1f} ms a frame (median, CPU)")
    if report["reason"]:
        print(f"at the end {report['quality']}: {report['reason']}")
    if not compared:
        print("no ground truth: no errors to report")
        return
    drift = "standing" if report["drift_percent"] is None else f"{report['drift_percent']:.2f} % drift"
    print(f"ATE {report['ate_m']:.4f} m over {report['path_length']:.2f} m")
    print(f"final error {report['final_error']:.4f} m, {drift}")
    print(f"gravity {report['gravity_error_deg']:.2f} degrees off (median)")
