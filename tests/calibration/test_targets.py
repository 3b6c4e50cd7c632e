"""Targets: Kalibr's numbering, pages in true size, and detectors that find what was printed and drawn."""

from __future__ import annotations

import re

import cv2
import numpy as np
import pytest

from robot_agent.calibration.chessboard_detector import ChessboardDetector
from robot_agent.calibration.grid_detector import GridDetector
from robot_agent.calibration.lens import camera_of
from robot_agent.calibration.tags import tag_cells
from robot_agent.calibration.target import AprilGrid, Checkerboard, Target
from robot_agent.calibration.target_page import PAGES, fitting_board, fitting_grid, target_pdf
from robot_agent.vision.distortion import project
from sim_agent.targets.rendering import TargetRenderer
from weaver_shared.errors import InputError
from weaver_shared.transforms import Pose, rotation_exp

POINT = 0.0254 / 72.0
PIXELS_PER_METRE = 3000.0


def printed(pdf: bytes) -> tuple[np.ndarray, tuple[float, float]]:
    """The page as a printer would fill it: grey picture, and width and height in m."""
    box = re.search(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", pdf)
    assert box is not None
    width, height = (float(x) * POINT for x in box.groups())
    page = np.full((round(height * PIXELS_PER_METRE), round(width * PIXELS_PER_METRE)), 255, dtype=np.uint8)
    for rectangle in re.findall(rb"(-?[\d.]+) (-?[\d.]+) ([\d.]+) ([\d.]+) re", pdf):
        x, y, w, h = (float(number) * POINT for number in rectangle)
        left, right = round(x * PIXELS_PER_METRE), round((x + w) * PIXELS_PER_METRE)
        top, bottom = round((height - y - h) * PIXELS_PER_METRE), round((height - y) * PIXELS_PER_METRE)
        page[top:bottom, left:right] = 0
    return page, (width, height)


def test_corners_are_numbered_from_the_lower_left_row_by_row() -> None:
    grid = AprilGrid(columns=3, rows=2, tag_size=0.1, spacing=0.3)
    assert len(grid.points) == 24
    np.testing.assert_allclose(grid.points[0], 0.0)
    np.testing.assert_allclose(grid.points[6], [0.0, 0.1, 0.0])
    np.testing.assert_allclose(
        grid.points[grid.corners_of(4)][:, :2], [[0.13, 0.13], [0.23, 0.13], [0.23, 0.23], [0.13, 0.23]]
    )


def test_tags_are_the_familys_as_kalibr_prints_them() -> None:
    # The first code of 36h11 is 0xd5d628584, its highest bit at the print's upper left.
    code = 0xD5D628584
    bits = np.array([(code >> (35 - k)) & 1 for k in range(36)]).reshape(6, 6)
    cells = tag_cells(0)
    np.testing.assert_array_equal(cells[::-1][2:8, 2:8], bits)
    assert not cells[:2].any()
    assert not cells[:, -2:].any()


@pytest.mark.parametrize("page", ["a4", "a3", "letter"])
def test_a_printed_grid_is_found_in_true_size(page: str) -> None:
    grid = fitting_grid(page, 6, 6, 0.3)
    picture, size = printed(target_pdf(grid, page))
    assert size == pytest.approx(PAGES[page], abs=1e-5)
    found = GridDetector(grid).detect(picture)
    assert found is not None
    assert len(found) == 4 * grid.tags
    order = np.argsort(found.corners)
    across = found.pixels[order] / PIXELS_PER_METRE * (1.0, -1.0)
    offset = (across - grid.points[:, :2]).mean(axis=0)
    np.testing.assert_allclose(across - offset, grid.points[:, :2], atol=3e-4)


def test_a_printed_chessboard_is_found_in_true_size() -> None:
    board = fitting_board("a4", 6, 9)
    picture, _ = printed(target_pdf(board, "a4"))
    found = ChessboardDetector(board).detect(picture)
    assert found is not None
    assert np.ptp(found.pixels, axis=0) / PIXELS_PER_METRE == pytest.approx(board.size, abs=3e-4)


def test_the_table_of_a_page_points_at_its_objects() -> None:
    pdf = target_pdf(fitting_grid("a4", 3, 3, 0.3), "a4")
    begin = int(re.findall(rb"startxref\n(\d+)", pdf)[0])
    assert pdf[begin : begin + 4] == b"xref"
    for number, offset in enumerate(re.findall(rb"(\d{10}) 00000 n", pdf), 1):
        assert pdf[int(offset) :].startswith(b"%d 0 obj" % number)
    bar = [float(w) * POINT for w in re.findall(rb"re\n[\d.]+ [\d.]+ ([\d.]+) 1\.7008 re", pdf)]
    assert any(abs(length - 0.1) < 1e-6 for length in bar)


@pytest.mark.parametrize(
    ("target", "message"),
    [
        (AprilGrid(columns=6, rows=6, tag_size=0.088, spacing=0.3), "a4 leaves"),
        (Checkerboard(columns=9, rows=6, column_spacing=0.03, row_spacing=0.03), "a4 leaves"),
    ],
)
def test_a_target_larger_than_the_page_is_refused(target: Target, message: str) -> None:
    with pytest.raises(InputError, match=message):
        target_pdf(target, "a4")


def test_impossible_targets_are_refused() -> None:
    with pytest.raises(InputError, match="587"):
        AprilGrid(columns=30, rows=30, tag_size=0.1, spacing=0.3)
    with pytest.raises(InputError, match="no target"):
        AprilGrid(columns=3, rows=3, tag_size=0.0, spacing=0.3)
    with pytest.raises(InputError, match="3 x 3 inner corners"):
        Checkerboard(columns=2, rows=6, column_spacing=0.03, row_spacing=0.03)
    with pytest.raises(InputError, match="page 'b4' is unknown"):
        fitting_grid("b4", 6, 6, 0.3)


@pytest.fixture(scope="module")
def drawn() -> tuple[np.ndarray, np.ndarray, AprilGrid]:
    """A tilted grid half out of a fisheye's picture, with where its corners truly are."""
    grid = AprilGrid(columns=4, rows=4, tag_size=0.08, spacing=0.3)
    lens = np.array([230.0, 229.0, 161.0, 118.0, 0.04, -0.02, 0.005, -0.001])
    camera = camera_of("equidistant", lens, (320, 240))
    facing = np.diag([1.0, -1.0, -1.0]) @ rotation_exp([0.3, -0.4, 0.5])
    pose = Pose(rotation=facing, position=np.array([0.10, 0.2, 0.0]) - facing @ np.array([0.0, 0.0, 0.33]))
    picture = TargetRenderer(grid, camera).draw([pose], np.random.default_rng(0))
    return picture, project(camera, pose.inverse().transform(grid.points)), grid


def test_part_of_a_grid_is_found_to_a_tenth_of_a_pixel(drawn: tuple[np.ndarray, np.ndarray, AprilGrid]) -> None:
    picture, truth, grid = drawn
    found = GridDetector(grid).detect(picture)
    assert found is not None
    inside = ((truth > 10.0) & (truth < (309.0, 229.0))).all(axis=1)
    whole = np.concatenate([grid.corners_of(tag) for tag in range(grid.tags) if inside[grid.corners_of(tag)].all()])
    assert 16 <= len(whole) < 3 * grid.tags
    assert len(np.intersect1d(found.corners, whole)) > 0.95 * len(whole)
    errors = np.linalg.norm(found.pixels - truth[found.corners], axis=1)
    assert np.sqrt((errors**2).mean()) < 0.12
    assert errors.max() < 0.6


def test_covered_tags_are_not_made_up(drawn: tuple[np.ndarray, np.ndarray, AprilGrid]) -> None:
    picture, truth, grid = drawn
    covered = picture.copy()
    hidden = next(
        tag
        for tag in range(16)
        if (truth[grid.corners_of(tag)] > 60).all() and (truth[grid.corners_of(tag)] < 200).all()
    )
    cv2.fillConvexPoly(covered, np.rint(truth[grid.corners_of(hidden)]).astype(np.int32), 128)
    found = GridDetector(grid).detect(covered)
    assert found is not None
    assert not np.isin(grid.corners_of(hidden), found.corners).any()


@pytest.mark.parametrize("level", [0, 255])
def test_pictures_without_a_target_show_none(level: int) -> None:
    empty = np.full((240, 320), level, dtype=np.uint8)
    noise = np.random.default_rng(0).integers(0, 255, (240, 320), dtype=np.uint8)
    for picture in (empty, noise):
        assert GridDetector(AprilGrid(columns=4, rows=4, tag_size=0.08, spacing=0.3)).detect(picture) is None
        board = Checkerboard(columns=6, rows=4, column_spacing=0.03, row_spacing=0.03)
        assert ChessboardDetector(board).detect(picture) is None


def test_a_chessboard_upside_down_is_numbered_alike() -> None:
    board = Checkerboard(columns=7, rows=4, column_spacing=0.03, row_spacing=0.03)
    cells = (np.add.outer(np.arange(7), np.arange(10)) % 2 * 200 + 30).astype(np.uint8)
    cells[0], cells[-1], cells[:, 0], cells[:, -1] = 230, 230, 230, 230
    picture = np.kron(cells, np.ones((30, 30), dtype=np.uint8))
    one, other = (ChessboardDetector(board).detect(p) for p in (picture, np.ascontiguousarray(picture[::-1, ::-1])))
    assert one is not None
    assert other is not None
    np.testing.assert_allclose(other.pixels, np.array(picture.shape[::-1]) - 1.0 - one.pixels, atol=0.3)
