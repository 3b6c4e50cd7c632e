"""Feeds the vision loop from the bus: newest picture wins, inertia is never dropped, a restarted robot begins anew."""

from __future__ import annotations

import threading

from robot_agent.close_looks import CloseLooks
from robot_agent.loops import VisionLoop
from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.latest import LatestSlot
from weaver_shared.messages import Proprioception, RobotState, StereoFrame
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

PICTURE_WAIT = 0.2
IMU_WAIT = 0.1
BACKWARDS_NS = 500_000_000
"""A stamp this much older than the last one means that the robot's process has been started again."""


class VisionProcess:
    def __init__(self, *, robot_id: str, robot: RobotDescription, bus: Bus) -> None:
        self._robot_id = robot_id
        self._robot = robot
        self._bus = bus
        self._pictures: LatestSlot[StereoFrame] = LatestSlot()
        self._states: LatestSlot[RobotState] = LatestSlot()
        self._felt = threading.Condition()
        self._pending: list[Proprioception] = []
        self._loop = VisionLoop(robot_id=robot_id, robot=robot, bus=bus)
        self._last_ns = -1
        self._looks = CloseLooks()
        bus.answer_queries(robot_id, topics.VISION_COMMANDS, self._looks.ask)
        bus.subscribe(robot_id, topics.STEREO, lambda _id, _key, frame: self._pictures.put(frame))
        bus.subscribe(robot_id, topics.STATE, lambda _id, _key, state: self._states.put(state))
        bus.subscribe(robot_id, topics.PROPRIOCEPTION, self._feel)
        bus.announce(robot_id, "vision")

    def run(self, ended: threading.Event) -> None:
        while not ended.is_set():
            self.turn(PICTURE_WAIT)

    def turn(self, wait: float = 0.0) -> None:
        """Process the newest picture if one comes within `wait` s."""
        frame = self._pictures.take(wait)
        if frame is not None:
            self._see(frame)

    def _see(self, frame: StereoFrame) -> None:
        if frame.stamp_ns < self._last_ns - BACKWARDS_NS:
            self._start_again()
        if frame.stamp_ns <= self._last_ns:
            return
        if not self._loop.begun:
            state = self._states.take()
            if state is None or abs(state.stamp_ns - frame.stamp_ns) > BACKWARDS_NS:
                return
            self._loop.begin(Pose.of(state.position_in_world, state.wxyz))
        if self._gather(frame.stamp_ns):
            self._last_ns = frame.stamp_ns
            tick = self._loop.step(frame, closely=self._looks.due(frame.stamp_ns))
            if tick.look is not None:
                self._looks.answer(tick.look)

    def _gather(self, stamp_ns: int) -> bool:
        """Hand over what was felt; True when the IMU has reached the picture's stamp."""
        with self._felt:
            self._felt.wait_for(lambda: bool(self._pending) and self._pending[-1].stamp_ns >= stamp_ns, IMU_WAIT)
            pending, self._pending = self._pending, []
        for sensed in pending:
            self._loop.feel(sensed)
        return self._loop.imu_covers(stamp_ns)

    def _feel(self, _robot_id: str, _key: str, sensed: Proprioception) -> None:
        with self._felt:
            if self._pending and sensed.stamp_ns < self._pending[-1].stamp_ns - BACKWARDS_NS:
                self._pending.clear()
            self._pending.append(sensed)
            del self._pending[:-1000]
            self._felt.notify_all()

    def _start_again(self) -> None:
        self._loop = VisionLoop(robot_id=self._robot_id, robot=self._robot, bus=self._bus)
        self._last_ns = -1
