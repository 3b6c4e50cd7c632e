"""The ground around the robot as seen and felt so far (ICRA'17 III-E, Fig. 7)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robot_agent.mapping.bounds import renew_bounds
from robot_agent.mapping.deformation import PosesAsUsed, deform, largest_change
from robot_agent.mapping.elevation_fusion import Extent, FusionRules, fuse, joined
from robot_agent.mapping.files.snapshot import MapSnapshot
from robot_agent.mapping.footholds import Cover, Footholds
from robot_agent.mapping.footprint import WorstTerrain, worst_terrain
from robot_agent.mapping.rolling_grid import RollingGrid
from robot_agent.mapping.sliding_features import cell_features
from robot_agent.mapping.tiles import quantised_tile, worth_sending
from robot_agent.mapping.visibility import forget_contradicted
from weaver_shared.config.mapping import MappingConfig
from weaver_shared.messages import MapTile, OdometryEstimate
from weaver_shared.transforms import Pose


class HeightPatch(Protocol):
    """World-aligned heights (n, n) whose first cell is world cell (row0, column0); NaN unknown."""

    @property
    def row0(self) -> int: ...
    @property
    def column0(self) -> int: ...
    @property
    def cell(self) -> float: ...
    @property
    def elevation(self) -> NDArray[np.float32]: ...
    @property
    def variance(self) -> NDArray[np.float32]: ...
    @property
    def upper(self) -> NDArray[np.float32]: ...
    @property
    def ceiling(self) -> NDArray[np.float32]: ...


class Perceived(Protocol):
    @property
    def stamp_ns(self) -> int: ...
    @property
    def grid(self) -> HeightPatch: ...
    @property
    def sensor_in_world(self) -> NDArray[np.float64]: ...


class TerrainMap:
    """Rolling grid of elevations with roughness and step height of every cell; unseen is unknown, not flat."""

    def __init__(self, config: MappingConfig = MappingConfig()) -> None:  # noqa: B008
        self._config = config
        self.grid = RollingGrid(config)
        self._rules = FusionRules(
            gate=config.gate,
            slack=config.gate_slack,
            rejections=config.rejections,
            floor=config.sigma_floor,
            drift=config.drift,
            ceiling=config.sigma_ceiling,
        )
        self._footholds = Footholds(config.contact_sigma)
        self._poses = PosesAsUsed()
        self._changed: set[tuple[int, int]] = set()
        self._sent: dict[tuple[int, int], MapTile] = {}

    def update(self, perceived: Perceived, odometry: OdometryEstimate) -> None:
        """Merge one frame's heights and renew roughness and step height where they changed.

        Raises ValueError when the patch's cells are not the map's.
        """
        patch, grid = perceived.grid, self.grid
        if not math.isclose(patch.cell, grid.cell):
            raise ValueError(f"the patch has cells of {patch.cell} m, the map of {grid.cell} m")
        x, y = odometry.position_in_world[:2]
        if not (math.isfinite(x) and math.isfinite(y)):
            return
        grid.recentre(x, y)
        extent = fuse(
            patch.elevation,
            patch.variance,
            patch.row0,
            patch.column0,
            grid.row0,
            grid.column0,
            grid.elevation,
            grid.variance,
            grid.rejected,
            grid.accepted,
            grid.seen_ns,
            perceived.stamp_ns,
            self._rules,
        )
        renew_bounds(
            patch.upper,
            patch.ceiling,
            patch.row0,
            patch.column0,
            grid.row0,
            grid.column0,
            grid.elevation,
            grid.upper,
            grid.ceiling,
            self._config.upper_decay,
        )
        gone = forget_contradicted(
            patch.elevation,
            patch.row0,
            patch.column0,
            grid.row0,
            grid.column0,
            grid.cell,
            perceived.sensor_in_world,
            grid.elevation,
            grid.variance,
            grid.upper,
            grid.contradicted,
            self._config.ray_clearance,
            self._config.contradictions,
        )
        extent = joined(extent, gone)
        if extent.row_end > extent.row:
            self._renew_features(extent)

    def remember(self, odometry: OdometryEstimate) -> None:
        """Note a frame's pose, so that the map can follow when odometry corrects it."""
        if np.isfinite(odometry.position_in_world).all():
            self._poses.add(odometry.stamp_ns, odometry.world_from_body)

    def touch(self, footholds: NDArray[np.float64], stamp_ns: int) -> None:
        """Enter points (k, 3) in world, m, that bore a foot at `stamp_ns`."""
        extent = self._footholds.enter(self.grid, footholds, stamp_ns, self._rules)
        if extent is not None and extent.row_end > extent.row:
            self._renew_features(extent)

    @property
    def cover(self) -> Cover:
        """How much higher the ground looks than it bears."""
        return self._footholds.cover

    def follow(self, corrected: Mapping[int, Pose]) -> bool:
        """Deform the map as odometry corrected its poses world_from_body, by stamp; says whether it did.

        Changes too small to matter are left until they have grown.
        """
        stamps, changes = self._poses.changes(corrected)
        if not changes:
            return False
        shift, rise = largest_change(changes, corrected[int(stamps[-1])].position)
        if shift < self._config.deform_shift and rise < self._config.deform_rise:
            return False
        deform(self.grid, stamps, changes)
        self._poses.apply(stamps, changes)
        self.renew_all()
        return True

    def snapshot(self) -> MapSnapshot:
        """The map as it is now, to keep or to show."""
        return MapSnapshot.of(self.grid)

    def restore(self, snapshot: MapSnapshot) -> None:
        """Enter a finished map about its own middle. Raises ValueError on cells of another size."""
        rows, columns = snapshot.shape
        x, y = snapshot.corner
        self.grid.recentre(x + 0.5 * rows * snapshot.cell, y + 0.5 * columns * snapshot.cell)
        snapshot.enter(self.grid)
        self.renew_all()

    def renew_all(self) -> None:
        """Features of every cell anew, and every tile to be sent."""
        grid = self.grid
        self._renew_features(Extent(grid.row0, grid.column0, grid.row0 + grid.size, grid.column0 + grid.size))

    def worst_within(self, x: float, y: float, radius: float | None = None) -> WorstTerrain:
        """Worst roughness and step height within `radius` m (the feet's reach by default) of world (x, y)."""
        return worst_terrain(self.grid, x, y, radius or self._config.query_radius, self._config)

    def elevation_at(self, x: float, y: float) -> float:
        """World z in m of the cell that holds (x, y); NaN unknown."""
        row, column = self.grid.cell_of(x, y)
        if not self.grid.holds(row, column):
            return float("nan")
        return float(self.grid.elevation[row % self.grid.size, column % self.grid.size])

    def changed_tiles(self, stamp_ns: int) -> list[MapTile]:
        """Tiles that changed noticeably since they were last returned, as of `stamp_ns`."""
        changed, self._changed = self._changed, set()
        result = []
        for i, j in sorted(changed):
            if not self._holds_tile(i, j):
                continue
            tile = quantised_tile(self.grid, i, j, stamp_ns)
            if worth_sending(tile, self._sent.get((i, j))):
                self._sent[i, j] = tile
                result.append(tile)
        return result

    def _holds_tile(self, i: int, j: int) -> bool:
        grid = self.grid
        return 0 <= i - grid.tile_row < grid.tiles and 0 <= j - grid.tile_column < grid.tiles

    def _renew_features(self, extent: Extent) -> None:
        """Features of the changed cells and of all whose square holds one of them."""
        grid = self.grid
        reach = self._config.window // 2 + 1  # and one more: a cell's edges are those to its next neighbours
        rows = grid.slots(extent.row - 2 * reach, extent.row_end + 2 * reach, grid.row0)
        columns = grid.slots(extent.column - 2 * reach, extent.column_end + 2 * reach, grid.column0)
        place = np.ix_(rows, columns)
        features = cell_features(grid.elevation[place], grid.variance[place], self._config)
        inner_row = max(extent.row - reach, grid.row0)
        inner_column = max(extent.column - reach, grid.column0)
        inner_row_end = min(extent.row_end + reach, grid.row0 + grid.size)
        inner_column_end = min(extent.column_end + reach, grid.column0 + grid.size)
        skip_row = inner_row - max(extent.row - 2 * reach, grid.row0)
        skip_column = inner_column - max(extent.column - 2 * reach, grid.column0)
        inner = (
            slice(skip_row, skip_row + inner_row_end - inner_row),
            slice(skip_column, skip_column + inner_column_end - inner_column),
        )
        place = np.ix_(rows[inner[0]], columns[inner[1]])
        grid.roughness[place] = features.roughness[inner]
        grid.roughness_sigma[place] = features.roughness_sigma[inner]
        grid.step_height[place] = features.step_height[inner]
        grid.step_height_sigma[place] = features.step_height_sigma[inner]
        grid.slope[place] = features.slope[inner]
        self._changed |= {
            (i, j)
            for i in range(inner_row // grid.tile, (inner_row_end - 1) // grid.tile + 1)
            for j in range(inner_column // grid.tile, (inner_column_end - 1) // grid.tile + 1)
        }
