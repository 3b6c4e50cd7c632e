"""What is told of a guided calibration, whatever it has come to."""

from __future__ import annotations

from concurrent.futures import Future
from dataclasses import dataclass, replace

import numpy as np

from robot_agent.calibration.guided_session import GuidedSession, Solved
from robot_agent.calibration.session_orders import SessionOrder
from robot_agent.calibration.session_sources import SessionSource
from weaver_shared.messages import CalibrationState

FAR_PAST_NS = -(10**18)


@dataclass(slots=True, kw_only=True)
class RunningSession:
    order: SessionOrder
    source: SessionSource
    starting: Future[GuidedSession]
    session: GuidedSession | None = None  # once started
    looked_ns: int = FAR_PAST_NS
    shown_ns: int = FAR_PAST_NS
    step: str = ""  # of the solving
    told_step: str = ""  # the one that was told last
    solving: Future[Solved] | None = None
    solved: Solved | None = None

    @property
    def phase(self) -> str:
        if self.solved is not None:
            return "solved" if self.solved.files else "failed"
        if self.session is None:
            return "starting"
        return "looking" if self.solving is None else "solving"


def state_of(running: RunningSession | None, calibrations: tuple[str, ...], folder: str) -> CalibrationState:
    """`calibrations` are those there are, all in `folder` on the robot."""
    idle = CalibrationState(
        phase="idle",
        part="cameras",
        source="",
        target="",
        lenses="",
        calibrations=calibrations,
        pictures=0,
        views=0,
        seconds=0.0,
        motions=(),
        seen=(),
        cover=np.zeros((0, 6, 8), dtype=np.int64),
        wishes=(),
        advice="",
        step="",
        usable=False,
        verdict="",
        results=(),
        files=(),
        folder=folder,
    )
    if running is None:
        return idle
    order, solved = running.order, running.solved or Solved(verdict="")
    begun = replace(
        idle,
        phase=running.phase,
        part=order.part,
        source=running.source.name,
        target=str(order.target),
        lenses=(order.lenses or "robot") if order.part == "imu" else "",
        advice="the calibrator is starting",
        step=running.step,
        usable=solved.usable,
        verdict=solved.verdict,
        results=solved.lines,
        files=solved.files,
    )
    if running.session is None:
        return begun
    filled = running.session.filled(begun)
    if not running.source.ended:
        return filled
    done = "all of the recording was looked at; solve"
    nothing_lacks = all(wish.met for wish in filled.wishes) and all(motion.met for motion in filled.motions)
    return replace(filled, advice=done if nothing_lacks else f"{done}, or for a better one: {filled.advice}")
