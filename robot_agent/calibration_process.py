"""The robot's calibrator: looks for the target in live or recorded pictures, guides who moves it, solves and saves."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

import numpy as np

from robot_agent.calibration.guidance import Wish
from robot_agent.calibration.guided import GuidedCalibration, drawn
from robot_agent.calibration.guided_results import figures, save, target_of
from robot_agent.calibration.rig import Rig
from robot_agent.recording import open_recording
from robot_agent.recording.file_parts import file_part
from robot_agent.vision.camera import StereoCalibration
from robot_agent.waiting_orders import WaitingOrders
from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.errors import InputError, ResourceError, WeaverError
from weaver_shared.latest import LatestSlot
from weaver_shared.messages import (
    Answer,
    CalibrationState,
    CalibrationWish,
    CameraPicture,
    Command,
    CommandName,
    StereoFrame,
)
from weaver_shared.robots import RobotDescription

CAMERA = "calibration"
LOOK_EVERY_NS = 200_000_000
"""Of the pictures' own time: five looks a second are enough for a hand, and leave the computer to the robot."""

_FILE = re.compile(r"[A-Za-z0-9_-]{1,80}/(camchain\.yaml|target\.yaml|camera\.toml|report\.html|report\.md)")
_RECORDING = re.compile(r"[A-Za-z0-9_-][A-Za-z0-9_.-]{0,100}\.mcap")


@dataclass(slots=True, kw_only=True)
class _Result:
    verdict: str
    usable: bool = False
    lines: tuple[str, ...] = ()
    files: tuple[str, ...] = ()


@dataclass(slots=True, kw_only=True)
class _Running:
    """A calibration under way; `bus` is an ear for live pictures, `frames` are those of a recording."""

    guided: GuidedCalibration
    source: str
    bus: Bus | None = None
    frames: Iterator[StereoFrame] | None = None
    newest: LatestSlot[StereoFrame] = field(default_factory=LatestSlot)
    looked_ns: int = -LOOK_EVERY_NS
    step: str = ""
    solving: Future[_Result] | None = None
    result: _Result | None = None


class CalibrationProcess:
    """`turn` does the work but for solving, which a thread does meanwhile."""

    def __init__(
        self,
        *,
        robot_id: str,
        robot: RobotDescription,
        bus: Bus,
        open_bus: Callable[[], Bus],
        recordings: Path,
        folder: Path,
        wall_time: Callable[[], datetime],
    ) -> None:
        self._robot_id = robot_id
        self._robot = robot
        self._bus = bus
        self._open_bus = open_bus
        self._recordings = recordings
        self._folder = folder
        self._wall_time = wall_time
        self._orders = WaitingOrders()
        self._solver = ThreadPoolExecutor(1, thread_name_prefix="solve")
        self._running: _Running | None = None
        bus.answer_queries(robot_id, topics.CALIBRATOR_COMMANDS, self._orders.ask)
        bus.answer_queries(robot_id, topics.CALIBRATION_PART, lambda request: file_part(self._folder, _FILE, request))
        bus.announce(robot_id, "calibrator")
        self._tell()

    def run(self, ended: threading.Event) -> None:
        while not ended.is_set():
            self.turn(0.2)
        self.close()

    def turn(self, wait: float = 0.0) -> None:
        """Carry out orders and look at one picture, waiting at most so many s for either."""
        self._orders.carry_out(self._carry_out)
        running = self._running
        if running is None or running.result is not None:
            self._orders.wait(wait)
        elif running.solving is not None:
            self._await_solution(running, wait)
        else:
            self._look(running, wait)

    def close(self) -> None:
        self._end()
        self._solver.shutdown()

    def _carry_out(self, command: Command) -> Answer:
        try:
            match command.command:
                case CommandName.START_CALIBRATION:
                    self._begin(command.name)
                case CommandName.SOLVE_CALIBRATION:
                    self._solve(command.name or "radtan")
                case CommandName.END_CALIBRATION:
                    self._end()
                case _:
                    raise ResourceError(f"the calibrator does not know {command.command.value}")
        except WeaverError as error:
            return Answer(accepted=False, reason=str(error))
        finally:
            self._tell()
        return Answer(accepted=True, reason="")

    def _begin(self, name: str) -> None:
        text, _, recorded = name.partition(" from ")
        target = target_of(text)
        if self._running is not None and self._running.solving is not None:
            raise ResourceError("a calibration is being solved; wait for it")
        robot, frames = self._robot, None
        if recorded:
            if not _RECORDING.fullmatch(recorded):
                raise InputError(f"{recorded!r:.60} is not the name of a recording")
            recording = open_recording(self._recordings / recorded)
            robot = recording.robot
            frames = (frame for _, _, frame in recording.messages(topics.STEREO))
        if not robot.has_camera:
            raise InputError(f"the robot {robot.name!r} has no camera")
        pair = StereoCalibration.of_robot(robot)
        self._end()
        running = _Running(
            guided=GuidedCalibration(target, Rig.of((pair.left, pair.right))),
            source=recorded or "cameras",
            frames=frames,
        )
        if not recorded:
            running.bus = self._open_bus()
            running.bus.subscribe(self._robot_id, topics.STEREO, lambda _id, _key, frame: running.newest.put(frame))
        self._running = running

    def _look(self, running: _Running, wait: float) -> None:
        frame = running.newest.take(wait) if running.frames is None else next(running.frames, None)
        if frame is None:
            if running.frames is not None:
                self._orders.wait(wait)  # all of the recording was looked at
            return
        if 0 <= frame.stamp_ns - running.looked_ns < LOOK_EVERY_NS:
            return
        running.looked_ns = frame.stamp_ns
        try:
            running.guided.look(frame)
        except WeaverError as error:
            running.result = _Result(verdict=str(error))
        else:
            jpeg = drawn(frame, running.guided.sightings)
            picture = CameraPicture(stamp_ns=frame.stamp_ns, name=CAMERA, jpeg=jpeg)
            self._bus.publish(self._robot_id, topics.CAMERA, picture, name=CAMERA)
        self._tell()

    def _solve(self, model: str) -> None:
        running = self._running
        if running is None or running.solving is not None:
            raise ResourceError("there is nothing to solve" if running is None else "it is being solved already")
        if model not in ("radtan", "equidistant"):
            raise InputError(f"lens model {model!r:.40} is unknown; known are radtan and equidistant")

        def tell(step: str) -> None:
            running.step = step

        running.result = None
        running.solving = self._solver.submit(self._solved, running.guided, model, tell)

    def _await_solution(self, running: _Running, wait: float) -> None:
        if running.solving is None:
            return
        before = running.step
        if not running.solving.done():
            self._orders.wait(wait)
        if running.solving.done():
            running.result, running.solving = running.solving.result(), None
        if running.result is not None or running.step != before:
            self._tell()

    def _solved(self, guided: GuidedCalibration, model: str, tell: Callable[[str], None]) -> _Result:
        """Solves and saves, on a thread of its own."""
        try:
            estimate, wished, verdict = guided.solve("equidistant" if model == "equidistant" else "radtan", tell)
            name = f"{self._robot_id}_{self._wall_time():%Y-%m-%d_%H-%M-%S}"
            save(guided, estimate, wished, verdict, self._folder / name)
        except WeaverError as error:
            return _Result(verdict=str(error))
        except OSError as error:
            return _Result(verdict=f"the results can not be saved: {error}")
        files = sorted(path.name for path in (self._folder / name).iterdir())
        return _Result(
            verdict=str(verdict),
            usable=verdict.usable,
            lines=tuple(figures(estimate)),
            files=tuple(f"{name}/{file}" for file in files),
        )

    def _end(self) -> None:
        running, self._running = self._running, None
        if running is not None and running.bus is not None:
            running.bus.close()

    def _tell(self) -> None:
        running = self._running
        guided = running.guided if running is not None else None
        result = (running.result if running is not None else None) or _Result(verdict="")
        state = CalibrationState(
            phase=_phase(running),
            source=running.source if running is not None else "",
            target=str(guided.target) if guided is not None else "",
            pictures=guided.pictures if guided is not None else 0,
            views=guided.views if guided is not None else 0,
            seen=tuple(len(s) if s else 0 for s in guided.sightings) if guided is not None else (),
            cover=guided.cover() if guided is not None else np.zeros((0, 6, 8), dtype=np.int64),
            wishes=tuple(_wish(wish) for wish in guided.wishes()) if guided is not None else (),
            advice=guided.advice() if guided is not None else "",
            step=running.step if running is not None else "",
            usable=result.usable,
            verdict=result.verdict,
            results=result.lines,
            files=result.files,
            folder=str(self._folder.absolute()),
        )
        self._bus.publish(self._robot_id, topics.CALIBRATION, state)


def _phase(running: _Running | None) -> str:
    if running is None:
        return "idle"
    if running.solving is not None:
        return "solving"
    if running.result is None:
        return "looking"
    return "solved" if running.result.files else "failed"


def _wish(wish: Wish) -> CalibrationWish:
    return CalibrationWish(what=wish.what, met=bool(wish.met), advice=wish.advice)
