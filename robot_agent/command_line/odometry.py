"""`weaver odometry DIR`: run the robot's odometry over a stereo-inertial recording."""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from tqdm import tqdm

from robot_agent.evaluation.asl_recording import AslRecording, open_asl
from robot_agent.evaluation.track_recording import TrackRecording, open_tracks
from robot_agent.evaluation.trajectory import Trajectory, evaluate, read_tum, write_tum
from robot_agent.odometry import RecordedTracks, StereoInertialOdometry, warm_up
from weaver_shared.config.odometry import FailureConfig, OdometryConfig, WindowConfig
from weaver_shared.errors import InputError
from weaver_shared.messages import OdometryEstimate, OdometryQuality
from weaver_shared.transforms import Pose


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    cv2.setNumThreads(1)
    recording, odometry = _tracks(options.tracks) if options.tracks else _pictures(options.folder)
    truth = read_tum(options.groundtruth) if options.groundtruth else None
    if truth is None and isinstance(recording, AslRecording):
        truth = recording.truth
    warm_up()
    estimates, milliseconds = _run(recording, odometry, quiet=options.quiet)
    trajectory = Trajectory.of([e.stamp_ns for e in estimates], [e.world_from_body for e in estimates])
    if options.output:
        try:
            write_tum(options.output, trajectory)
        except OSError as error:
            raise InputError(f"trajectory {options.output} can not be written: {error}") from error
    report = _report(estimates, milliseconds, trajectory, truth)
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
    source.add_argument("folder", metavar="DIR", type=Path, nargs="?", help="EuRoC/ASL folder: mav0/cam0, cam1, imu0")
    source.add_argument("--tracks", metavar="FILE", type=Path, help="CSV of one camera's feature tracks and inertia")
    parser.add_argument("--groundtruth", metavar="FILE", type=Path, help="true poses in TUM format, s and m")
    parser.add_argument("--output", metavar="FILE", type=Path, help="write the trajectory in TUM format, s and m")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser


SPARSE = OdometryConfig(
    window=WindowConfig(keyframes=12, iterations=3, pixel_sigma=1.0, gate=8.0),
    failure=FailureConfig(good_features=15),
)
"""For tracks of one eye, twenty a frame and 1.3 px noisy: more keyframes, and observations given up later."""


def _pictures(folder: Path) -> tuple[AslRecording, StereoInertialOdometry]:
    recording = open_asl(folder)
    odometry = StereoInertialOdometry(
        calibration=recording.calibration,
        imu=recording.imu,
        initial=Pose.identity(),
        body_from_imu=recording.body_from_imu,
    )
    return recording, odometry


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
    recording: AslRecording | TrackRecording, odometry: StereoInertialOdometry, *, quiet: bool
) -> tuple[list[OdometryEstimate], list[float]]:
    estimates: list[OdometryEstimate] = []
    milliseconds: list[float] = []
    for frame, inertia in tqdm(recording, desc="odometry", unit=" frames", file=sys.stderr, disable=quiet):
        begin = time.process_time()
        estimates.append(odometry.step(frame, inertia))
        milliseconds.append(1e3 * (time.process_time() - begin))
    return estimates, milliseconds


def _report(
    estimates: list[OdometryEstimate], milliseconds: list[float], trajectory: Trajectory, truth: Trajectory | None
) -> dict[str, Any]:
    last = estimates[-1]
    report: dict[str, Any] = {
        "frames": len(estimates),
        "good_frames": sum(e.quality is OdometryQuality.GOOD for e in estimates),
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
    }
    if truth is not None:
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
