"""Pictures of an AprilGrid through a distorting lens: rays through 9 points of each pixel meet the exact plane.

The graphics card's pinhole renderer would need a second, resampling pass for the lens, and resampling moves corners by
hundredths of a pixel: as much as a calibration is to find.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, cast

import cv2
import numba
import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.tags import tag_cells
from robot_agent.calibration.target import AprilGrid
from robot_agent.vision.camera import PinholeCamera
from robot_agent.vision.distortion import normalise
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]
Kernel = TypeVar("Kernel", bound=Callable[..., Any])

FINE = 3
"""Rays per pixel along each axis."""

INK, PAPER, SURROUNDINGS = 25.0, 215.0, 60.0
"""Grey values under even light; what surrounds the target is patchy."""

LENS_BLUR = 0.5
"""Standard deviation of the lens's point spread, px."""


def compiled(function: Kernel) -> Kernel:
    return cast(Kernel, numba.njit(cache=True, nogil=True, error_model="numpy")(function))


class TargetRenderer:
    """Draws one target as one eye sees it; `noise` is the standard deviation of the grey values."""

    def __init__(self, grid: AprilGrid, camera: PinholeCamera, *, noise: float = 2.0) -> None:
        self._cells = np.array([tag_cells(tag) for tag in range(grid.tags)])
        self._layout = (grid.columns, grid.rows, grid.tag_size, grid.spacing * grid.tag_size)
        self._rays = _rays(camera)
        self._lattice = _lattice(camera, camera.width + 1, camera.height + 1, (-0.5, -0.5))
        self._noise = noise

    def draw(self, target_from_camera: list[Pose], generator: np.random.Generator) -> Picture:
        """The grey picture (height, width) of an exposure spread evenly over the given poses."""
        planes = np.array([_plane_from_rays(pose) for pose in target_from_camera])
        shades = _expose(self._rays, self._lattice, planes, self._cells, *self._layout)
        shades = cv2.GaussianBlur(shades, (0, 0), LENS_BLUR)
        shades = shades + self._noise * generator.standard_normal(shades.shape, dtype=np.float32)
        return np.asarray(np.clip(np.rint(shades), 0, 255), dtype=np.uint8)


def _plane_from_rays(target_from_camera: Pose) -> Array:
    """Homography (3, 3) from the camera's plane z = 1 to the target's plane; its third row is below 0 for a hit."""
    x, y, z = target_from_camera.rotation
    a, b, c = target_from_camera.position
    return np.array([a * z - c * x, b * z - c * y, z])


def _rays(camera: PinholeCamera) -> NDArray[np.float32]:
    """Where the rays of all pixels meet the plane z = 1 (height, width, FINE, FINE, 2)."""
    offsets = (np.arange(FINE) + 0.5) / FINE - 0.5
    rays = np.empty((camera.height, camera.width, FINE, FINE, 2), dtype=np.float32)
    for i, down in enumerate(offsets):
        for j, right in enumerate(offsets):
            rays[:, :, i, j] = _lattice(camera, camera.width, camera.height, (right, down))
    return rays


def _lattice(camera: PinholeCamera, width: int, height: int, offset: tuple[float, float]) -> NDArray[np.float32]:
    """The plane z = 1 at whole pixels plus `offset` (height, width, 2)."""
    x, y = np.meshgrid(np.arange(width) + offset[0], np.arange(height) + offset[1])
    points = normalise(camera, np.stack([x.ravel(), y.ravel()], axis=1))
    return points.reshape(height, width, 2).astype(np.float32)


@compiled
def _expose(
    rays: NDArray[np.float32],
    lattice: NDArray[np.float32],
    planes: Array,
    cells: NDArray[np.uint8],
    columns: int,
    rows: int,
    size: float,
    gap: float,
) -> NDArray[np.float32]:
    height, width, fine = rays.shape[0], rays.shape[1], rays.shape[2]
    instants = len(planes)
    # What the pixels' corners see at both ends of the exposure: a pixel between equals needs no finer look.
    outline = np.empty((2, height + 1, width + 1), dtype=np.float32)
    for end in range(2):
        plane = planes[end * (instants - 1)]
        for row in range(height + 1):
            for column in range(width + 1):
                x, y = np.float64(lattice[row, column, 0]), np.float64(lattice[row, column, 1])
                outline[end, row, column] = _shade(x, y, plane, cells, columns, rows, size, gap)
    picture = np.empty((height, width), dtype=np.float32)
    for row in range(height):
        for column in range(width):
            first = outline[0, row, column]
            even = True
            for end in range(2):
                for i in range(2):
                    for j in range(2):
                        even = even and outline[end, row + i, column + j] == first
            if even:
                picture[row, column] = first
                continue
            total = 0.0
            for i in range(fine):
                for j in range(fine):
                    # Neighbouring rays look at instants far apart, so that every part of a pixel sees all of the time.
                    plane = planes[((i * fine + j) * 7 + column * 3 + row * 5) % instants]
                    x, y = np.float64(rays[row, column, i, j, 0]), np.float64(rays[row, column, i, j, 1])
                    total += _shade(x, y, plane, cells, columns, rows, size, gap)
            picture[row, column] = total / (fine * fine)
    return picture


@compiled
def _shade(
    x: float,
    y: float,
    plane: Array,
    cells: NDArray[np.uint8],
    columns: int,
    rows: int,
    size: float,
    gap: float,
) -> float:
    """Grey value where the ray (x, y, 1) meets the target's plane."""
    down = plane[2, 0] * x + plane[2, 1] * y + plane[2, 2]
    if down >= 0.0:
        return SURROUNDINGS
    u = (plane[0, 0] * x + plane[0, 1] * y + plane[0, 2]) / down
    v = (plane[1, 0] * x + plane[1, 1] * y + plane[1, 2]) / down
    pitch = size + gap
    if u < -2.0 * gap or v < -2.0 * gap or u > columns * pitch + gap or v > rows * pitch + gap:
        patch = int(np.floor(u / (1.7 * size))) * 7 + int(np.floor(v / (1.3 * size))) * 13
        return SURROUNDINGS + 12.0 * (patch % 5)
    i, j = int(np.floor((u + gap) / pitch)), int(np.floor((v + gap) / pitch))
    across, up = u + gap - i * pitch, v + gap - j * pitch
    if i < 0 or j < 0 or i > columns or j > rows:
        return PAPER
    if across < gap and up < gap:
        return INK
    if across < gap or up < gap or i == columns or j == rows:
        return PAPER
    side = cells.shape[1]
    column, row = min(side - 1, int((across - gap) / size * side)), min(side - 1, int((up - gap) / size * side))
    return PAPER if cells[j * columns + i, row, column] > 0 else INK
