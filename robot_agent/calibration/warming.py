"""Compile the calibration's kernels ahead, on a made-up rig that looks at a target for two seconds."""

from __future__ import annotations

import numpy as np

from robot_agent.calibration.inertial_calibration import calibrate_imu
from robot_agent.calibration.lens import project_points
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.sightings import Sighting, View
from robot_agent.calibration.target import AprilGrid
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose, rotation_exp


def warm_up() -> None:
    grid = AprilGrid(columns=2, rows=2, tag_size=0.1, spacing=0.3)
    lens = np.array([200.0, 200.0, 160.0, 120.0, 0.0, 0.0, 0.0, 0.0])
    rig = Rig(models=("radtan",), intrinsics=lens[None], eye_from_first=(Pose.identity(),), sizes=((320, 240),))
    facing, middle = np.diag([1.0, -1.0, -1.0]), np.array([*grid.size, 0.0]) / 2.0
    above = np.array([0.0, 0.0, 0.6])
    times = np.arange(0.0, 2.0, 0.005)
    turns = 0.2 * np.sin(np.outer(times, [4.0, 5.0, 6.0]))
    poses = [Pose(rotation=facing @ rotation_exp(turn), position=middle + above) for turn in turns]
    views = []
    for k in range(10, len(times) - 10, 10):
        pixels, _, _ = project_points(1, lens, poses[k].inverse().transform(grid.points))
        sighting = Sighting(corners=np.arange(len(pixels)), pixels=pixels)
        views.append(View(stamp_ns=int(1e9 * times[k]), eyes=(sighting,)))
    imu = ImuBatch(
        stamp_ns=np.rint(1e9 * times).astype(np.int64),
        angular_velocity_in_imu=0.2 * np.array([4.0, 5.0, 6.0]) * np.cos(np.outer(times, [4.0, 5.0, 6.0])),
        specific_force_in_imu=np.array([pose.rotation.T @ (0.0, GRAVITY, 0.0) for pose in poses]),
    )
    calibrate_imu(rig, views, grid, imu, load_robot("weaver").imu, knots_per_second=20.0)
