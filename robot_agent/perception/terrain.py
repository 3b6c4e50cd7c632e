"""Stereo pictures to a height grid and the character of the ground ahead (ICRA'17 III-D, Fig. 4)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.perception.disparity_grid import HeightGrid
from robot_agent.perception.features import Roughness, characterise, patch_features
from robot_agent.perception.ground_plane import fit_plane
from robot_agent.perception.health import PictureHealth
from robot_agent.perception.stereo_sight import StereoSight
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.perception import PerceptionConfig
from weaver_shared.messages import OdometryEstimate, OdometryQuality, StereoFrame, TerrainEstimate
from weaver_shared.transforms import Pose, rotation_z

Array = NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True, kw_only=True)
class PerceivedTerrain:
    """What one pair of pictures says of the ground; an empty grid where they are not to be trusted."""

    stamp_ns: int
    grid: HeightGrid
    sensor_in_world: Array  # (3,)
    estimate: TerrainEstimate
    health: PictureHealth


class TerrainPerception:
    """Rectify, match, fuse into a world-aligned grid, characterise the patch ahead."""

    def __init__(
        self,
        calibration: StereoCalibration,
        config: PerceptionConfig = PerceptionConfig(),  # noqa: B008
    ) -> None:
        self._config = config
        self._working, self._close = (
            StereoSight(calibration, matching, config.grid, config.health, config.matching.scale)
            for matching in (config.matching, config.close_matching)
        )
        self.camera = self._working.camera
        self.mode = config.mode
        """Whether the ground ahead is judged as published or robustly; may be changed between pictures."""

    def step(
        self,
        frame: StereoFrame,
        odometry: OdometryEstimate,
        ground_height: float | None = None,
        *,
        closely: bool = False,
    ) -> PerceivedTerrain:
        """Bad pictures or a lost pose give an estimate of NaN with its reason, never a flat ground.

        `ground_height` is the world's z in m under the soles, where the feet tell it; without, the robot is taken to
        stand at its usual height. `closely`: at full resolution, at several times the cost.
        """
        sight = self._close if closely else self._working
        disparity, health = sight.match(frame)
        world_from_body = odometry.world_from_body
        world_from_camera = world_from_body @ self.camera.body_from_camera
        lost = odometry.quality in (OdometryQuality.LOST, OdometryQuality.INITIALISING)
        if lost or health.score < self._config.health.smallest:
            reason = f"the pose is {odometry.quality.value}" if lost else health.reason
            disparity = np.full_like(disparity, -1)
        else:
            reason = health.reason
        grid = sight.fuse(disparity, world_from_camera, self._foot_plane(world_from_body, ground_height))
        estimate = self._characterise(grid, world_from_body, world_from_camera, frame.stamp_ns, health, reason)
        return PerceivedTerrain(
            stamp_ns=frame.stamp_ns,
            grid=grid,
            sensor_in_world=world_from_camera.position,
            estimate=estimate,
            health=health,
        )

    def _foot_plane(self, world_from_body: Pose, ground_height: float | None) -> tuple[float, float, float]:
        """Level plane through the soles: where ground is expected, give or take the gate."""
        if ground_height is None:
            ground_height = float(world_from_body.transform([0.0, 0.0, -self._config.foot_depth])[2])
        return 0.0, 0.0, ground_height

    def _characterise(
        self,
        grid: HeightGrid,
        world_from_body: Pose,
        world_from_camera: Pose,
        stamp_ns: int,
        health: PictureHealth,
        reason: str,
    ) -> TerrainEstimate:
        config = self._config
        x, y = self._patch_in_world(world_from_body, world_from_camera)
        elevation, variance = grid.at(x, y)
        known = np.isfinite(elevation)
        coverage = float(known.mean())
        features, normal, result = np.full(7, np.nan), UP, Roughness.unknown()
        if coverage >= config.patch.min_coverage:
            noise = float(np.sqrt(np.median(variance[known]))) if self.mode == "robust" else 0.0
            plane = fit_plane(x[known], y[known], elevation[known], self.mode)
            features = patch_features(plane.residual(x, y, elevation), grid.cell, noise, config.features)
            area = (config.patch.far - config.patch.near) * config.patch.width
            normal, result = plane.normal, characterise(features, coverage, area, noise, config.features)
        elif not reason:
            reason = f"{coverage:.0%} of the patch ahead is seen, {config.patch.min_coverage:.0%} are needed"
        return TerrainEstimate(
            stamp_ns=stamp_ns,
            roughness=result.roughness,
            roughness_sigma=result.roughness_sigma,
            step_height=result.step_height,
            step_height_sigma=result.step_height_sigma,
            features=features,
            plane_normal_in_world=normal,
            health=health.score,
            reason=reason,
            mode=self.mode,
        )

    def _patch_in_world(self, world_from_body: Pose, world_from_camera: Pose) -> tuple[Array, Array]:
        """World x, y of the cells of the patch ahead, each (rows, columns); rows run along the heading."""
        patch, cell = self._config.patch, self._config.grid.cell
        forward = np.arange(patch.near + 0.5 * cell, patch.far, cell)
        sideways = np.arange(0.5 * cell - 0.5 * patch.width, 0.5 * patch.width, cell)
        rows, columns = np.meshgrid(forward, sideways, indexing="ij")
        heading = rotation_z(world_from_body.yaw)
        # The patch lies before the middle between the eyes; the grid's camera is the left one.
        middle = world_from_camera.position + 0.5 * self.camera.baseline * world_from_camera.rotation[:, 0]
        x = middle[0] + heading[0, 0] * rows + heading[0, 1] * columns
        y = middle[1] + heading[1, 0] * rows + heading[1, 1] * columns
        return x, y
