"""`weaver bench terrain`: milliseconds of one thread for matching, fusion, features and a whole frame."""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.mapping import TerrainMap
from robot_agent.mapping.sliding_features import cell_features
from robot_agent.perception import TerrainPerception
from robot_agent.perception.disparity_grid import LARGEST_DISPARITY, SUBPIXELS, DisparityGrid
from robot_agent.perception.stereo_matching import StereoMatcher
from robot_agent.perception.working_camera import WorkingCamera
from robot_agent.vision.camera import StereoCalibration
from robot_agent.vision.rectification import Rectifier
from weaver_shared.config.mapping import MappingConfig
from weaver_shared.config.perception import PerceptionConfig
from weaver_shared.messages import OdometryEstimate, StereoFrame
from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.transforms import Pose

FUSION_POINTS = 219_500
FEATURE_CELLS = 200
RELIEF = 0.03  # m, amplitude of the made-up ground


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    figures = measure(options.repeats)
    if options.json:
        print(json.dumps(figures))
    else:
        for name, value in figures["ms"].items():
            print(f"{name:10s} {value:7.2f} ms")
    return 0


def measure(repeats: int) -> dict[str, dict[str, float]]:
    """CPU time of this thread in ms, the least of `repeats` runs: what the work costs when nothing else disturbs."""
    robot, config = load_robot(), PerceptionConfig()
    standing = Pose.of([0.0, 0.0, robot.clearance])
    frame = made_up_pair(robot, standing)
    rectifier = Rectifier(StereoCalibration.of_robot(robot), config.matching.scale)
    left, right = rectifier.rectify(frame)
    matcher = StereoMatcher(config.matching)
    perception, terrain_map, odometry = (
        TerrainPerception(StereoCalibration.of_robot(robot)),
        TerrainMap(),
        OdometryEstimate.at_rest(standing),
    )

    def whole_frame(*, closely: bool) -> None:
        terrain_map.update(perception.step(frame, odometry, closely=closely), odometry)

    elevation = np.random.default_rng(0).normal(0.0, 0.01, (FEATURE_CELLS, FEATURE_CELLS)).astype(np.float32)
    variance = np.full_like(elevation, 4e-6)
    mapping = MappingConfig()
    fuse = _fusion(robot, standing, config)
    return {
        "ms": {
            "match": _least_ms(lambda: matcher.match(left, right), repeats),
            "fusion": _least_ms(fuse, repeats),
            "features": _least_ms(lambda: cell_features(elevation, variance, mapping), repeats),
            "frame": _least_ms(lambda: whole_frame(closely=False), repeats),
            "close_look": _least_ms(lambda: whole_frame(closely=True), max(1, repeats // 5)),
        },
        "size": {
            "fusion_points": FUSION_POINTS,
            "feature_cells": FEATURE_CELLS**2,
            "frame_width": rectifier.width,
            "frame_height": rectifier.height,
        },
    }


def made_up_pair(robot: RobotDescription, world_from_body: Pose) -> StereoFrame:
    """A pair of pictures of textured wavy ground: the right eye drawn from the left by its disparity."""
    camera = WorkingCamera.of(Rectifier(StereoCalibration.of_robot(robot)))
    disparity = ground_disparity(camera, world_from_body)
    noise = np.random.default_rng(0).normal(0.0, 1.0, (camera.height, camera.width)).astype(np.float32)
    texture = sum(scale * cv2.GaussianBlur(noise, (0, 0), scale) for scale in (1.5, 4.0, 12.0))
    left = np.clip(127.0 + 30.0 * texture / texture.std(), 0, 255).astype(np.uint8)
    columns, rows = np.meshgrid(np.arange(camera.width), np.arange(camera.height))
    source = (columns + disparity).astype(np.float32)
    right = cv2.remap(left, source, rows.astype(np.float32), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT)
    return StereoFrame(stamp_ns=0, sequence=0, left=left, right=np.asarray(right, dtype=np.uint8))


def ground_disparity(camera: WorkingCamera, world_from_body: Pose) -> NDArray[np.float64]:
    """Disparity in px of every pixel on wavy ground about z = 0; zero above the horizon."""
    world_from_camera = world_from_body @ camera.body_from_camera
    columns, rows = camera.ray_slopes()
    rays = np.stack([*np.meshgrid(columns, rows), np.ones((camera.height, camera.width))], axis=-1)
    rays = rays @ world_from_camera.rotation.T
    falling = np.minimum(rays[..., 2], -0.02)
    depth = -world_from_camera.position[2] / falling
    x, y = depth * rays[..., 0], depth * rays[..., 1]
    depth = -(world_from_camera.position[2] - RELIEF * np.sin(12.0 * x) * np.sin(9.0 * y)) / falling
    return np.where(rays[..., 2] < -0.02, camera.focal_length * camera.baseline / depth, 0.0)


def _fusion(robot: RobotDescription, standing: Pose, config: PerceptionConfig) -> Callable[[], object]:
    """Fusion of exactly FUSION_POINTS points of a full-size picture, without reach or gate leaving any out."""
    camera = WorkingCamera.of(Rectifier(StereoCalibration.of_robot(robot)))
    disparity = np.rint(ground_disparity(camera, standing) * SUBPIXELS).astype(np.int16).ravel()
    usable = np.flatnonzero(disparity > 0)
    disparity[usable[: max(0, len(usable) - FUSION_POINTS)]] = -1
    wide = config.grid.model_copy(update={"reach": 2.0, "height_gate": 10.0})
    everything = config.matching.model_copy(update={"smallest_disparity": 1.0, "disparities": LARGEST_DISPARITY})
    grid = DisparityGrid(camera, wide, everything)
    picture = disparity.reshape(camera.height, camera.width)
    world_from_camera = standing @ camera.body_from_camera
    return lambda: grid.fuse(picture, world_from_camera, (0.0, 0.0, 0.0))


def _least_ms(work: Callable[[], object], repeats: int) -> float:
    work()
    times = []
    for _ in range(repeats):
        begin = time.thread_time_ns()
        work()
        times.append(time.thread_time_ns() - begin)
    return min(times) * 1e-6


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver bench terrain",
        description="CPU milliseconds of one thread: match (320 x 240, 64 disparities), fusion (219 500 points into "
        "2 cm cells), features (200 x 200 cells), frame (rectify, match, judge, fuse, characterise, map), "
        "close_look (the same at full resolution with 128 disparities, which an operator may ask for).",
    )
    parser.add_argument("--repeats", type=int, default=30, help="runs of each, of which the least counts (default 30)")
    parser.add_argument("--json", action="store_true", help="print one JSON object; times in ms")
    return parser
