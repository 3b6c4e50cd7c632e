"""An ASL folder as EuRoC's, of a short walk over made ground whose truth is known."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import yaml
from walking_motion import FRAME_NS, SAMPLE_NS, Walk, inertia

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.evaluation.trajectory import Trajectory, write_tum
from robot_agent.vision.camera import PinholeCamera, StereoCalibration
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

BEGIN_NS = 1_400_000_000_000_000_000
FRAMES = 60


def write_recording(root: Path, robot: RobotDescription, calibration: StereoCalibration) -> Path:
    """mav0/cam0, cam1 and imu0, and groundtruth_tum.txt, under `root`."""
    walk, ground = Walk(), TexturedGround(calibration, seed=4)
    for name, eye in (("cam0", calibration.left), ("cam1", calibration.right)):
        (root / "mav0" / name / "data").mkdir(parents=True)
        (root / "mav0" / name / "sensor.yaml").write_text(_eye(eye))
    (root / "mav0" / "imu0").mkdir()
    (root / "mav0" / "imu0" / "sensor.yaml").write_text(_imu(robot))
    for k in range(1, FRAMES + 1):
        frame = ground.look(k * FRAME_NS, k, walk.body(k * FRAME_NS * 1e-9))
        for name, picture in (("cam0", frame.left), ("cam1", frame.right)):
            cv2.imwrite(str(root / "mav0" / name / "data" / f"{BEGIN_NS + frame.stamp_ns}.png"), picture)
    batch = inertia(walk, robot, 0, FRAMES * FRAME_NS, np.random.default_rng(2))
    # The walk's samples are means over 5 ms; a recording holds instants.
    rows = np.column_stack([batch.angular_velocity_in_imu, batch.specific_force_in_imu])
    middles = batch.stamp_ns - SAMPLE_NS // 2 + BEGIN_NS
    lines = [f"{stamp}," + ",".join(f"{x:.9f}" for x in row) for stamp, row in zip(middles, rows, strict=True)]
    (root / "mav0" / "imu0" / "data.csv").write_text("#timestamp,w,a\n" + "\n".join(lines) + "\n")
    stamps = range(FRAME_NS, FRAMES * FRAME_NS + 1, FRAME_NS)
    truth = Trajectory.of([BEGIN_NS + t for t in stamps], [walk.body(t * 1e-9) for t in stamps])
    write_tum(root / "groundtruth_tum.txt", truth)
    return root


def write_chain(path: Path, robot: RobotDescription, calibration: StereoCalibration, *, with_imu: bool = True) -> Path:
    """The calibration as Kalibr's camchain.yaml."""
    left, right = calibration.left, calibration.right
    chain = {"cam0": _kalibr(left), "cam1": _kalibr(right)}
    right_from_left = right.body_from_camera.inverse() @ left.body_from_camera
    chain["cam1"]["T_cn_cnm1"] = right_from_left.matrix.tolist()
    if with_imu:
        chain["cam0"]["T_cam_imu"] = (left.body_from_camera.inverse() @ robot.imu.body_from_imu).matrix.tolist()
        chain["cam0"]["timeshift_cam_imu"] = 0.0
    path.write_text(yaml.safe_dump(chain))
    return path


def _kalibr(eye: PinholeCamera) -> dict[str, object]:
    return {
        "camera_model": "pinhole",
        "distortion_model": "none",
        "intrinsics": [eye.fx, eye.fy, eye.cx, eye.cy],
        "resolution": [eye.width, eye.height],
    }


def _eye(eye: PinholeCamera) -> str:
    return (
        f"{_mount(eye.body_from_camera)}distortion_model: none\nresolution: [{eye.width}, {eye.height}]\n"
        f"intrinsics: [{eye.fx}, {eye.fy}, {eye.cx}, {eye.cy}]\n"
    )


def _imu(robot: RobotDescription) -> str:
    imu = robot.imu
    return (
        f"{_mount(imu.body_from_imu)}rate_hz: {imu.rate}\n"
        f"gyroscope_noise_density: {imu.gyro_noise_density}\ngyroscope_random_walk: {imu.gyro_random_walk}\n"
        f"accelerometer_noise_density: {imu.accel_noise_density}\naccelerometer_random_walk: {imu.accel_random_walk}\n"
    )


def _mount(body_from_sensor: Pose) -> str:
    numbers = ", ".join(f"{x:.12g}" for x in body_from_sensor.matrix.ravel())
    return f"T_BS:\n  cols: 4\n  rows: 4\n  data: [{numbers}]\n"
