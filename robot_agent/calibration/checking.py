"""Whether a calibration still fits: what it makes of the target, and what a new place of the eyes would change."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.camera_calibration import locate_views
from robot_agent.calibration.corner_table import CornerTable
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.rig_batch import solve_rig
from robot_agent.calibration.sightings import Session
from robot_agent.calibration.target import Target
from robot_agent.vision.camera import PinholeCamera, StereoCalibration
from robot_agent.vision.distortion import normalise
from robot_agent.vision.rectification import Rectifier
from weaver_shared.errors import InputError
from weaver_shared.transforms import rotation_log

Array = NDArray[np.float64]

ROWS_APART = 0.5
"""px between what should be one row in rectified pictures; dense matching loses detail beyond it."""

LENS_ERROR = 0.6
"""px of one eye's corners against the best pose of the target."""

SIZE_ERROR = 0.005
"""Of lengths on the target, measured by the pair."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckResult:
    views: int
    lens_errors: tuple[float, ...]  # px rms of each eye by itself
    rows_apart: float | None  # px rms, rectified; None for a single eye
    rows_shift: float | None  # px, their mean
    size_ratio: float | None  # lengths on the target by the pair over the true ones
    turned_deg: float | None  # by how much the eyes seem to have turned since
    faults: tuple[str, ...]

    @property
    def holds(self) -> bool:
        return not self.faults


def check_rig(rig: Rig, session: Session, target: Target) -> CheckResult:
    """Raises InputError where too few views show the target."""
    lens_errors = []
    for eye in range(rig.eyes):
        alone = Rig.of([rig.cameras[eye]])
        views = [view for view in session.views if view.eyes[eye] is not None]
        single = [type(view)(stamp_ns=view.stamp_ns, eyes=(view.eyes[eye],), name=view.name) for view in views]
        located, poses = locate_views(alone, single, target)
        if len(located) < 3:
            raise InputError(f"{len(located)} views show the target to eye {eye}; a check needs at least 3")
        fitted = solve_rig(alone, poses, CornerTable.of(located, target, (0,)), free="poses")
        lens_errors.append(float(np.sqrt((fitted.residuals[fitted.used] ** 2).sum(axis=1).mean())))
    faults = [
        f"the {name} lens is off by {error:.2f} px ({LENS_ERROR} is the most): calibrate the cameras anew"
        for name, error in zip(("left", "right"), lens_errors, strict=False)
        if error > LENS_ERROR
    ]
    if rig.eyes < 2:
        return CheckResult(
            views=len(session.views),
            lens_errors=tuple(lens_errors),
            rows_apart=None,
            rows_shift=None,
            size_ratio=None,
            turned_deg=None,
            faults=tuple(faults),
        )
    rows, ratio = _pair_errors(rig, session, target)
    rows_apart = float(np.sqrt((rows**2).mean()))
    if rows_apart > ROWS_APART:
        faults.append(
            f"rows of the rectified pair are {rows_apart:.2f} px apart ({ROWS_APART} is the most): an eye has moved"
        )
    if abs(ratio - 1.0) > SIZE_ERROR:
        faults.append(
            f"the pair measures the target {100 * (ratio - 1.0):+.1f} % off its size: baseline, focal length or the "
            "target's file is wrong"
        )
    located, poses = locate_views(rig, session.views, target)
    again = solve_rig(rig, poses, CornerTable.of(located, target, range(rig.eyes)), free="places")
    turned = rig.eye_from_first[1].rotation.T @ again.rig.eye_from_first[1].rotation
    return CheckResult(
        views=len(session.views),
        lens_errors=tuple(lens_errors),
        rows_apart=rows_apart,
        rows_shift=float(rows.mean()),
        size_ratio=ratio,
        turned_deg=float(np.degrees(np.linalg.norm(rotation_log(turned)))),
        faults=tuple(faults),
    )


def _pair_errors(rig: Rig, session: Session, target: Target) -> tuple[Array, float]:
    """Rows apart (n,) px of all corners both eyes see, rectified; and lengths by the pair over the true ones."""
    left, right = rig.cameras
    rectifier = Rectifier(StereoCalibration(left=left, right=right))
    rows, ratios = [], []
    for view in session.views:
        one, two = view.eyes[0], view.eyes[1]
        if one is None or two is None:
            continue
        common, a, b = np.intersect1d(one.corners, two.corners, return_indices=True)
        if len(common) < 4:
            continue
        seen, other = (
            _rectified(rectifier, camera, pixels) for camera, pixels in ((left, one.pixels[a]), (right, two.pixels[b]))
        )
        rows.append(seen[:, 1] - other[:, 1])
        disparity = seen[:, 0] - other[:, 0]
        if (disparity <= 0.1).any():
            continue
        depth = rectifier.fx * rectifier.baseline / disparity
        points = np.stack(
            [
                (seen[:, 0] - rectifier.cx) / rectifier.fx,
                (seen[:, 1] - rectifier.cy) / rectifier.fy,
                np.ones(len(depth)),
            ],
            axis=1,
        )
        ratios.append(_spread(points * depth[:, None]) / _spread(target.points[common]))
    if not rows:
        raise InputError("no view shows the target to both eyes at once")
    return np.concatenate(rows), float(np.median(ratios)) if ratios else float("nan")


def _rectified(rectifier: Rectifier, camera: PinholeCamera, pixels: Array) -> Array:
    rays = np.concatenate([normalise(camera, pixels), np.ones((len(pixels), 1))], axis=1)
    turned = rays @ camera.body_from_camera.rotation.T @ rectifier.body_from_rectified.rotation
    return np.asarray(cv2.convertPointsFromHomogeneous(turned @ rectifier.matrix.T)).reshape(-1, 2)


def _spread(points: Array) -> float:
    """Root mean square distance from the middle, in the plane that holds most of it."""
    singular = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return float(np.sqrt((singular[:2] ** 2).sum()))
