"""The guided calibration of the cameras, as the calibrator sees it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from robot_agent.calibration.drawing import drawn
from robot_agent.calibration.guided import GuidedCalibration
from robot_agent.calibration.guided_results import figures, save
from robot_agent.calibration.guided_session import Solved, guided_state
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.target import Target
from weaver_shared.messages import CalibrationState, ImuBatch, StereoFrame


class CameraSession:
    look_every_ns = 200_000_000
    """Five looks a second are enough for a hand, and leave the computer to the robot."""

    def __init__(self, target: Target, guess: Rig) -> None:
        self._guided = GuidedCalibration(target, guess)

    def look(self, frame: StereoFrame) -> None:
        self._guided.look(frame)

    def drawn(self, frame: StereoFrame) -> bytes:
        return drawn(frame, self._guided.sightings)

    def feel(self, samples: ImuBatch) -> None:
        """Lenses do not depend on it."""

    def filled(self, state: CalibrationState) -> CalibrationState:
        return replace(guided_state(state, self._guided), cover=self._guided.cover())

    def solve(self, model: str, folder: Path, tell: Callable[[str], None]) -> Solved:
        guided = self._guided
        estimate, wished, verdict = guided.solve("equidistant" if model == "equidistant" else "radtan", tell)
        save(guided, estimate, wished, verdict, folder)
        return Solved(verdict=str(verdict), usable=verdict.usable, lines=tuple(figures(estimate)))
