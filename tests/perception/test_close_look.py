"""A close look sees the same ground as the working one, finer and surer; it is refused for the same reasons."""

import dataclasses

import numpy as np
import pytest
from raycast_scene import Scene, odometry_at, standing

from robot_agent.mapping import TerrainMap
from robot_agent.perception import CloseLook, TerrainPerception
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.messages import OdometryQuality
from weaver_shared.robots import load_robot

BLOCK = 0.125  # m, edges along those of the cells


def blocks(x, y):
    heights = np.random.default_rng(3).uniform(-0.05, 0.05, (40, 40))
    rows, columns = (np.floor(x / BLOCK).astype(int) + 4) % 40, (np.floor(y / BLOCK).astype(int) + 16) % 40
    return np.where(x > 0.5, heights[rows, columns], 0.0)


@pytest.fixture(scope="module")
def perception():
    return TerrainPerception(StereoCalibration.of_robot(load_robot()))


@pytest.fixture(scope="module")
def frame():
    return Scene.of(blocks).frame(standing())


@pytest.fixture(scope="module")
def looks(perception, frame):
    return {closely: perception.step(frame, odometry_at(standing()), closely=closely) for closely in (False, True)}


def errors_on_tops(perceived):
    """Errors and sigmas of cells that lie on one block as a whole."""
    grid = perceived.grid
    rows, columns = np.nonzero(np.isfinite(grid.elevation))
    corners = [
        blocks((grid.row0 + rows + a) * grid.cell, (grid.column0 + columns + b) * grid.cell)
        for a in (0.01, 0.99)
        for b in (0.01, 0.99)
    ]
    level = np.ptp(corners, axis=0) == 0.0
    error = grid.elevation[rows, columns] - corners[0]
    return error[level], np.sqrt(grid.variance[rows, columns])[level]


def test_it_measures_more_cells_with_half_the_error(looks):
    working, close = (errors_on_tops(looks[closely])[0] for closely in (False, True))
    assert len(close) > 1.1 * len(working)
    assert np.median(np.abs(close)) < 0.5 * np.median(np.abs(working))
    assert np.median(np.abs(close)) < 0.001


def test_it_says_how_much_surer_it_is(looks):
    working, close = (np.median(errors_on_tops(looks[closely])[1]) for closely in (False, True))
    assert close < 0.6 * working
    look = CloseLook.of(looks[True])
    assert look.cells == np.isfinite(looks[True].grid.elevation).sum()
    assert look.sigma == pytest.approx(close, rel=0.3)
    assert look.reason == ""


def test_the_map_takes_it_as_one_more_picture(looks):
    terrain_map, odometry = TerrainMap(), odometry_at(standing())
    medians = []
    for closely in (False, True):
        terrain_map.update(looks[closely], odometry)
        grid = terrain_map.grid
        rows, columns = np.nonzero(np.isfinite(grid.elevation))
        x = ((rows - grid.row0) % grid.size + grid.row0 + 0.5) * grid.cell
        y = ((columns - grid.column0) % grid.size + grid.column0 + 0.5) * grid.cell
        medians.append(np.median(np.abs(grid.elevation[rows, columns] - blocks(x, y))))
    assert medians[1] < 0.6 * medians[0]


def test_pictures_are_judged_by_the_same_measure(looks):
    working, close = looks[False].health, looks[True].health
    for measure in ("contrast", "sharpness", "consistency", "density", "score"):
        assert getattr(close, measure) == pytest.approx(getattr(working, measure), rel=0.05), measure


def test_a_black_eye_or_a_lost_pose_is_refused_with_its_reason(perception, frame):
    black = dataclasses.replace(frame, right=np.zeros_like(frame.right))
    look = CloseLook.of(perception.step(black, odometry_at(standing()), closely=True))
    assert look.cells == 0
    assert "contrast" in look.reason
    lost = odometry_at(standing(), OdometryQuality.LOST)
    assert CloseLook.of(perception.step(frame, lost, closely=True)).reason == "the pose is lost"
