"""A small made-up rig before a target: corners without pictures, and pictures where a test looks at them."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from calibrator_desk import Desk
from own_recordings import SIZE, small_eyed, write_asl, write_own
from target_scenes import GRID, IMU, Scene, made_up

from robot_agent.calibration.kalibr_files import write_camchain, write_imu, write_target
from robot_agent.calibration.target import AprilGrid
from robot_agent.calibration_process import CalibrationProcess
from sim_agent.targets.motion import HandHeldMotion
from sim_agent.targets.recording import RigTruth, TargetRecording, draw_rig
from weaver_shared import topics
from weaver_shared.bus import MemoryBus


@pytest.fixture(scope="session")
def grid() -> AprilGrid:
    return GRID


@pytest.fixture(scope="session")
def scene() -> Scene:
    """10 s of motion, corners to 0.05 px at 20 Hz, IMU at 200 Hz."""
    return made_up(np.random.default_rng(3), seconds=10.0)


@pytest.fixture(scope="session")
def truth() -> RigTruth:
    return draw_rig(np.random.default_rng(11), "radtan", SIZE)


@pytest.fixture(scope="session")
def recording(truth: RigTruth, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """6 s of rendered pairs at 8 Hz as an ASL folder, with the target's, the IMU's and the true cameras' files."""
    folder = tmp_path_factory.mktemp("recording")
    generator = np.random.default_rng(11)
    motion = HandHeldMotion(GRID, 0.55, generator)
    write_asl(folder, TargetRecording(truth, GRID, motion, IMU, generator, seconds=6.0, rate=8.0))
    write_target(GRID, folder / "target.yaml")
    write_imu(IMU, folder / "imu.yaml")
    write_camchain(truth.rig, folder / "truth.yaml")
    return folder


@pytest.fixture(scope="session")
def own_recording(recording: Path) -> Path:
    """The same as a robot's own recording."""
    return write_own(recording, recording / "own.mcap")


@pytest.fixture
def desk(own_recording: Path, tmp_path: Path) -> Iterator[Desk]:
    bus = MemoryBus()
    process = CalibrationProcess(
        robot_id="sim-1",
        robot=small_eyed(),
        bus=bus,
        open_bus=MemoryBus,
        recordings=own_recording.parent,
        folder=tmp_path,
        wall_time=lambda: datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC),
    )
    with ThreadPoolExecutor(1) as workers:
        made = Desk(bus=bus, process=process, workers=workers)
        bus.subscribe("sim-1", topics.CALIBRATION, lambda _id, _key, state: made.told.append(state))
        bus.subscribe("sim-1", topics.CAMERA, lambda _id, _key, picture: made.pictures.append(picture))
        yield made
        process.close()
