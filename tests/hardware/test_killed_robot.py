"""What becomes of a robot whose program is killed while it moves: processes and terminals as on a real one."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from hardware_bodies import PATIENT

from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.wiring import Wiring
from sim_agent.model import sitting_joints
from sim_agent.servo_bus.joints import FirstOrderJoints
from sim_agent.servo_bus.servo import EmulatedServo
from sim_agent.servo_bus.twin import TwinServos, TwinTerminals
from sim_agent.servo_bus.twin_wiring import twin_wiring, wiring_file
from weaver_shared.robots import load_robot

ROBOT = load_robot("weaver")
PROGRAM = Path(__file__).with_name("driving_robot.py")
START_SPEED = 0.5  # rad/s
SETTINGS = PATIENT.model_copy(update={"start_speed": START_SPEED, "start_time": 0.5})
PATIENCE = 60.0  # s, on however busy a computer


class Stage:
    """Emulated servos on terminals; looked at from this side of the bus."""

    def __init__(self, folder: Path) -> None:
        config = twin_wiring(ROBOT, folder, settings=SETTINGS)
        self.wiring_path = folder / "wiring.toml"
        self.wiring_path.write_text(wiring_file(config))
        wiring = Wiring(config, ROBOT)
        start = wiring.shaft(sitting_joints(ROBOT))
        self.servos = TwinServos(wiring, lambda servos: FirstOrderJoints(servos, start=start, most_steps=4))

    def column(self, register: r.Register) -> np.ndarray:
        return np.array([servo.table[register] for servo in self.servos.servos])

    def time_passes(self) -> None:
        """Servos have clocks of their own, also where nobody talks to them."""
        for servo in self.servos.servos:
            servo.elapse(time.monotonic_ns())

    @contextmanager
    def program(self) -> Iterator[tuple[subprocess.Popen[str], str]]:
        """The robot's program, and what it found."""
        process = subprocess.Popen(
            [sys.executable, str(PROGRAM), str(self.wiring_path)], stdout=subprocess.PIPE, text=True
        )
        try:
            assert process.stdout is not None
            yield process, process.stdout.readline().strip()
        finally:
            process.kill()
            process.wait()
            if process.stdout is not None:
                process.stdout.close()


def soon(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.005)


@pytest.fixture
def stage(tmp_path: Path) -> Stage:
    return Stage(tmp_path)


def test_servos_hold_when_the_program_is_killed_and_go_on_softly_with_the_next(stage: Stage) -> None:
    torque_lost, goals = threading.Event(), []
    write = EmulatedServo.write

    def watched(servo: EmulatedServo, address: int, data: bytes) -> object:
        had, before = servo.table[r.TORQUE_ENABLE], servo.table[r.PRESENT_POSITION]
        result = write(servo, address, data)
        if had and not servo.table[r.TORQUE_ENABLE]:
            torque_lost.set()
        goals.append(abs(servo.table[r.GOAL_POSITION] - before))
        return result

    with TwinTerminals(stage.servos, paced=False), pytest.MonkeyPatch.context() as patch:
        patch.setattr(EmulatedServo, "write", watched)
        begun = stage.column(r.PRESENT_POSITION)
        with stage.program() as (process, found):
            assert found == "limp"
            soon(lambda: bool((np.abs(stage.column(r.PRESENT_POSITION) - begun) > 50).all()))
            process.kill()
            process.wait()
        assert not (stage.column(r.BUS_WATCHDOG) == r.WATCHDOG_TRIPPED).any()

        def all_stopped() -> bool:
            stage.time_passes()
            return bool((stage.column(r.BUS_WATCHDOG) == r.WATCHDOG_TRIPPED).all())

        soon(all_stopped)
        held = stage.column(r.PRESENT_POSITION)
        assert (stage.column(r.TORQUE_ENABLE) == 1).all()
        assert (stage.column(r.GOAL_POSITION) == held).all()
        goals.clear()
        with stage.program() as (_, found):
            assert found == "holding"
            # From where they stood, and no faster than a soft start goes.
            soon(lambda: bool((np.abs(stage.column(r.PRESENT_POSITION) - held) > 20).sum() >= 10))
        assert not torque_lost.is_set()
        assert max(goals) < 45  # counts; a jump to where it is wanted would be more
