"""Cost of transport is energy over weight and distance, and unknown where nothing was travelled."""

import math

import numpy as np
import pytest

from robot_agent.evaluation.energy import cost_of_transport
from weaver_shared.frames import GRAVITY


def test_constant_power_at_constant_speed_is_power_over_weight_and_speed() -> None:
    seconds, speed, mass = 20.0, 0.15, 10.3
    samples = round(seconds / 0.01)
    cost = cost_of_transport(
        supply_power=np.full(samples, 130.0),
        motor_power=np.full(samples, 60.0),
        dt=0.01,
        distance=speed * seconds,
        mass=mass,
    )
    assert cost.total == pytest.approx(130.0 / (mass * GRAVITY * speed))
    assert cost.motors == pytest.approx(60.0 / (mass * GRAVITY * speed))


def test_standing_still_has_no_cost_of_transport() -> None:
    cost = cost_of_transport(supply_power=np.ones(5), motor_power=np.ones(5), dt=0.01, distance=0.0, mass=10.0)
    assert math.isnan(cost.total)
    assert math.isnan(cost.motors)
