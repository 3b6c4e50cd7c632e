"""Photographs of the robots at what they do, from the observer's place, small enough for a document."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from sim_agent.rendering.observer import Observer
from sim_agent.study.climb import begin_climb, climbing_order
from sim_agent.study.palette_png import write_palette_png
from sim_agent.study.posture import rise, sit
from sim_agent.study.rig import DT, Rig
from sim_agent.study.speeds import pace_of, parameters_for
from sim_agent.worlds import make_world
from weaver_shared.robots import RobotDescription, load_robot

Array = NDArray[np.float64]

SIZE = (400, 280)  # px, twice as fine when drawn
LONGEST = 120.0  # s
DISTANCE = 4.2
"""From the robot, times the way from its middle to its farthest foot."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """A moment: `at` is how far along x (m) the robot has come, or seconds of walking on level ground."""

    robot: str
    world: str = "flat"
    gait: str = ""
    at: float = 2.5
    sitting: bool = False

    @property
    def file_name(self) -> str:
        if self.world != "flat":
            return f"{self.robot}_{self.world}.png"
        return f"{self.robot}_sitting.png" if self.sitting else f"{self.robot}.png"


GALLERY = (
    *(
        Scene(robot=name)
        for name in (
            "weaver",
            "bullet_a_insectoid",
            "bullet_a_mammalian",
            "bullet_b_insectoid",
            "bullet_b_mammalian",
            "bullet_insectoid",
            "bullet_mammalian",
            "default",
            "max",
            "magneto",
            "octopod",
        )
    ),
    Scene(robot="weaver", sitting=True),
    Scene(robot="weaver", world="incline20", at=2.1),
    Scene(robot="weaver", world="stairs6", at=1.6),
    Scene(robot="bullet_b_insectoid", world="incline20", at=2.1),
    Scene(robot="bullet_b_insectoid", world="stairs6", at=1.6),
)


def take(scene: Scene, folder: Path) -> Path:
    """Walk the robot into the scene and write what is seen; returns the file."""
    robot = load_robot(scene.robot)
    gait = scene.gait or robot.gaits[0]
    rig = Rig(robot, make_world(scene.world, 1))
    try:
        _play(rig, gait, scene)
        picture = _seen(rig, scene)
    finally:
        rig.close()
    path = folder / scene.file_name
    write_palette_png(path, picture)
    return path


def _play(rig: Rig, gait: str, scene: Scene) -> None:
    rig.parameters = parameters_for(rig.robot, gait)
    if scene.world != "flat":
        speed = begin_climb(rig, gait)
        for _ in range(round(LONGEST / DT)):
            if rig.truth().position[0] >= scene.at:
                return
            rig.step(gait=gait, velocity=climbing_order(rig, speed))
        return
    rise(rig, gait)
    if scene.sitting:
        sit(rig, gait)
        return
    pace = pace_of(rig.robot, gait, "forward", rig.parameters)
    for _ in range(round(scene.at / DT)):
        rig.step(gait=gait, velocity=pace.velocity)
    for _ in range(round(1.0 / pace.frequency / DT)):
        if rig.out.swing.any() and abs(rig.out.phase[rig.out.swing].max() - 0.5 * rig.robot.gait(gait).swing) < 0.05:
            return  # feet at their highest
        rig.step(gait=gait, velocity=pace.velocity)


def _seen(rig: Rig, scene: Scene) -> NDArray[np.uint8]:
    width, height = SIZE
    observer = Observer(rig.robot, rig.world, width=2 * width, height=2 * height)
    try:
        picture = observer.picture(rig.body.scene_state(), _beside(rig.robot, climbing=scene.world != "flat"))
    finally:
        observer.close()
    small: NDArray[np.uint8] = cv2.resize(picture, SIZE, interpolation=cv2.INTER_AREA)
    return small


def _beside(robot: RobotDescription, *, climbing: bool) -> Array:
    direction = np.array([0.35, -1.0, 0.35]) if climbing else np.array([0.75, -0.9, 0.55])
    size = float(np.linalg.norm(robot.stance_in_body[:, :2], axis=1).max())
    beside: Array = DISTANCE * size * direction / np.linalg.norm(direction)
    return beside
