"""One finished cloud or grid: its plane, features, roughness, step height and flat tops."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from robot_agent.perception.cloud import cell_for, highest_points, level
from robot_agent.perception.features import Roughness, characterise, patch_features
from robot_agent.perception.flat_tops import FlatTop, flat_tops
from robot_agent.perception.ground_plane import fit_plane
from robot_agent.perception.layer_comparison import LayerComparison, compare_layers
from robot_agent.perception.local_planes import RADIUS, LocalPlanes, local_planes
from robot_agent.perception.stairs import Stairs, find_stairs
from robot_agent.perception.terrain_files import Cloud, ElevationGrid
from weaver_shared.config.perception import FeatureConfig, PlaneMode

Array = NDArray[np.float64]

FOOT_REACH = 0.35  # m above or below the ground that a leg may have to do with; farther is another object or floor
SMALLEST_STEP = 0.012  # m
LARGEST_STEP_CELL = 0.2  # m; in wider cells no tread can be told
LARGEST_FIT = 60_000  # cells
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, kw_only=True)
class TerrainReport:
    """`tilt_deg` is the angle of the plane's normal to `tilt_reference`; `steps` are heights above the ground (m)."""

    kind: str  # "cloud" or "grid"
    frame: str  # "optical" or "z up"
    cell: float  # m
    coverage: float  # share of the cells inside the outline that are known
    terrain: Roughness
    features: Array  # (7,)
    normal_in_input: Array  # (3,) towards the sensor, or up
    tilt_deg: float
    tilt_reference: str
    rms: float  # m of the ground about the plane
    steps: tuple[FlatTop, ...]
    stairs: Stairs | None
    layers: LocalPlanes | None  # of grids
    compared: tuple[LayerComparison, ...]  # with layers that the file brought along


def report_on_cloud(cloud: Cloud, mode: PlaneMode, features: FeatureConfig) -> TerrainReport:
    """Level the cloud on its own ground and characterise what lies within a leg's reach of it."""
    levelled = level(cloud.points)
    cell = cell_for(levelled.points)
    heights, _ = highest_points(levelled.points, cell)
    near = _ground_and_what_stands_on_it(heights)
    plane_normal, terrain, values, coverage, rms = _characterised(near, cell, mode, features, levelled.ground_rms)
    normal = levelled.normal_in_input if mode == "robust" else levelled.level_from_input.rotation.T @ plane_normal
    if cloud.labelled_up is not None:
        # A label may be given from either side of the plane.
        reference, name = cloud.labelled_up * np.sign(cloud.labelled_up @ normal), "labelled up"
    elif levelled.frame == "optical":
        reference, name = np.array([0.0, -1.0, 0.0]), "camera up (-y)"
    else:
        reference, name = UP, "input z"
    tops = [top for top in flat_tops(heights, cell) if top.height > SMALLEST_STEP]
    return TerrainReport(
        kind="cloud",
        frame=levelled.frame,
        cell=cell,
        coverage=coverage,
        terrain=terrain,
        features=values,
        normal_in_input=normal,
        tilt_deg=_angle_deg(normal, reference),
        tilt_reference=name,
        rms=rms if mode == "paper" else levelled.ground_rms,
        steps=tuple(tops),
        stairs=find_stairs(tops),
        layers=None,
        compared=(),
    )


def report_on_grid(
    grid: ElevationGrid, mode: PlaneMode, features: FeatureConfig, radius: float = RADIUS
) -> TerrainReport:
    """Characterise a grid about its plane; its ground is the lowest flat place of some extent.

    `radius` (m) is that of the circle whose plane gives each cell its slope and roughness.
    """
    normal, terrain, values, coverage, rms = _characterised(grid.heights, grid.cell, mode, features, None)
    tops = flat_tops(grid.heights, grid.cell) if grid.cell < LARGEST_STEP_CELL else []
    extent = float(np.isfinite(grid.heights).sum()) * grid.cell**2
    broad = [top for top in tops if top.area > 0.02 * extent]
    ground = broad[0].height if broad else 0.0
    steps = [replace(top, height=top.height - ground) for top in tops if top.height - ground > SMALLEST_STEP]
    layers = local_planes(grid.heights, grid.cell, radius)
    return TerrainReport(
        kind="grid",
        frame="z up",
        cell=grid.cell,
        coverage=coverage,
        terrain=terrain,
        features=values,
        normal_in_input=normal,
        tilt_deg=_angle_deg(normal, UP),
        tilt_reference="input z",
        rms=rms,
        steps=tuple(steps),
        stairs=find_stairs(tops),
        layers=layers,
        compared=compare_layers(layers, grid.layers),
    )


def _ground_and_what_stands_on_it(heights: Array) -> Array:
    """The largest connected region within reach of a foot; floors and walls farther off become unknown."""
    labels, number = ndimage.label(np.abs(heights) < FOOT_REACH, structure=np.ones((3, 3)))
    if number == 0:
        return heights
    largest = 1 + int(np.argmax(np.bincount(labels.ravel())[1:]))
    return np.where(labels == largest, heights, np.nan)


def _characterised(
    heights: Array, cell: float, mode: PlaneMode, config: FeatureConfig, noise: float | None
) -> tuple[Array, Roughness, Array, float, float]:
    """Plane normal, roughness, features, coverage and rms of a height grid; `noise` None: taken from the grid."""
    rows, columns = np.nonzero(np.isfinite(heights))
    x, y = (np.asarray((index + 0.5) * cell, dtype=np.float64) for index in (rows, columns))
    z = heights[rows, columns]
    chosen = np.linspace(0, len(z) - 1, min(len(z), LARGEST_FIT)).astype(np.int64)
    plane = fit_plane(x[chosen], y[chosen], z[chosen], mode)
    residual = np.full(heights.shape, np.nan)
    residual[rows, columns] = plane.residual(x, y, z)
    outline = int(np.ptp(rows) + 1) * int(np.ptp(columns) + 1)
    coverage = len(z) / outline
    if mode == "paper":
        noise = 0.0
    elif noise is None:
        noise = _cell_noise(heights)
    values = patch_features(residual, cell, noise, config)
    terrain = characterise(values, coverage, outline * cell**2, noise, config)
    return plane.normal, terrain, values, coverage, plane.rms


def _cell_noise(heights: Array) -> float:
    """Standard deviation in m of the calmer half of a grid, from second differences, which slopes do not enter."""
    second = heights[2:, :] - 2.0 * heights[1:-1, :] + heights[:-2, :]
    second = np.abs(second[np.isfinite(second)])
    if not len(second):
        return 0.0
    return float(np.quantile(second, 0.34) / np.sqrt(6.0) / 0.44)


def _angle_deg(a: Array, b: Array) -> float:
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)))
