"""Disparities become the highest point of each world cell, and what can not be ground is left out."""

import numpy as np
import pytest

from robot_agent.perception.disparity_grid import SUBPIXELS, DisparityGrid
from robot_agent.perception.working_camera import WorkingCamera
from robot_agent.vision.camera import StereoCalibration
from robot_agent.vision.rectification import Rectifier
from weaver_shared.config.perception import GridConfig, MatchingConfig
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose, rotation_from_rpy

CAMERA = WorkingCamera.of(Rectifier(StereoCalibration.of_robot(load_robot()), 0.5))
CONFIG = GridConfig()
MATCHING = MatchingConfig()
LEVEL = (0.0, 0.0, 0.0)


def body(roll=0.02, pitch=-0.05, yaw=0.4):
    return Pose(rotation=rotation_from_rpy(roll, pitch, yaw), position=np.array([1.3, -0.7, 0.165]))


def depths_of_plane(world_from_camera, height):
    columns, rows = CAMERA.ray_slopes()
    rays = np.stack([*np.meshgrid(columns, rows), np.ones((CAMERA.height, CAMERA.width))], axis=-1)
    falling = (rays @ world_from_camera.rotation.T)[..., 2]
    return np.where(falling < -0.05, (height - world_from_camera.position[2]) / np.minimum(falling, -0.05), np.nan)


def disparity_of(depth):
    exact = CAMERA.focal_length * CAMERA.baseline / depth * SUBPIXELS
    return np.where(np.isfinite(exact), np.rint(np.nan_to_num(exact)), -1).astype(np.int16)


def fuse(disparity, world_from_camera, config=CONFIG):
    return DisparityGrid(CAMERA, config, MATCHING).fuse(disparity, world_from_camera, LEVEL)


def known(grid):
    rows, columns = np.nonzero(np.isfinite(grid.elevation))
    x, y = (grid.row0 + rows + 0.5) * grid.cell, (grid.column0 + columns + 0.5) * grid.cell
    return x, y, grid.elevation[rows, columns], np.sqrt(grid.variance[rows, columns])


def test_a_plane_seen_by_a_tilted_body_is_level_in_the_world():
    pose = body() @ CAMERA.body_from_camera
    x, y, z, sigma = known(fuse(disparity_of(depths_of_plane(pose, 0.03)), pose))
    assert len(z) > 1500
    assert np.abs(z - 0.03).max() < 0.006  # a sixteenth of a pixel at the far end
    assert (np.hypot(x - pose.position[0], y - pose.position[1]) < CONFIG.reach + CONFIG.cell).all()
    assert 0.0005 < np.median(sigma) < 0.01


def test_the_kernel_finds_the_same_tops_as_plain_numpy():
    pose = body() @ CAMERA.body_from_camera
    rng = np.random.default_rng(0)
    depth = depths_of_plane(pose, 0.0) * rng.uniform(0.93, 1.0, (CAMERA.height, CAMERA.width))
    disparity = disparity_of(depth)
    config = CONFIG.model_copy(update={"companions": 0, "min_points": 1, "height_gate": 9.0, "top_band": 1e-4})
    grid = fuse(disparity, pose, config)

    valid = disparity >= 6 * SUBPIXELS
    valid[:3] = valid[-3:] = False
    columns, rows = CAMERA.ray_slopes()
    z = CAMERA.focal_length * CAMERA.baseline * SUBPIXELS / disparity[valid]
    v, u = np.nonzero(valid)
    points = pose.transform(np.column_stack([columns[u] * z, rows[v] * z, z]))
    points = points[np.hypot(*(points - pose.position)[:, :2].T) <= config.reach]
    top = np.full(grid.elevation.shape, -np.inf)
    i, j = (np.floor(points[:, :2] / config.cell).astype(int) - [grid.row0, grid.column0]).T
    np.maximum.at(top, (i, j), points[:, 2])
    assert (np.isfinite(top) == np.isfinite(grid.elevation)).all()
    assert grid.elevation[np.isfinite(top)] == pytest.approx(top[np.isfinite(top)], abs=1e-4)


def test_points_far_from_where_ground_can_be_are_left_out():
    pose = body() @ CAMERA.body_from_camera
    disparity = disparity_of(depths_of_plane(pose, 0.0))
    grid = DisparityGrid(CAMERA, CONFIG, MATCHING)
    for height in (-1.0, 1.0):
        assert np.isnan(grid.fuse(disparity, pose, (0.0, 0.0, height)).elevation).all()
    assert np.isfinite(grid.fuse(disparity, pose, (0.0, 0.0, 0.1)).elevation).any()


def test_a_lonely_height_is_dropped():
    pose = body() @ CAMERA.body_from_camera
    disparity = disparity_of(depths_of_plane(pose, 0.0))
    disparity[150:152, 160:162] = disparity[150, 160] + 12 * SUBPIXELS
    *_, z, _ = known(fuse(disparity, pose))
    assert z.max() < 0.01


def test_ground_too_near_to_be_matched_is_no_pit():
    """Where a sitting robot looks at its own feet the right disparity lies beyond the search: any found is wrong."""
    sitting = Pose(rotation=rotation_from_rpy(0.0, 0.0, 0.4), position=np.array([1.3, -0.7, 0.0]))
    pose = sitting @ CAMERA.body_from_camera
    disparity = disparity_of(depths_of_plane(pose, 0.0))
    too_near = disparity > (MATCHING.disparities - 1) * SUBPIXELS
    assert too_near.mean() > 0.3
    # Patches of one wrong disparity, as a matcher makes them: large enough to keep each other company.
    wrong = np.random.default_rng(0).integers(6 * SUBPIXELS, 63 * SUBPIXELS, (CAMERA.height // 12, CAMERA.width // 16))
    disparity[too_near] = np.kron(wrong, np.ones((12, 16), dtype=np.int16))[too_near]
    *_, z, _ = known(fuse(disparity, pose))
    assert len(z) > 1500
    assert np.abs(z).max() < 0.01


def test_a_pit_ahead_is_still_seen():
    pose = body() @ CAMERA.body_from_camera
    z = known(fuse(disparity_of(depths_of_plane(pose, -0.15)), pose))[2]
    assert len(z) > 1000
    assert np.abs(z + 0.15).max() < 0.01


def test_no_disparity_gives_no_ground():
    pose = body() @ CAMERA.body_from_camera
    grid = fuse(np.full((CAMERA.height, CAMERA.width), -16, dtype=np.int16), pose)
    assert np.isnan(grid.elevation).all()
    assert np.isnan(grid.at(np.array([pose.position[0]]), np.array([pose.position[1]]))[0]).all()
    assert np.isnan(grid.at(np.array([99.0]), np.array([0.0]))[0]).all()
