"""One simulated robot in one process on the simulated clock: deterministic bit for bit and as fast as it goes.

The same loops run as in real time, joined by an in-memory bus. A picture's results reach the walk loop one camera
period later, as they would from a process of its own; that leaves a second core free to work on them meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import Protocol

import cv2

from robot_agent.body import Body
from robot_agent.felt_queue import Felt
from robot_agent.loops import CONTROL_RATE, VisionLoop, WalkLoop
from robot_agent.mapping import TerrainMap
from robot_agent.pipeline import VisionTick, WalkTick
from sim_agent.body import SimulatedBody
from sim_agent.rendering import StereoRenderer, frame_sequence
from sim_agent.worlds import World
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import CommandName, Proprioception, SceneState, StereoFrame, TruthState
from weaver_shared.operator import Operator
from weaver_shared.robots import RobotDescription

OPERATOR = "lock step"
RETAIN_TICKS = 50


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """What one control tick left behind; truth is for evaluation alone."""

    walk: WalkTick
    sensed: Proprioception
    vision: VisionTick | None
    truth: TruthState | None


class SteppedBody(Body, Protocol):
    """A body in a world that can be looked at, on a clock of its own that moves with its ticks."""

    def truth(self) -> TruthState: ...

    def camera_due(self) -> bool:
        """Whether the cameras expose at this tick."""
        ...

    def scene_state(self) -> SceneState: ...


class LockStep:
    """Steps body, walk loop, renderer and vision loop in a fixed order."""

    def __init__(
        self,
        robot: RobotDescription,
        world: World,
        seed: int,
        *,
        robot_id: str = "sim-1",
        tell_truth: bool = True,
        body: Callable[[RobotDescription, World, int], SteppedBody] = SimulatedBody,
    ) -> None:
        cv2.setNumThreads(1)
        self.bus = MemoryBus()
        self.robot_id = robot_id
        self.robot = robot
        self._tell_truth = tell_truth
        self._body = body(robot, world, seed)
        self.clock = SimulatedClock(self._body.scene_state().stamp_ns)
        self._renderer = StereoRenderer(robot, world, seed)
        self.walk = WalkLoop(
            robot_id=robot_id, body=self._body, bus=self.bus, world=world.name, wall_clock_ns=self.clock.now_ns
        )
        self._vision = VisionLoop(robot_id=robot_id, robot=robot, bus=self.bus)
        self._workers = ThreadPoolExecutor(1)
        self._seeing: Future[VisionTick] | None = None
        self._ticks = 0
        self.on_picture: Callable[[StereoFrame, Felt], None] | None = None
        """Sees every picture with what was felt up to it, for studies that look a second time."""
        self.operator = Operator(self.bus, robot_id, OPERATOR)

    def step(self) -> Moment:
        """One control tick, and the camera's and vision's turn when it is theirs."""
        self.clock.forward(seconds=1.0 / CONTROL_RATE)
        if self.operator.has_held_control and self._ticks % RETAIN_TICKS == 0:
            self.operator.send(CommandName.RETAIN_CONTROL)
        walk, sensed = self.walk.tick()
        if not self._vision.begun:
            self._vision.begin(walk.state.world_from_body)
        seen = None
        camera_due = self._body.camera_due()
        if camera_due:
            seen = self._collect()
        self._vision.feel(sensed)
        if camera_due:
            scene = self._body.scene_state()
            frame = self._renderer.render(scene, frame_sequence(self.robot, scene.stamp_ns))
            self.bus.publish(self.robot_id, topics.STEREO, frame)
            felt = self._vision.take_felt(frame.stamp_ns)
            if self.on_picture is not None:
                self.on_picture(frame, felt)
            self._seeing = self._workers.submit(self._vision.process, frame, felt)
        self._ticks += 1
        truth = self._body.truth() if self._tell_truth else None
        if truth is not None:
            self.bus.publish(self.robot_id, topics.TRUTH, truth)
        return Moment(walk=walk, sensed=sensed, vision=seen, truth=truth)

    def map(self) -> TerrainMap | None:
        """The robot's terrain map after the picture being processed."""
        if self._seeing is not None:
            self._seeing.result()
        return self._vision.map

    def close(self) -> None:
        self._workers.shutdown()
        self._renderer.close()
        self._body.close()

    def _collect(self) -> VisionTick | None:
        """The results of the previous picture, published as they arrive."""
        if self._seeing is None:
            return None
        tick = self._seeing.result()
        self._seeing = None
        self._vision.publish(tick)
        return tick
