"""Real chessboard pairs: our batch beside OpenCV's own calibration of the very same corners."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from robot_agent.calibration.camera_calibration import calibrate_cameras
from robot_agent.calibration.looking import look
from robot_agent.calibration.pictures import open_pictures
from robot_agent.calibration.sightings import Session
from robot_agent.calibration.target import Checkerboard
from weaver_shared.errors import InputError

BOARD = Checkerboard(columns=9, rows=6, column_spacing=0.025, row_spacing=0.025)


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardRun:
    """Root mean square reprojection errors of all corners of both eyes, px."""

    pairs: int
    reprojection_px: float
    opencv_px: float
    baseline_m: float
    opencv_baseline_m: float


def calibrate_boards(folder: Path) -> BoardRun:
    """`folder` has left*/right* pairs of a board of 9 x 6 inner corners, 25 mm apart."""
    source = open_pictures(folder)
    if source.eyes != 2:
        raise InputError(f"{folder} has pictures of one eye; left*/right* pairs are needed")
    session = look(source, BOARD)
    ours = calibrate_cameras(session, BOARD, "radtan")
    error, baseline = opencv_pair(session)
    return BoardRun(
        pairs=len(session.views),
        reprojection_px=ours.rms,
        opencv_px=error,
        baseline_m=ours.rig.baseline,
        opencv_baseline_m=baseline,
    )


def opencv_pair(session: Session) -> tuple[float, float]:
    """Error (px) and baseline (m) by OpenCV: lens by lens, then both as a pair with the lenses kept."""
    both = [(one, two) for view in session.views for one, two in [view.eyes] if one is not None and two is not None]
    corners = [[pair[eye].pixels.astype(np.float32) for pair in both] for eye in range(2)]
    points = [BOARD.points.astype(np.float32)] * len(both)
    (_, k1, d1, *_), (_, k2, d2, *_) = (
        cv2.calibrateCamera(points, seen, size, None, None, flags=cv2.CALIB_FIX_K3)
        for seen, size in zip(corners, session.sizes, strict=True)
    )
    pair = (*corners, k1, d1, k2, d2, session.sizes[0])
    found: Any = cv2.stereoCalibrate(points, *pair, flags=cv2.CALIB_FIX_K3)  # type: ignore[call-overload]
    return float(found[0]), float(np.linalg.norm(found[6]))
