"""Torques that move a leg's links are those of Lagrange: the change of kinetic energy is the work done."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.kinematics import LegModel, leg_frames, link_inertia_torque
from weaver_shared.robots import load_robot

MODEL = LegModel.of_robot(load_robot("weaver"))
angles = st.lists(st.floats(-1.0, 1.0), min_size=5, max_size=5).map(np.array)


def middles(joints):
    origins, axes = np.zeros((6, 3)), np.zeros((5, 3))
    leg_frames(MODEL.dh, MODEL.hips[0], MODEL.hip_axes[0], joints, origins, axes)
    return 0.5 * (origins[:-1] + origins[1:]), origins, axes


@settings(max_examples=20, deadline=None)
@given(angles, angles)
def test_the_torques_are_the_mass_matrix_times_the_acceleration(joints, acceleration):
    step = 1e-6
    moves = np.array(
        [(middles(joints + step * row)[0] - middles(joints - step * row)[0]) / (2.0 * step) for row in np.eye(5)]
    )  # (joint, link, 3)
    mass = np.einsum("ilk,jlk,l->ij", moves, moves, MODEL.link_mass)
    _, origins, axes = middles(joints)
    torque = np.zeros(5)
    link_inertia_torque(origins, axes, MODEL.link_mass, acceleration, torque)
    np.testing.assert_allclose(torque, mass @ acceleration, atol=1e-7)


def test_a_leg_that_does_not_accelerate_needs_none():
    _, origins, axes = middles(np.zeros(5))
    torque = np.ones(5)
    link_inertia_torque(origins, axes, MODEL.link_mass, np.zeros(5), torque)
    assert torque == pytest.approx(np.zeros(5))
