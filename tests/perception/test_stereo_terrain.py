"""Perception of ray-cast pictures: flat reads flat, rough reads rough, and bad pictures read as nothing."""

import dataclasses

import cv2
import numpy as np
import pytest
from raycast_scene import Scene, odometry_at, standing

from robot_agent.perception import TerrainPerception
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.perception import PerceptionConfig
from weaver_shared.messages import OdometryQuality
from weaver_shared.robots import load_robot
from weaver_shared.transforms import rotation_y

CALIBRATION = StereoCalibration.of_robot(load_robot())


def blocks(x, y):
    heights = np.random.default_rng(3).uniform(-0.05, 0.05, (40, 40))
    rows, columns = (np.floor(8.0 * x).astype(int) + 4) % 40, (np.floor(8.0 * y).astype(int) + 16) % 40
    return np.where(x > 0.5, heights[rows, columns], 0.0)


def ramp(x, y):
    return np.where(x > 0.4, (x - 0.4) * np.tan(np.deg2rad(10.0)), 0.0)


@pytest.fixture(scope="module")
def scenes():
    return {"flat": Scene.of(lambda x, y: 0.0 * x), "ramp": Scene.of(ramp), "blocks": Scene.of(blocks)}


@pytest.fixture(scope="module")
def flat_frame(scenes):
    return scenes["flat"].frame(standing())


def perceive(frame, pose=None, config=None, quality=OdometryQuality.GOOD, ground_height=None):
    perception = TerrainPerception(CALIBRATION, config or PerceptionConfig())
    return perception.step(frame, odometry_at(pose or standing(), quality), ground_height)


def error_of(perceived, elevation):
    grid = perceived.grid
    rows, columns = np.nonzero(np.isfinite(grid.elevation))
    x, y = (grid.row0 + rows + 0.5) * grid.cell, (grid.column0 + columns + 0.5) * grid.cell
    return np.abs(grid.elevation[rows, columns] - elevation(x, y))


def test_ground_is_sought_where_the_feet_stand(flat_frame):
    known = [np.isfinite(perceive(flat_frame, ground_height=z).grid.elevation).sum() for z in (None, 0.0, -0.9)]
    assert known[0] == known[1] > 2500
    assert known[2] == 0


def test_flat_ground_reads_flat(flat_frame):
    perceived = perceive(flat_frame)
    estimate, error = perceived.estimate, error_of(perceived, lambda x, y: 0.0 * x)
    assert estimate.roughness < 0.05
    assert estimate.step_height < 0.05
    assert estimate.plane_normal_in_world[2] > np.cos(np.deg2rad(0.5))
    assert estimate.health > 0.9
    assert len(error) > 2500
    assert np.median(error) < 0.003
    assert np.quantile(error, 0.95) < 0.008


def test_flat_ground_is_level_though_the_body_is_tilted(scenes):
    pose = standing(rotation=rotation_y(0.1))
    estimate = perceive(scenes["flat"].frame(pose), pose).estimate
    assert estimate.roughness < 0.05
    assert estimate.plane_normal_in_world[2] > np.cos(np.deg2rad(0.7))


def test_a_ramp_is_tilted_and_not_rough(scenes):
    pose = standing(x=0.25)
    estimate = perceive(scenes["ramp"].frame(pose), pose).estimate
    tilt = np.degrees(np.arctan2(-estimate.plane_normal_in_world[0], estimate.plane_normal_in_world[2]))
    assert tilt == pytest.approx(10.0, abs=1.0)
    assert estimate.roughness < 0.1


def test_blocks_read_rough_and_high(scenes):
    pose = standing(x=0.2)
    perceived = perceive(scenes["blocks"].frame(pose), pose)
    assert perceived.estimate.roughness > 0.6
    assert perceived.estimate.step_height > 0.35
    assert np.median(error_of(perceived, blocks)) < 0.006


def test_paper_mode_takes_no_noise_off(flat_frame):
    literal = perceive(flat_frame, config=PerceptionConfig(mode="paper")).estimate
    assert literal.roughness > perceive(flat_frame).estimate.roughness


def black_eye(frame):
    return dataclasses.replace(frame, right=np.zeros_like(frame.right))


def constant(frame):
    return dataclasses.replace(frame, left=np.full_like(frame.left, 90), right=np.full_like(frame.right, 90))


def swapped(frame):
    return dataclasses.replace(frame, left=frame.right, right=frame.left)


def fog(frame):
    grey = [np.rint(0.03 * picture.astype(float) + 180.0).astype(np.uint8) for picture in (frame.left, frame.right)]
    return dataclasses.replace(frame, left=grey[0], right=grey[1])


def rows_apart(frame):
    return dataclasses.replace(frame, right=np.roll(frame.right, 4, axis=0))


@pytest.mark.parametrize("spoil", [black_eye, constant, swapped, fog, rows_apart])
def test_spoiled_pictures_are_unknown_ground_with_a_reason(flat_frame, spoil):
    perceived = perceive(spoil(flat_frame))
    assert np.isnan(perceived.estimate.roughness)
    assert np.isnan(perceived.estimate.step_height)
    assert np.isnan(perceived.grid.elevation).all()
    assert perceived.estimate.health < 0.3
    assert perceived.estimate.reason


def test_motion_blur_lowers_the_health(flat_frame):
    scores = [perceive(flat_frame).health.score]
    for length in (15, 25, 41):
        blurred = [cv2.blur(picture, (length, 1)) for picture in (flat_frame.left, flat_frame.right)]
        perceived = perceive(dataclasses.replace(flat_frame, left=blurred[0], right=blurred[1]))
        scores.append(perceived.health.score)
    assert scores == sorted(scores, reverse=True)
    assert scores[-1] < 0.5 * scores[0]
    assert perceived.health.reason == "the pictures are blurred"


def test_a_lost_pose_gives_no_ground(flat_frame):
    perceived = perceive(flat_frame, quality=OdometryQuality.LOST)
    assert np.isnan(perceived.grid.elevation).all()
    assert "lost" in perceived.estimate.reason
