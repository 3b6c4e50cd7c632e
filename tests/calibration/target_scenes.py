"""Rigs, motions and what they see of a target, computed from the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_agent.calibration.rig import Rig
from robot_agent.calibration.sightings import Session, Sighting, View
from robot_agent.calibration.target import AprilGrid
from robot_agent.vision.camera import Distortion
from robot_agent.vision.distortion import project
from sim_agent.targets.motion import HandHeldMotion, inertia_along
from sim_agent.targets.recording import RigTruth, draw_rig
from weaver_shared.messages import ImuBatch
from weaver_shared.robots import load_robot
from weaver_shared.robots.description import Imu

GRID = AprilGrid(columns=4, rows=4, tag_size=0.08, spacing=0.3)
IMU: Imu = load_robot("weaver").imu
SIZE = (640, 480)


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    truth: RigTruth
    views: tuple[View, ...]
    inertia: ImuBatch

    @property
    def session(self) -> Session:
        """Every fourth view, as a camera calibration takes it."""
        return Session(views=self.views[::4], sizes=self.truth.rig.sizes, pictures=len(self.views[::4]))


def made_up(
    generator: np.random.Generator,
    *,
    seconds: float,
    noise: float = 0.05,
    axes: tuple[float, float, float, float, float, float] = (1.0, 1.0, 1.0, 1.0, 1.0, 1.0),
    model: Distortion = "radtan",
    with_imu: bool = True,
) -> Scene:
    truth = draw_rig(generator, model, SIZE)
    motion = HandHeldMotion(GRID, 0.55, generator, axes)
    views = []
    for time in np.arange(0.2, seconds, 0.05):
        camera_from_target = motion.target_from_camera(float(time)).inverse()
        eyes = tuple(
            sighting(truth.rig, eye, (place @ camera_from_target).transform(GRID.points), noise, generator)
            for eye, place in enumerate(truth.rig.eye_from_first)
        )
        views.append(View(stamp_ns=round((time - truth.time_offset) * 1e9), eyes=eyes))
    times = np.arange(0.0, seconds + 0.2, 1.0 / IMU.rate)
    inertia = (
        inertia_along(motion, truth.camera_from_imu, times, truth.gravity_in_target, IMU, truth.biases, generator)
        if with_imu
        else ImuBatch.empty()
    )
    return Scene(truth=truth, views=tuple(view for view in views if view.seen), inertia=inertia)


def sighting(rig: Rig, eye: int, points: np.ndarray, noise: float, generator: np.random.Generator) -> Sighting | None:
    """What a perfect detector would give of points (n, 3) in the eye's frame; None for less than 16 corners."""
    pixels = project(rig.cameras[eye], points)
    inside = ((pixels > 5.0) & (pixels < np.array(rig.sizes[eye]) - 6.0)).all(axis=1)
    if inside.sum() < 16:
        return None
    seen = pixels[inside] + noise * generator.standard_normal((int(inside.sum()), 2))
    return Sighting(corners=np.flatnonzero(inside), pixels=seen)
