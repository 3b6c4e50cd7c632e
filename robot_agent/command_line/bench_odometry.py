"""`weaver bench odometry`: CPU time per stereo frame, front end and back end apart."""

from __future__ import annotations

import argparse
import json
import time
from typing import Any

import cv2
import numpy as np

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.odometry import StereoInertialOdometry, warm_up
from robot_agent.odometry.front_end import FrontEnd
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import OdometryConfig
from weaver_shared.errors import InputError
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

FRAME_NS, SAMPLE_NS = 50_000_000, 5_000_000
SPEED = 0.2  # m/s
SETTLED = 40  # frames until the window is full


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    if options.frames <= SETTLED:
        raise InputError(f"{options.frames} frames are too few; more than {SETTLED} are needed to fill the window")
    cv2.setNumThreads(1)
    warm_up()
    report = measure(options.frames, options.seed)
    if options.json:
        print(json.dumps(report))
    else:
        for part in ("front_end", "back_end", "frame"):
            ms = report["ms"][part]
            print(f"{part:10s} median {ms['median']:6.2f} ms   p95 {ms['p95']:6.2f} ms")
    return 0


def measure(frames: int, seed: int) -> dict[str, Any]:
    """Walk straight over textured ground for `frames` pairs; CPU times in ms of the frames with a full window."""
    robot = load_robot("weaver")
    calibration = StereoCalibration.of_robot(robot)
    ground = TexturedGround(calibration, seed)
    odometry = StereoInertialOdometry(calibration=calibration, imu=robot.imu, initial=_body(0.0))
    alone = FrontEnd(calibration, OdometryConfig().front_end)  # the same work once more, to know its share
    front_end: list[float] = []
    whole: list[float] = []
    features: list[int] = []
    for k in range(1, frames + 1):
        frame = ground.look(k * FRAME_NS, k, _body(k * FRAME_NS * 1e-9))
        inertia = _inertia(k)
        begin = time.process_time()
        estimate = odometry.step(frame, inertia)
        middle = time.process_time()
        alone.step(frame, _left_motion(calibration, k))
        whole.append(1e3 * (middle - begin))
        front_end.append(1e3 * (time.process_time() - middle))
        features.append(estimate.tracked_features)
    front, total = np.array(front_end[SETTLED:]), np.array(whole[SETTLED:])
    return {
        "ms": {"front_end": _figures(front), "back_end": _figures(total - front), "frame": _figures(total)},
        "frames": len(total),
        "features": float(np.mean(features[SETTLED:])),
        "width": calibration.left.width,
        "height": calibration.left.height,
    }


def _left_motion(calibration: StereoCalibration, k: int) -> Pose:
    """Frame k's left eye from frame k - 1's."""
    before, now = (_body(n * FRAME_NS * 1e-9) @ calibration.left.body_from_camera for n in (k - 1, k))
    return now.inverse() @ before


def _body(t: float) -> Pose:
    """At rest for a second, then straight on, at the height of a standing robot."""
    d = max(0.0, t - 1.0)
    return Pose.of([SPEED * (d - 0.5 * (1.0 - np.exp(-2.0 * d))), 0.0, 0.165])


def _inertia(k: int) -> ImuBatch:
    """Samples between frames k - 1 and k."""
    stamps = np.arange((k - 1) * FRAME_NS + SAMPLE_NS, k * FRAME_NS + 1, SAMPLE_NS, dtype=np.int64)
    d = np.maximum(0.0, stamps * 1e-9 - 0.5 * SAMPLE_NS * 1e-9 - 1.0)
    force = np.zeros((len(stamps), 3))
    force[:, 0] = np.where(d > 0.0, 2.0 * SPEED * np.exp(-2.0 * d), 0.0)
    force[:, 2] = GRAVITY
    return ImuBatch(stamp_ns=stamps, angular_velocity_in_imu=np.zeros((len(stamps), 3)), specific_force_in_imu=force)


def _figures(milliseconds: np.ndarray[Any, np.dtype[np.float64]]) -> dict[str, float]:
    return {"median": float(np.median(milliseconds)), "p95": float(np.percentile(milliseconds, 95))}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver bench odometry",
        description="CPU time per stereo frame (ms) at the robot's picture size, one core.",
    )
    parser.add_argument("--frames", type=int, default=160, help="stereo pairs to run, at 20 Hz (default 160)")
    parser.add_argument("--seed", type=int, default=1, help="of the ground's texture (default 1)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser
