"""Corners are where FAST finds them, spread over the picture and apart from each other."""

import cv2
import numpy as np
import pytest

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.odometry.corner_grid import CornerGrid, score_cell
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import FrontEndConfig
from weaver_shared.transforms import Pose


@pytest.fixture(scope="module")
def picture(calibration: StereoCalibration) -> np.ndarray:
    return TexturedGround(calibration, seed=3).look(0, 0, Pose.of([0.0, 0.0, 0.165])).left


def test_corners_and_their_scores_are_those_of_fast(picture: np.ndarray) -> None:
    score, ring = np.empty((60, 80), dtype=np.int64), np.empty(16, dtype=np.int64)
    score_cell(picture, 200, 300, 60, 80, 12, ring, score)
    detector = cv2.FastFeatureDetector.create(threshold=12, nonmaxSuppression=False)
    found = detector.detect(np.ascontiguousarray(picture[197:263, 297:383]))
    expected = {(round(k.pt[0]) - 3, round(k.pt[1]) - 3) for k in found}
    assert len(expected) > 20
    assert {(u, v) for v, u in np.argwhere(score > 0)} == expected
    strongest = cv2.FastFeatureDetector.create(threshold=12, nonmaxSuppression=True)
    for corner in strongest.detect(np.ascontiguousarray(picture[197:263, 297:383])):
        u, v = round(corner.pt[0]) - 3, round(corner.pt[1]) - 3
        assert score[v, u] == corner.response + 1  # OpenCV's is the last threshold passed, ours the first failed


def test_new_features_fill_the_gaps_and_keep_their_distance(
    calibration: StereoCalibration, picture: np.ndarray
) -> None:
    config = FrontEndConfig()
    grid = CornerGrid(calibration.left.width, calibration.left.height, config)
    first = grid.refill(picture, np.zeros((0, 2)))
    assert 0.8 * config.features < len(first) <= config.features
    left_half = first[first[:, 0] < 320]
    added = grid.refill(picture, left_half)
    together = np.concatenate([left_half, added])
    distance = np.linalg.norm(together[:, None] - together[None], axis=2) + 1e3 * np.eye(len(together))
    assert distance.min() >= config.spacing
    assert np.mean(added[:, 0] > 300) > 0.8
    assert len(grid.refill(picture, first)) <= config.features - len(first)
