"""Ground plane of a point cloud with no known gravity, and its highest points on a level grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from robot_agent.perception.ground_plane import fit_plane
from weaver_shared.errors import InputError
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
CloudFrame = Literal["optical", "z up"]

HYPOTHESES = 400
SAMPLE = 6_000  # points that judge a hypothesis
REFINING = 20_000  # points of the final fit
NARROWEST_VIEW = 0.15  # of a camera's picture, width over distance: 9 degrees
INLIER = 0.01  # m per metre of distance and at least: how thick a plane may look
NEAR_PLANE = 0.03  # m about the first plane that its refinement looks at
GROUND_DIRECTIONS: dict[CloudFrame, tuple[tuple[tuple[float, float, float], float], ...]] = {
    # A camera looks down on ground by less than 75 degrees, or at a wall; only then is ground sought right below it.
    "optical": (((0.0, -1.0, 0.0), np.deg2rad(75.0)), ((0.0, 0.0, -1.0), np.deg2rad(30.0))),
    "z up": (((0.0, 0.0, 1.0), np.deg2rad(45.0)),),
}
"""Where a ground's normal may point to, as a direction and the largest angle from it, in the order tried."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LevelledCloud:
    """A cloud turned so that its ground is z = 0 and up is +z."""

    points: Array  # (n, 3) m
    level_from_input: Pose
    normal_in_input: Array  # (3,) unit, up
    ground_rms: float  # m of the points near the plane
    frame: CloudFrame


def frame_of(points: Array) -> CloudFrame:
    """`optical` if all points lie in front of a camera at the origin that looks along z, else `z up`.

    From a lens they lie in widely different directions; ground high above its origin does not.
    """
    forward = points[:, 2]
    inside = (forward > 0.0) & (np.abs(points[:, :2]).max(axis=1) < 2.0 * forward)
    if float(inside.mean()) <= 0.999:
        return "z up"
    low, high = np.quantile(points[inside, :2] / forward[inside, None], [0.02, 0.98], axis=0)
    return "optical" if float((high - low).max()) > NARROWEST_VIEW else "z up"


def level(points: Array, *, seed: int = 0) -> LevelledCloud:
    """Find the ground of a cloud (n, 3): the largest plane that can be ground, refined by robust least squares.

    Raises InputError if there is no such plane.
    """
    frame = frame_of(points)
    # How thick a plane looks grows with the distance from a lens; another frame's origin may lie anywhere.
    middle = np.zeros(3) if frame == "optical" else np.median(points, axis=0)
    points = points - middle
    generator = np.random.default_rng(seed)
    sample = points if len(points) <= SAMPLE else points[generator.choice(len(points), SAMPLE, replace=False)]
    found = None
    for up_guess, steepest in GROUND_DIRECTIONS[frame]:
        found = found or _largest_plane(sample, np.array(up_guess), float(np.cos(steepest)), generator)
    if found is None:
        raise InputError("the cloud has no plane that could be ground: none holds 5 % of its points")
    normal, offset = found
    for _ in range(3):
        level_from_input = _levelling(normal, offset, frame)
        levelled = level_from_input.transform(points)
        near = np.flatnonzero(np.abs(levelled[:, 2]) < NEAR_PLANE)
        if len(near) > REFINING:
            near = generator.choice(near, REFINING, replace=False)
        x, y, z = levelled[near].T
        plane = fit_plane(x, y, z, mode="robust")
        normal = level_from_input.rotation.T @ plane.normal
        foot = level_from_input.inverse().transform([0.0, 0.0, plane.offset])
        offset = float(normal @ foot)
    level_from_input = _levelling(normal, offset, frame)
    return LevelledCloud(
        points=level_from_input.transform(points),
        level_from_input=level_from_input @ Pose.of(-middle),
        normal_in_input=normal,
        ground_rms=plane.rms,
        frame=frame,
    )


def highest_points(levelled: Array, cell: float, min_points: int = 2, top_band: float = 0.01) -> tuple[Array, Array]:
    """Highest point of each cell, mean of the band under it, (rows, columns) NaN unknown; and the cell of (0, 0).

    Cells with fewer than `min_points` in the band stay unknown.
    """
    indices = np.floor(levelled[:, :2] / cell).astype(np.int64)
    first = indices.min(axis=0)
    rows, columns = indices.max(axis=0) - first + 1
    flat = (indices[:, 0] - first[0]) * columns + indices[:, 1] - first[1]
    top = np.full(rows * columns, -np.inf)
    np.maximum.at(top, flat, levelled[:, 2])
    in_band = levelled[:, 2] >= top[flat] - top_band
    count = np.bincount(flat[in_band], minlength=rows * columns)
    total = np.bincount(flat[in_band], weights=levelled[in_band, 2], minlength=rows * columns)
    heights = np.where(count >= min_points, total / np.maximum(count, 1), np.nan)
    return heights.reshape(rows, columns), first


def cell_for(levelled: Array, smallest: float = 0.01, points_per_cell: float = 4.0) -> float:
    """Cell length in m, doubled from the smallest until a typical cell holds enough points."""
    cell = smallest
    while cell < 10.0:
        indices = np.floor(levelled[:, :2] / cell).astype(np.int64)
        _, count = np.unique(indices[:, 0] * 1_000_003 + indices[:, 1], return_counts=True)
        if float(np.median(count)) >= points_per_cell:
            return cell
        cell *= 2.0
    return cell


def _largest_plane(
    sample: Array, up_guess: Array, smallest_cosine: float, generator: np.random.Generator
) -> tuple[Array, float] | None:
    """Unit normal and offset (normal . point) of the plane with the most points near it, tilted less than given.

    None if no such plane holds 5 % of the points.
    """
    tolerance = np.maximum(INLIER, INLIER * np.linalg.norm(sample, axis=1))
    best: tuple[Array, float] | None = None
    best_count = 0
    for _ in range(HYPOTHESES):
        a, b, c = sample[generator.choice(len(sample), 3, replace=False)]
        normal = np.cross(b - a, c - a)
        length = float(np.linalg.norm(normal))
        if length < 1e-9:
            continue
        normal = normal / length * (1.0 if normal @ up_guess >= 0.0 else -1.0)
        if normal @ up_guess < smallest_cosine:
            continue
        count = int((np.abs(sample @ normal - normal @ a) < tolerance).sum())
        if count > best_count:
            best, best_count = (normal, float(normal @ a)), count
    return best if best_count >= max(10, 0.05 * len(sample)) else None


def _levelling(normal: Array, offset: float, frame: CloudFrame) -> Pose:
    """Pose level_from_input of a plane: z along its normal, x along the view (optical) or the input's x."""
    forward = np.array([0.0, 0.0, 1.0]) if frame == "optical" else np.array([1.0, 0.0, 0.0])
    if abs(forward @ normal) > 0.99:
        forward = np.array([0.0, -1.0, 0.0])  # a camera that looks straight down
    x = forward - (forward @ normal) * normal
    x /= np.linalg.norm(x)
    rotation = np.stack([x, np.cross(normal, x), normal])
    return Pose(rotation=rotation, position=np.array([0.0, 0.0, -offset]))
