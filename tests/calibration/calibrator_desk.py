"""A calibrator on a bus of its own, and what it says there."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

from robot_agent.calibration_process import CalibrationProcess
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.messages import Answer, CalibrationState, CameraPicture, Command, CommandName


@dataclass(kw_only=True)
class Desk:
    bus: MemoryBus
    process: CalibrationProcess
    workers: ThreadPoolExecutor
    told: list[CalibrationState] = field(default_factory=list)
    pictures: list[CameraPicture] = field(default_factory=list)

    def order(self, name: CommandName, text: str = "") -> Answer:
        command = Command(command=name, operator="anna", lease_epoch=0, sequence=1, name=text)
        asked = self.workers.submit(self.bus.ask, "sim-1", topics.CALIBRATOR_COMMANDS, command)
        while not asked.done():
            self.process.turn()
        return asked.result()

    def await_start(self) -> None:
        while self.told[-1].phase == "starting":
            self.process.turn(0.01)

    def await_end_of_recording(self) -> None:
        while "all of the recording was looked at" not in self.told[-1].advice:
            self.process.turn(0.01)

    def await_solution(self) -> CalibrationState:
        while self.told[-1].phase == "solving":
            self.process.turn(0.05)
        return self.told[-1]
