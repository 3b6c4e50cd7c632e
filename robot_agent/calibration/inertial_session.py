"""The guided calibration of cameras and IMU, as the calibrator sees it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from robot_agent.calibration.drawing import drawn
from robot_agent.calibration.guided_inertial import GuidedInertial
from robot_agent.calibration.guided_session import Solved, guided_state
from robot_agent.calibration.inertial_words import inertial_figures
from robot_agent.calibration.kalibr_files import write_camchain, write_imu, write_target
from robot_agent.calibration.report import inertial_sections, write_report
from weaver_shared.messages import CalibrationState, ImuBatch, StereoFrame
from weaver_shared.transforms import Pose


class InertialSession:
    look_every_ns = 60_000_000
    """Motion shows between pictures: four a second are the least, ten and more are good."""

    def __init__(self, guided: GuidedInertial, described: Pose) -> None:
        """`described` is where the robot's description has the left camera in the IMU's frame."""
        self._guided = guided
        self._described = described

    def look(self, frame: StereoFrame) -> None:
        self._guided.look(frame)

    def drawn(self, frame: StereoFrame) -> bytes:
        return drawn(frame, self._guided.sightings)

    def feel(self, samples: ImuBatch) -> None:
        self._guided.feel(samples)

    def filled(self, state: CalibrationState) -> CalibrationState:
        guided = self._guided
        return replace(guided_state(state, guided), seconds=guided.seconds, motions=tuple(guided.motions()))

    def solve(self, model: str, folder: Path, tell: Callable[[str], None]) -> Solved:
        guided = self._guided
        estimate, verdict = guided.solve(tell)
        folder.mkdir(parents=True, exist_ok=True)
        write_target(guided.target, folder / "target.yaml")
        camera_from_imu = estimate.imu_from_camera.inverse()
        write_camchain(guided.lenses, folder / "camchain-imucam.yaml", camera_from_imu, estimate.time_offset)
        write_imu(guided.imu, folder / "imu.yaml")
        write_report("Calibration of cameras and IMU", verdict, inertial_sections(estimate), folder)
        lines = tuple(inertial_figures(estimate, self._described))
        return Solved(verdict=str(verdict), usable=verdict.usable, lines=lines)
