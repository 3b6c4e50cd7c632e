"""Hot servos get less torque, and never so little that a standing robot falls."""

from __future__ import annotations

import numpy as np

from robot_agent.hardware.derating import BEGINS, ENDS, LEAST, derated


def test_torque_falls_evenly_between_warm_and_hot():
    temperature = np.array([20.0, BEGINS, (BEGINS + ENDS) / 2, ENDS, 95.0, np.nan])
    shares = [1.0, 1.0, (1.0 + LEAST) / 2, LEAST, LEAST, 1.0]
    np.testing.assert_allclose(derated(np.full(6, 4.0), temperature), 4.0 * np.array(shares))
