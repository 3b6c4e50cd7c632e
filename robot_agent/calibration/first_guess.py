"""A start for the batch without any prior knowledge: the focal length under which planes look like planes."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.lens import camera_of
from robot_agent.calibration.sightings import Sighting, View
from robot_agent.calibration.target import Target
from robot_agent.vision.camera import Distortion, PinholeCamera
from robot_agent.vision.distortion import normalise, project
from weaver_shared.errors import InputError
from weaver_shared.transforms import Pose, rotation_exp, rotation_log

Array = NDArray[np.float64]

FOCAL_LENGTHS = np.geomspace(0.25, 3.0, 28)
"""Tried, in picture widths: from 127 degrees across to 19."""

TRIED_VIEWS = 15


def guess_lens(views: Sequence[View], eye: int, target: Target, model: Distortion, size: tuple[int, int]) -> Array:
    """Intrinsics (8,) without distortion; principal point in the middle."""
    sightings = [view.eyes[eye] for view in views]
    fullest = sorted((s for s in sightings if s is not None), key=len, reverse=True)[: 3 * TRIED_VIEWS]
    tried = fullest[:: max(1, len(fullest) // TRIED_VIEWS)]
    middle = [(size[0] - 1) / 2.0, (size[1] - 1) / 2.0]
    costs = []
    for focal in FOCAL_LENGTHS * size[0]:
        camera = camera_of(model, np.array([focal, focal, *middle, 0.0, 0.0, 0.0, 0.0]), size)
        costs.append(np.mean([_misfit(camera, sighting, target) for sighting in tried]))
    focal = float(FOCAL_LENGTHS[int(np.argmin(costs))] * size[0])
    return np.array([focal, focal, *middle, 0.0, 0.0, 0.0, 0.0])


def locate(camera: PinholeCamera, sighting: Sighting, target: Target) -> Pose | None:
    """camera_from_target by the plane's homography, or None where the corners do not fix it."""
    points = target.points[sighting.corners]
    rays = normalise(camera, sighting.pixels)
    usable = np.isfinite(rays).all(axis=1) & (np.abs(rays).max(axis=1) < 8.0)
    if usable.sum() < 4 or np.linalg.matrix_rank(points[usable, :2] - points[usable, :2].mean(axis=0), tol=1e-6) < 2:
        return None
    found, turn, position = cv2.solvePnP(
        points[usable], np.ascontiguousarray(rays[usable]), np.eye(3), None, flags=cv2.SOLVEPNP_IPPE
    )
    if not found or not np.isfinite(position).all() or position[2, 0] <= 0.0:
        return None
    return Pose(rotation=rotation_exp(turn.ravel()), position=position.ravel())


def guess_between(pairs: Sequence[tuple[Pose, Pose]]) -> Pose:
    """second_from_first that most pairs of (first_from_target, second_from_target) agree on."""
    if not pairs:
        raise InputError("no picture shows the target to both eyes at once, so their places can not be found")
    candidates = [second @ first.inverse() for first, second in pairs]

    def disagreement(pose: Pose) -> float:
        turns = [np.linalg.norm(rotation_log(pose.rotation.T @ other.rotation)) for other in candidates]
        moves = [np.linalg.norm(pose.position - other.position) for other in candidates]
        return float(np.median(turns) + np.median(moves))

    return min(candidates, key=disagreement)


def _misfit(camera: PinholeCamera, sighting: Sighting, target: Target) -> float:
    """How far the best plane's corners are from the ones seen, px (median); a tenth of the picture where none fits."""
    worst = 0.1 * camera.width
    pose = locate(camera, sighting, target)
    if pose is None:
        return worst
    seen = project(camera, pose.transform(target.points[sighting.corners])) - sighting.pixels
    return min(worst, float(np.median(np.nan_to_num(np.linalg.norm(seen, axis=1), nan=worst))))
