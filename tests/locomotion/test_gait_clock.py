"""The clock is exact, never jumps, and the gaits keep enough feet on the ground."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.locomotion.gait_clock import GaitClock
from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import load_robot

ROBOT = load_robot()
GAITS, gait_of = ROBOT.gait_table, ROBOT.gait


def test_the_frequency_is_exact_over_a_thousand_strides():
    clock = GaitClock(GAITS["tripod"])
    dt, frequency = 0.01, 0.937
    for _ in range(20_000):
        clock.advance(frequency * dt)
    strides = frequency * dt * 20_000
    assert (clock.phase - strides + 0.5) % 1.0 - 0.5 == pytest.approx(0.0, abs=1e-9)


@given(st.lists(st.tuples(st.sampled_from(sorted(GAITS)), st.floats(0.1, 1.5)), min_size=2, max_size=30))
def test_phases_run_forwards_without_jumps_while_gait_and_frequency_change(orders):
    clock = GaitClock(GAITS["tripod"])
    for name, frequency in orders:
        clock.choose(gait_of(name))
        for _ in range(10):
            before = clock.leg_phase
            clock.advance(frequency * 0.01)
            step = (clock.leg_phase - before) % 1.0
            assert (step > 0.5 * frequency * 0.01).all()
            assert (step < 1.5 * frequency * 0.01).all()


@pytest.mark.parametrize(("name", "most"), [("tripod", 3), ("ripple", 2), ("amble", 2), ("wave", 1)])
def test_no_gait_lifts_more_feet_than_its_name_says(name, most):
    gait = gait_of(name)
    phases = (np.linspace(0.0, 1.0, 600, endpoint=False)[:, None] + gait.offsets) % 1.0
    assert (phases < gait.swing - 1e-9).sum(axis=1).max() == most


@pytest.mark.parametrize("name", sorted(GAITS))
def test_every_gait_settles_on_its_own_offsets(name):
    clock = GaitClock(GAITS["tripod"])
    clock.choose(gait_of(name))
    for _ in range(600):
        clock.advance(0.01)
    relative = (clock.leg_phase - clock.leg_phase[0] - gait_of(name).offsets + 0.5) % 1.0 - 0.5
    np.testing.assert_allclose(relative, 0.0, atol=1e-9)
    assert clock.duty == pytest.approx(gait_of(name).duty)


def test_an_unknown_gait_is_answered_with_the_known_ones():
    with pytest.raises(ConfigurationError, match="tripod, ripple, amble, wave"):
        gait_of("gallop")
