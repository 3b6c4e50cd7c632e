"""One way of looking at a pair of pictures: rectified to one size, matched, judged, and put into world cells."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.perception.disparity_grid import DisparityGrid, HeightGrid
from robot_agent.perception.health import PictureHealth, assess
from robot_agent.perception.stereo_matching import StereoMatcher
from robot_agent.perception.working_camera import WorkingCamera
from robot_agent.vision.camera import StereoCalibration
from robot_agent.vision.rectification import Picture, Rectifier
from weaver_shared.config.perception import GridConfig, HealthConfig, MatchingConfig
from weaver_shared.messages import StereoFrame
from weaver_shared.transforms import Pose

Disparity = NDArray[np.int16]


class StereoSight:
    """Matches at `matching`'s size; health is judged at `judged_scale`, so that all sights share its limits."""

    def __init__(
        self,
        calibration: StereoCalibration,
        matching: MatchingConfig,
        grid: GridConfig,
        health: HealthConfig,
        judged_scale: float,
    ) -> None:
        self._rectifier = Rectifier(calibration, matching.scale)
        self.camera = WorkingCamera.of(self._rectifier)
        self._matcher = StereoMatcher(matching)
        self._grid = DisparityGrid(self.camera, grid, matching)
        self._health = health
        self._finer = max(1, round(matching.scale / judged_scale))

    def match(self, frame: StereoFrame) -> tuple[Disparity, PictureHealth]:
        """Disparity (height, width) in sixteenths of a pixel of this sight, negative where there is no match."""
        left, right = self._rectifier.rectify(frame)
        disparity = self._matcher.match(left, right)
        step = self._finer
        judged = np.ascontiguousarray(disparity[::step, ::step] // step)
        return disparity, assess(_smaller(left, step), _smaller(right, step), judged, self._health)

    def fuse(self, disparity: Disparity, world_from_camera: Pose, ground: tuple[float, float, float]) -> HeightGrid:
        """As `DisparityGrid.fuse`."""
        return self._grid.fuse(disparity, world_from_camera, ground)


def _smaller(picture: Picture, step: int) -> Picture:
    """The picture with every `step` x `step` pixels averaged."""
    if step == 1:
        return picture
    height, width = picture.shape
    size = (-(-width // step), -(-height // step))  # as many as are left of the disparity
    return np.asarray(cv2.resize(picture, size, interpolation=cv2.INTER_AREA), dtype=np.uint8)
