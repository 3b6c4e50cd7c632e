"""A foot gives way by force over stiffness, along one axis, at any control rate alike (ICRA'17 eq. 6)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.admittance import step_admittance, transition
from robot_agent.locomotion.impedance import damping_of, give_way
from robot_agent.locomotion.walk_state import WalkState, write
from weaver_shared.config.locomotion import AdmittanceConfig, LocomotionConfig


def respond(mass, damping, stiffness, force, *, rate, seconds):
    step, state = np.zeros((2, 3)), np.zeros((1, 2))
    transition(mass, damping, stiffness, 1.0 / rate, step)
    for _ in range(round(seconds * rate)):
        step_admittance(state, np.array([force]), step, 1e9, 10.0)
    return state[0]


@given(st.floats(0.5, 10.0), st.floats(1.0, 800.0), st.floats(100.0, 5000.0), st.floats(0.001, 0.05))
def test_the_step_is_the_matrix_exponential(mass, damping, stiffness, dt):
    step = np.zeros((2, 3))
    transition(mass, damping, stiffness, dt, step)
    system = np.zeros((3, 3))
    system[0, 1] = 1.0
    system[1] = [-stiffness / mass, -damping / mass, 1.0 / mass]
    np.testing.assert_allclose(step, expm(system * dt)[:2], rtol=1e-7, atol=1e-10)


@pytest.mark.parametrize("stiffness", [400.0, 1000.0, 2500.0])
@pytest.mark.parametrize("force", [-20.0, 33.7])
def test_the_offset_settles_at_force_over_stiffness(stiffness, force):
    damping = damping_of(2.0, 1.0, stiffness, 260.0)
    offset, speed = respond(2.0, damping, stiffness, force, rate=100, seconds=8.0)
    assert offset == pytest.approx(force / stiffness, rel=0.01)
    assert speed == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("damping", [20.0, 89.4427191, 400.0])
def test_the_response_is_the_same_at_50_100_and_200_hz(damping):
    responses = [respond(2.0, damping, 1000.0, 30.0, rate=rate, seconds=0.1) for rate in (50, 100, 200)]
    np.testing.assert_allclose(responses[0], responses[1], rtol=1e-9)
    np.testing.assert_allclose(responses[0], responses[2], rtol=1e-9)


@kernel
def give_way_once(memory):
    give_way(memory[0])


class Impedance:
    """The legs' impedance alone, every foot standing, in a walker's memory."""

    def __init__(self, legs, dt=0.01):
        self.state = WalkState(legs, 5)
        write(self.state.record["settings"], LocomotionConfig())
        self.state.record["model"]["legs"], self.state.record["model"]["dt"] = legs, dt
        self.offset = self.state.cut("load", "offset")

    def step(self, surplus, stiffness):
        self.state.record["gait"]["stiffness"] = stiffness
        self.state.cut("senses", "force")[:] = surplus
        give_way_once(self.state.memory)


def test_a_leg_does_not_feel_its_neighbours_force():
    impedance = Impedance(6)
    for _ in range(100):
        impedance.step(np.array([30.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 1000.0)
    assert impedance.offset[0, 0] > 0.01
    assert not impedance.offset[1:].any()


def test_an_offset_at_its_bound_leaves_it_as_soon_as_the_force_turns():
    largest, impedance = AdmittanceConfig().largest_offset, Impedance(1)
    for _ in range(500):
        impedance.step(np.array([1e6]), 400.0)
    assert impedance.offset[0, 0] == largest
    impedance.step(np.array([-20.0]), 400.0)
    assert impedance.offset[0, 0] < largest
