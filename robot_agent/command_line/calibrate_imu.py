"""`weaver calibrate imu DIR`: where the IMU stands from the cameras, and how late their pictures are."""

from __future__ import annotations

import argparse
import json
import sys
from typing import Any

import numpy as np

from robot_agent.calibration.inertial_calibration import InertialEstimate, calibrate_imu
from robot_agent.calibration.kalibr_files import read_imu, read_target, write_camchain, write_imu
from robot_agent.calibration.pictures import Pictures, open_pictures
from robot_agent.calibration.report import inertial_sections, write_report
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.verdicts import Verdict, judge_imu
from robot_agent.command_line.calibrate_cameras import look_with_progress, output_folder
from robot_agent.vision.camchain import read_chain
from weaver_shared.errors import InputError


def run(options: argparse.Namespace) -> int:
    target, imu = read_target(options.target), read_imu(options.imu)
    rig = Rig.of(read_chain(options.cameras).cameras[:2])
    if not 10.0 <= options.knots <= 200.0:
        raise InputError(f"--knots {options.knots} per second is outside 10 to 200")
    source = open_pictures(options.pictures)
    if source.inertia is None:
        raise InputError(
            f"{options.pictures} has no inertial samples (imu0/data.csv); the camera-IMU part needs the IMU's samples"
        )
    check_sizes(rig, source, str(options.cameras))
    session = look_with_progress(options, target)
    if not options.quiet:
        print(f"{len(session.views)} of {session.pictures} views show the target; solving", file=sys.stderr)

    def tell(step: str) -> None:
        if not options.quiet:
            print(step, file=sys.stderr)

    estimate = calibrate_imu(rig, session.views, target, source.inertia, imu, knots_per_second=options.knots, tell=tell)
    verdict = judge_imu(estimate)
    folder = output_folder(options)
    camera_from_imu = estimate.imu_from_camera.inverse()
    write_camchain(rig, folder / "camchain-imucam.yaml", camera_from_imu, estimate.time_offset)
    write_imu(imu, folder / "imu.yaml")
    write_report("Calibration of cameras and IMU", verdict, inertial_sections(estimate), folder)
    if options.json:
        print(json.dumps(as_json(estimate, verdict)))
        return 0
    x, y, z = 1e3 * estimate.imu_from_camera.position
    print(f"camera in the IMU's frame: {x:.2f}, {y:.2f}, {z:.2f} mm (± {1e3 * estimate.position_sigma.max():.2f})")
    print(
        f"rotation known to {np.degrees(estimate.rotation_sigma.max()):.4f} degrees; IMU time is picture stamp plus "
        f"{1e3 * estimate.time_offset:.4f} ms (± {1e6 * estimate.time_offset_sigma:.1f} us)"
    )
    print(f"{verdict}\nwritten: {folder / 'camchain-imucam.yaml'}, imu.yaml, report.html and report.md beside it")
    return 0


def check_sizes(rig: Rig, source: Pictures, name: str) -> None:
    """Raises InputError where pictures and file can not belong together."""
    if rig.eyes != source.eyes:
        raise InputError(f"{name} has {rig.eyes} cameras, {source.folder} has pictures of {source.eyes}")
    for eye, (size, known) in enumerate(zip(source.sizes(), rig.sizes, strict=True)):
        if size != known:
            raise InputError(
                f"cam{eye} of {name} has {known[0]} x {known[1]} px, the pictures {size[0]} x {size[1]} px"
            )


def as_json(estimate: InertialEstimate, verdict: Verdict) -> dict[str, Any]:
    """T_cam_imu as in Kalibr's file; m, rad, s."""
    return {
        "pictures": estimate.pictures,
        "T_cam_imu": estimate.imu_from_camera.inverse().matrix.tolist(),
        "timeshift_cam_imu": estimate.time_offset,
        "rotation_sigma": estimate.rotation_sigma.tolist(),
        "position_sigma": estimate.position_sigma.tolist(),
        "time_offset_sigma": estimate.time_offset_sigma,
        "gyro_bias": estimate.gyro_bias.tolist(),
        "accel_bias": estimate.accel_bias.tolist(),
        "gravity_in_target": estimate.gravity_in_target.tolist(),
        "target_scale": estimate.target_scale,
        "corner_rms_px": float(np.sqrt((estimate.corner_errors**2).sum(axis=1).mean())),
        "gyro_noise_ratio": float(np.sqrt((estimate.gyro_errors**2).mean())),
        "accel_noise_ratio": float(np.sqrt((estimate.accel_errors**2).mean())),
        "usable": verdict.usable,
        "faults": list(verdict.faults),
        "doubts": list(verdict.doubts),
    }
