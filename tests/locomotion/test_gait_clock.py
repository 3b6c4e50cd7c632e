"""The clock is exact, never jumps, and the gaits keep enough feet on the ground."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.gait_clock import advance_clock, restart_clock
from robot_agent.locomotion.walk_state import WalkState
from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import load_robot

ROBOT = load_robot()
GAITS, gait_of = ROBOT.gait_table, ROBOT.gait


@kernel
def restart(memory, phase):
    restart_clock(memory[0], phase)


@kernel
def advance(memory, strides):
    advance_clock(memory[0], strides)


class Clock:
    """The clock alone, in a walker's memory."""

    def __init__(self, gait):
        self.state = WalkState(6, 5)
        self.state.record["model"]["legs"] = 6
        self.choose(gait)
        restart(self.state.memory, 0.0)

    def choose(self, gait):
        self.state.record["orders"]["duty"] = gait.duty
        self.state.cut("orders", "offset")[:] = gait.offsets

    def advance(self, strides):
        advance(self.state.memory, strides)

    @property
    def phase(self):
        return self.state.record["gait"]["phase"]

    @property
    def duty(self):
        return self.state.record["gait"]["duty"]

    @property
    def leg_phase(self):
        return self.state.cut("gait", "leg_phase").copy()


def test_the_frequency_is_exact_over_a_thousand_strides():
    clock = Clock(GAITS["tripod"])
    dt, frequency = 0.01, 0.937
    for _ in range(20_000):
        clock.advance(frequency * dt)
    strides = frequency * dt * 20_000
    assert (clock.phase - strides + 0.5) % 1.0 - 0.5 == pytest.approx(0.0, abs=1e-9)


@given(st.lists(st.tuples(st.sampled_from(sorted(GAITS)), st.floats(0.1, 1.5)), min_size=2, max_size=30))
def test_phases_run_forwards_without_jumps_while_gait_and_frequency_change(orders):
    clock = Clock(GAITS["tripod"])
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
    clock = Clock(GAITS["tripod"])
    clock.choose(gait_of(name))
    for _ in range(600):
        clock.advance(0.01)
    relative = (clock.leg_phase - clock.leg_phase[0] - gait_of(name).offsets + 0.5) % 1.0 - 0.5
    np.testing.assert_allclose(relative, 0.0, atol=1e-9)
    assert clock.duty == pytest.approx(gait_of(name).duty)


def test_an_unknown_gait_is_answered_with_the_known_ones():
    with pytest.raises(ConfigurationError, match="tripod, ripple, amble, wave"):
        gait_of("gallop")
