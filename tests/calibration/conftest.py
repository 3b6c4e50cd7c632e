"""A small made-up rig before a target: corners without pictures, and pictures where a test looks at them."""

from __future__ import annotations

import numpy as np
import pytest
from target_scenes import GRID, Scene, made_up

from robot_agent.calibration.target import AprilGrid


@pytest.fixture(scope="session")
def grid() -> AprilGrid:
    return GRID


@pytest.fixture(scope="session")
def scene() -> Scene:
    """10 s of motion, corners to 0.05 px at 20 Hz, IMU at 200 Hz."""
    return made_up(np.random.default_rng(3), seconds=10.0)
