"""Lens distortion both ways: pixels to rays and rays to pixels."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.vision.camera import PinholeCamera

Array = NDArray[np.float64]

_CONVERGED = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 30, 1e-9)
"""OpenCV's own five iterations leave 0.2 px in the corners of a EuRoC picture."""


def normalise(camera: PinholeCamera, pixels: Array) -> Array:
    """Undistorted points (n, 2) on the plane z = 1 of the optical frame, seen at `pixels` (n, 2)."""
    if len(pixels) == 0:
        return np.zeros((0, 2))
    if camera.distortion_model == "none":
        return (pixels - (camera.cx, camera.cy)) / (camera.fx, camera.fy)
    points = np.ascontiguousarray(pixels, dtype=np.float64).reshape(-1, 1, 2)
    if camera.distortion_model == "equidistant":
        undistorted = cv2.fisheye.undistortPoints(points, camera.matrix, camera.distortion)
    else:
        undistorted = cv2.undistortPoints(points, camera.matrix, camera.distortion, criteria=_CONVERGED)
    return np.asarray(undistorted, dtype=np.float64).reshape(-1, 2)


def project(camera: PinholeCamera, points: Array) -> Array:
    """Pixels (n, 2) of `points` (n, 3) in the optical frame; NaN for points not in front of the lens."""
    depth = points[:, 2:]
    plane = np.where(depth > 1e-6, points[:, :2] / np.where(depth > 1e-6, depth, 1.0), np.nan)
    if camera.distortion_model == "radtan":
        plane = _radial_tangential(plane, camera.distortion)
    elif camera.distortion_model == "equidistant":
        plane = _equidistant(plane, camera.distortion)
    return np.asarray(plane * (camera.fx, camera.fy) + (camera.cx, camera.cy))


def _radial_tangential(plane: Array, coefficients: Array) -> Array:
    k1, k2, p1, p2 = coefficients
    x, y = plane[:, 0], plane[:, 1]
    r2 = x * x + y * y
    radial = 1.0 + r2 * (k1 + r2 * k2)
    return np.stack(
        [
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ],
        axis=1,
    )


def _equidistant(plane: Array, coefficients: Array) -> Array:
    """Kannala and Brandt's fisheye with four coefficients."""
    radius = np.linalg.norm(plane, axis=1, keepdims=True)
    theta = np.arctan(radius)
    squared = theta * theta
    k1, k2, k3, k4 = coefficients
    distorted = theta * (1.0 + squared * (k1 + squared * (k2 + squared * (k3 + squared * k4))))
    return np.asarray(plane * np.where(radius > 1e-9, distorted / np.maximum(radius, 1e-9), 1.0))
