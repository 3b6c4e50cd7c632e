"""Ways a stereo pair is spoilt, by how much, and what becomes of heights and health."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.perception import TerrainPerception
from robot_agent.vision.camera import StereoCalibration
from sim_agent.rendering import StereoRenderer
from sim_agent.worlds import World
from weaver_shared.config.perception import PerceptionConfig
from weaver_shared.messages import OdometryEstimate, SceneState, StereoFrame
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose, rotation_y

Picture = NDArray[np.uint8]
Array = NDArray[np.float64]

RIGHT_TO = 0.01  # m: cells that a clean pair gives this exactly are judged
REACH = 1.2  # m from the camera
GREY = 190.0  # of fog


def _each(frame: StereoFrame, change: Callable[[Picture], Picture]) -> StereoFrame:
    return replace(frame, left=change(frame.left), right=change(frame.right))


def blurred(frame: StereoFrame, length: float) -> StereoFrame:
    """Both eyes smeared along the rows over `length` px, as by a turn during the exposure."""
    return _each(frame, lambda picture: np.asarray(cv2.blur(picture, (max(1, round(length)), 1)), dtype=np.uint8))


def jolted(frame: StereoFrame, length: float) -> StereoFrame:
    """Both eyes smeared across the rows over `length` px, as by a step during the exposure."""
    return _each(frame, lambda picture: np.asarray(cv2.blur(picture, (1, max(1, round(length)))), dtype=np.uint8))


def darkened(frame: StereoFrame, share: float) -> StereoFrame:
    """Light less by `share` (0..1) while the noise stays: what is left is rounded to whole grey levels."""
    noise = np.random.default_rng([7, frame.sequence]).normal(0.0, 1.5, (2, *frame.left.shape))
    left, right = (
        np.clip(np.rint((1.0 - share) * picture + grain), 0, 255).astype(np.uint8)
        for picture, grain in zip((frame.left, frame.right), noise, strict=True)
    )
    return replace(frame, left=left, right=right)


def fogged(frame: StereoFrame, share: float) -> StereoFrame:
    """A veil of `share` (0..1) over everything."""
    return _each(frame, lambda picture: np.rint((1.0 - share) * picture + share * GREY).astype(np.uint8))


def half_blind(frame: StereoFrame, share: float) -> StereoFrame:
    """The right eye's light less by `share` (0..1); at 1 it is black."""
    return replace(frame, right=np.rint((1.0 - share) * frame.right).astype(np.uint8))


def misaligned(frame: StereoFrame, pixels: float) -> StereoFrame:
    """The right eye's rows lower by `pixels`, as after a knock."""
    shift = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, pixels]])
    height, width = frame.right.shape
    moved = cv2.warpAffine(frame.right, shift, (width, height), borderMode=cv2.BORDER_REPLICATE)
    return replace(frame, right=np.asarray(moved, dtype=np.uint8))


@dataclass(frozen=True, slots=True)
class Spoiling:
    change: Callable[[StereoFrame, float], StereoFrame]
    levels: tuple[float, ...]
    unit: str


SPOILINGS = {
    "blur along rows": Spoiling(blurred, (5, 10, 15, 21, 31, 41, 61, 81), "px"),
    "blur across rows": Spoiling(jolted, (5, 10, 15, 21, 31, 41, 61, 81), "px"),
    "darkness": Spoiling(darkened, (0.5, 0.8, 0.9, 0.95, 0.98, 1.0), "of the light gone"),
    "fog": Spoiling(fogged, (0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 1.0), "of the contrast gone"),
    "right eye dark": Spoiling(half_blind, (0.3, 0.6, 0.8, 0.9, 0.95, 1.0), "of its light gone"),
    "rows apart": Spoiling(misaligned, (0.5, 1.0, 1.5, 2.0, 3.0, 4.0), "px"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class SpoiledResult:
    """Over all views: median health, and the 90 % quantile of the height errors where clean pictures are right."""

    kind: str
    level: float
    unit: str
    health: float
    error: float  # m, NaN where nothing is matched any more
    seen: float  # share of those cells that still have a height
    trusted: bool  # the health is above what perception asks for


class Views:
    """Clean pairs at places along a course, and the heights they give when nothing is spoilt."""

    def __init__(self, robot: RobotDescription, world: World, places: list[float], seed: int) -> None:
        self._robot, self._world = robot, world
        config = PerceptionConfig()
        self._smallest = config.health.smallest
        open_gate = config.model_copy(update={"health": config.health.model_copy(update={"smallest": 0.0})})
        self._perception = TerrainPerception(StereoCalibration.of_robot(robot), open_gate)
        self._frames, self._poses = [], []
        renderer = StereoRenderer(robot, world, seed)
        try:
            for index, x in enumerate(places):
                pose = self._standing_at(x)
                scene = SceneState(
                    stamp_ns=index,
                    position_in_world=pose.position,
                    wxyz=pose.wxyz,
                    joint_position=np.zeros(robot.joint_count),
                )
                self._frames.append(renderer.render(scene, index))
                self._poses.append(pose)
        finally:
            renderer.close()
        self.warning = renderer.warning
        self._right = [np.abs(self._errors(k, frame)[1]) < RIGHT_TO for k, frame in enumerate(self._frames)]

    def spoil(self, kind: str, level: float) -> SpoiledResult:
        """Judge every view spoilt to `level`, a value of `SPOILINGS[kind].levels` or any other in its unit."""
        spoiling = SPOILINGS[kind]
        healths, errors, seen = [], [], []
        for k, frame in enumerate(self._frames):
            health, error = self._errors(k, spoiling.change(frame, level))
            judged = error[self._right[k]]
            healths.append(health)
            errors.append(np.abs(judged[np.isfinite(judged)]))
            seen.append(float(np.isfinite(judged).mean()))
        found = np.concatenate(errors)
        health = float(np.median(healths))
        return SpoiledResult(
            kind=kind,
            level=level,
            unit=spoiling.unit,
            health=health,
            error=float(np.quantile(found, 0.9)) if len(found) else float("nan"),
            seen=float(np.mean(seen)),
            trusted=health >= self._smallest,
        )

    def _errors(self, index: int, frame: StereoFrame) -> tuple[float, Array]:
        """Health, and height errors (n, n) of the cells near the camera; NaN where there is none."""
        pose = self._poses[index]
        perceived = self._perception.step(frame, OdometryEstimate.at_rest(pose, frame.stamp_ns))
        grid = perceived.grid
        n = grid.elevation.shape[0]
        x = (grid.row0 + np.arange(n) + 0.5) * grid.cell
        y = (grid.column0 + np.arange(n) + 0.5) * grid.cell
        error = grid.elevation - self._world.elevation(x[:, None], y[None, :])
        near = np.hypot(x[:, None] - pose.position[0], y[None, :] - pose.position[1]) < REACH
        return perceived.health.score, np.where(near, error, np.nan)

    def _standing_at(self, x: float) -> Pose:
        """The body level with the ground about it."""
        along = np.linspace(-0.3, 0.3, 7)
        ground = self._world.elevation(*np.meshgrid(x + along, along, indexing="ij")).mean(axis=1)
        pitch = -np.arctan(np.polyfit(along, ground, 1)[0])
        return Pose(
            rotation=rotation_y(float(pitch)), position=np.array([x, 0.0, ground.mean() + self._robot.clearance])
        )
