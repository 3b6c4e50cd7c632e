"""The robot's calibrator: looks for the target in live or recorded pictures, guides who moves, solves and saves."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from datetime import datetime
from pathlib import Path

from robot_agent.calibration.guided_session import GuidedSession, Solved
from robot_agent.calibration.session_orders import FILE, FOLDER, SessionOrder
from robot_agent.calibration.session_sources import LiveSource, RecordedSource, SessionSource
from robot_agent.calibration.session_state import RunningSession, state_of
from robot_agent.recording import open_recording
from robot_agent.recording.file_parts import file_part
from robot_agent.waiting_orders import WaitingOrders
from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.errors import InputError, ResourceError, WeaverError
from weaver_shared.messages import Answer, CameraPicture, Command, CommandName
from weaver_shared.robots import RobotDescription

CAMERA = "calibration"
SHOW_EVERY_NS = 200_000_000
"""Of the pictures' own time, between two that people are shown."""

MOST_OFFERED = 20
"""Calibrations of cameras to go on from, the newest."""


class CalibrationProcess:
    """`turn` does the work but for loading what is heavy and for solving, which a thread does meanwhile."""

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
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="calibrate")
        self._running: RunningSession | None = None
        self._calibrations = _calibrations_in(folder)
        bus.answer_queries(robot_id, topics.CALIBRATOR_COMMANDS, self._orders.ask)
        bus.answer_queries(robot_id, topics.CALIBRATION_PART, lambda request: file_part(self._folder, FILE, request))
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
        if running is None or running.solved is not None:
            self._orders.wait(wait)
        elif running.session is None:
            self._await_start(running, wait)
        elif running.solving is not None:
            self._await_solution(running, running.solving, wait)
        else:
            self._look(running, running.session, wait)

    def close(self) -> None:
        self._end()
        self._worker.shutdown()

    def _carry_out(self, command: Command) -> Answer:
        try:
            match command.command:
                case CommandName.START_CALIBRATION:
                    self._begin(SessionOrder.of(command.name))
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

    def _begin(self, order: SessionOrder) -> None:
        if self._running is not None and self._running.solving is not None:
            raise ResourceError("a calibration is being solved; wait for it")
        recording = open_recording(self._recordings / order.recording) if order.recording else None
        robot = self._robot if recording is None else recording.robot
        if not robot.has_camera:
            raise InputError(f"the robot {robot.name!r} has no camera")
        if order.lenses and not (self._folder / order.lenses / "camchain.yaml").is_file():
            raise InputError(f"there is no calibration of cameras named {order.lenses}")
        self._end()
        inertia = order.part == "imu"
        source: SessionSource = (
            LiveSource(self._open_bus(), self._robot_id, inertia=inertia)
            if recording is None
            else RecordedSource(recording, inertia=inertia)
        )
        starting = self._worker.submit(_begun, order, robot, self._folder)
        self._running = RunningSession(order=order, source=source, starting=starting)

    def _await_start(self, running: RunningSession, wait: float) -> None:
        if not running.starting.done():
            self._orders.wait(wait)
            return
        try:
            running.session = running.starting.result()
        except WeaverError as error:
            running.solved = Solved(verdict=str(error))
        self._tell()

    def _look(self, running: RunningSession, session: GuidedSession, wait: float) -> None:
        if running.source.ended:
            self._orders.wait(wait)
            return
        try:
            frame = running.source.take(session.feel, wait)
            if frame is None or 0 <= frame.stamp_ns - running.looked_ns < session.look_every_ns:
                if running.source.ended:
                    self._tell()
                return
            running.looked_ns = frame.stamp_ns
            session.look(frame)
        except WeaverError as error:
            running.solved = Solved(verdict=str(error))
            self._tell()
            return
        if not 0 <= frame.stamp_ns - running.shown_ns < SHOW_EVERY_NS:
            running.shown_ns = frame.stamp_ns
            picture = CameraPicture(stamp_ns=frame.stamp_ns, name=CAMERA, jpeg=session.drawn(frame))
            self._bus.publish(self._robot_id, topics.CAMERA, picture, name=CAMERA)
            self._tell()

    def _solve(self, model: str) -> None:
        running = self._running
        if running is None or running.session is None:
            raise ResourceError("there is nothing to solve" if running is None else "the calibration is only starting")
        if running.solving is not None:
            raise ResourceError("it is being solved already")
        if model not in ("radtan", "equidistant"):
            raise InputError(f"lens model {model!r:.40} is unknown; known are radtan and equidistant")

        def tell(step: str) -> None:
            running.step = step

        folder = self._folder / f"{self._robot_id}_{self._wall_time():%Y-%m-%d_%H-%M-%S}"
        running.solved = None
        running.solving = self._worker.submit(_solved, running.session, model, folder, tell)

    def _await_solution(self, running: RunningSession, solving: Future[Solved], wait: float) -> None:
        if not solving.done():
            self._orders.wait(wait)
        if solving.done():
            running.solved, running.solving = solving.result(), None
            self._calibrations = _calibrations_in(self._folder)
        if running.solved is not None or running.step != running.told_step:
            self._tell()

    def _end(self) -> None:
        running, self._running = self._running, None
        if running is not None:
            running.source.close()

    def _tell(self) -> None:
        state = state_of(self._running, self._calibrations, str(self._folder.absolute()))
        if self._running is not None:
            self._running.told_step = state.step
        self._bus.publish(self._robot_id, topics.CALIBRATION, state)


def _begun(order: SessionOrder, robot: RobotDescription, calibrations: Path) -> GuidedSession:
    """On the worker's thread: the first time this loads what an idle calibrator does without."""
    from robot_agent.calibration.sessions import begin_session

    return begin_session(order, robot, calibrations)


def _solved(session: GuidedSession, model: str, folder: Path, tell: Callable[[str], None]) -> Solved:
    """Solves and saves, on the worker's thread."""
    try:
        solved = session.solve(model, folder, tell)
        names = sorted(path.name for path in folder.iterdir())
    except WeaverError as error:
        return Solved(verdict=str(error))
    except OSError as error:
        return Solved(verdict=f"the results can not be saved: {error}")
    return replace(solved, files=tuple(f"{folder.name}/{name}" for name in names))


def _calibrations_in(folder: Path) -> tuple[str, ...]:
    """Of cameras, by their folders' names, the newest first."""
    found = [path.parent for path in folder.glob("*/camchain.yaml") if FOLDER.fullmatch(path.parent.name)]
    found.sort(key=lambda path: path.stat().st_mtime, reverse=True)
    return tuple(path.name for path in found[:MOST_OFFERED])
