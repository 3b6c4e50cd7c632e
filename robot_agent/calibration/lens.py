"""Pinhole with lens distortion and its analytical derivatives; `robot_agent.vision.distortion` is the plain form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.compiled import compiled
from robot_agent.vision.camera import Distortion, PinholeCamera
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

MODELS: tuple[Distortion, ...] = ("none", "radtan", "equidistant")
RADTAN, EQUIDISTANT = 1, 2

INTRINSICS = 8
"""fx, fy, cx, cy and four coefficients."""

NAMES: dict[Distortion, tuple[str, ...]] = {
    "none": ("fx", "fy", "cx", "cy"),
    "radtan": ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2"),
    "equidistant": ("fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"),
}


def intrinsics_of(camera: PinholeCamera) -> Array:
    """(8,): fx, fy, cx, cy, and the distortion."""
    return np.concatenate([[camera.fx, camera.fy, camera.cx, camera.cy], camera.distortion])


def camera_of(
    model: Distortion, intrinsics: Array, size: tuple[int, int], body_from_camera: Pose | None = None
) -> PinholeCamera:
    fx, fy, cx, cy = (float(x) for x in intrinsics[:4])
    return PinholeCamera(
        width=size[0],
        height=size[1],
        fx=fx,
        fy=fy,
        cx=cx,
        cy=cy,
        distortion_model=model,
        distortion=np.array(intrinsics[4:]),
        body_from_camera=Pose.identity() if body_from_camera is None else body_from_camera,
    )


@compiled
def project_point(
    model: int, intrinsics: Array, point: Array, pixel: Array, by_point: Array, by_intrinsics: Array
) -> None:
    """Pixel (2,) of a point (3,) before the lens, with its derivatives (2, 3) and (2, 8); NaN for one behind it."""
    by_intrinsics[:, :] = 0.0
    by_point[:, :] = 0.0
    if point[2] < 1e-6:
        pixel[:] = np.nan
        return
    x, y = point[0] / point[2], point[1] / point[2]
    r2 = x * x + y * y
    k1, k2, k3, k4 = intrinsics[4], intrinsics[5], intrinsics[6], intrinsics[7]
    u, v, ux, uy, vy = x, y, 1.0, 0.0, 1.0
    fx, fy = intrinsics[0], intrinsics[1]
    if model == 1:
        radial, slope = 1.0 + r2 * (k1 + r2 * k2), k1 + 2.0 * k2 * r2
        u = x * radial + 2.0 * k3 * x * y + k4 * (r2 + 2.0 * x * x)
        v = y * radial + k3 * (r2 + 2.0 * y * y) + 2.0 * k4 * x * y
        ux = radial + 2.0 * x * x * slope + 2.0 * k3 * y + 6.0 * k4 * x
        uy = 2.0 * x * y * slope + 2.0 * k3 * x + 2.0 * k4 * y
        vy = radial + 2.0 * y * y * slope + 6.0 * k3 * y + 2.0 * k4 * x
        by_intrinsics[0, 4], by_intrinsics[1, 4] = fx * x * r2, fy * y * r2
        by_intrinsics[0, 5], by_intrinsics[1, 5] = fx * x * r2 * r2, fy * y * r2 * r2
        by_intrinsics[0, 6], by_intrinsics[1, 6] = 2.0 * fx * x * y, fy * (r2 + 2.0 * y * y)
        by_intrinsics[0, 7], by_intrinsics[1, 7] = fx * (r2 + 2.0 * x * x), 2.0 * fy * x * y
    elif model == 2 and r2 > 1e-18:
        r = np.sqrt(r2)
        theta = np.arctan(r)
        t2 = theta * theta
        scale = theta * (1.0 + t2 * (k1 + t2 * (k2 + t2 * (k3 + t2 * k4)))) / r
        slope = (1.0 + t2 * (3.0 * k1 + t2 * (5.0 * k2 + t2 * (7.0 * k3 + t2 * 9.0 * k4)))) / (1.0 + r2)
        radial = (slope - scale) / r2
        u, v = scale * x, scale * y
        ux, uy, vy = scale + radial * x * x, radial * x * y, scale + radial * y * y
        power = theta / r
        for k in range(4):
            power *= t2
            by_intrinsics[0, 4 + k], by_intrinsics[1, 4 + k] = fx * x * power, fy * y * power
    pixel[0], pixel[1] = fx * u + intrinsics[2], fy * v + intrinsics[3]
    by_intrinsics[0, 0], by_intrinsics[1, 1] = u, v
    by_intrinsics[0, 2], by_intrinsics[1, 3] = 1.0, 1.0
    inverse = 1.0 / point[2]
    by_point[0, 0], by_point[0, 1] = fx * ux * inverse, fx * uy * inverse
    by_point[1, 0], by_point[1, 1] = fy * uy * inverse, fy * vy * inverse
    by_point[0, 2] = -(by_point[0, 0] * x + by_point[0, 1] * y)
    by_point[1, 2] = -(by_point[1, 0] * x + by_point[1, 1] * y)


@compiled
def project_points(model: int, intrinsics: Array, points: Array) -> tuple[Array, Array, Array]:
    """Pixels (n, 2) of points (n, 3), with derivatives (n, 2, 3) and (n, 2, 8)."""
    count = len(points)
    pixels = np.empty((count, 2))
    by_point = np.empty((count, 2, 3))
    by_intrinsics = np.empty((count, 2, 8))
    for k in range(count):
        project_point(model, intrinsics, points[k], pixels[k], by_point[k], by_intrinsics[k])
    return pixels, by_point, by_intrinsics
