"""Leg kinematics agree with the readable form, with finite differences and with themselves backwards."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.kinematics import (
    LegModel,
    all_leg_frames,
    foot_force,
    foot_jacobian,
    leg_frames,
    limit_joint_speed,
    link_gravity_torque,
    solve_leg,
)
from robot_agent.kinematics.damped import ITERATIONS, solve_damped
from robot_agent.kinematics.leg_model import is_yaw_roll_pitch
from weaver_shared.robots import load_robot, robot_names
from weaver_shared.robots.forward_kinematics import joint_frames_in_body

ROBOT = load_robot("weaver")
MODEL = LegModel.of_robot(ROBOT)
LEGS = st.integers(0, 5)
FRACTIONS = st.lists(st.floats(0.1, 0.9), min_size=5, max_size=5)
DOWN = np.array([0.0, 0.0, -1.0])


def angles_at(fractions):
    return MODEL.limits[:, 0] + np.array(fractions) * (MODEL.limits[:, 1] - MODEL.limits[:, 0])


def frames(leg, angles):
    origins, axes = np.zeros((6, 3)), np.zeros((5, 3))
    leg_frames(MODEL.dh, MODEL.hips[leg], MODEL.hip_axes[leg], np.asarray(angles, dtype=float), origins, axes)
    return origins, axes


def test_the_shipped_leg_has_a_closed_form():
    assert is_yaw_roll_pitch(ROBOT.dh)
    changed = ROBOT.dh.copy()
    changed[1, 2] = 0.01
    assert not is_yaw_roll_pitch(changed)


@given(st.lists(st.floats(-2.0, 2.0), min_size=30, max_size=30))
def test_the_kernel_agrees_with_the_shared_forward_kinematics(angles):
    origins, axes = np.zeros((6, 6, 3)), np.zeros((6, 5, 3))
    all_leg_frames(MODEL.dh, MODEL.hips, MODEL.hip_axes, np.array(angles).reshape(6, 5), origins, axes)
    reference = joint_frames_in_body(ROBOT, np.array(angles))
    np.testing.assert_allclose(origins, reference[:, :, :3, 3], atol=1e-12)
    np.testing.assert_allclose(axes, reference[:, :-1, :3, 2], atol=1e-12)


@pytest.mark.parametrize("name", robot_names())
def test_the_kernel_agrees_for_legs_of_any_attitude_and_side(name):
    robot = load_robot(name)
    model = LegModel.of_robot(robot)
    legs, n = model.leg_count, model.joints_per_leg
    angles = np.random.default_rng(0).uniform(model.limits[:, 0], model.limits[:, 1], (legs, n))
    origins, axes = np.zeros((legs, n + 1, 3)), np.zeros((legs, n, 3))
    all_leg_frames(model.dh, model.hips, model.hip_axes, angles, origins, axes)
    reference = joint_frames_in_body(robot, angles)
    np.testing.assert_allclose(origins, reference[:, :, :3, 3], atol=1e-12)
    np.testing.assert_allclose(axes, reference[:, :-1, :3, 2] * robot.sides[:, None, None], atol=1e-12)


@pytest.mark.parametrize("name", robot_names())
def test_every_leg_follows_its_foot_about_its_stance(name):
    """From the standing posture, a little at a time, to a third of the largest stride in every direction."""
    robot = load_robot(name)
    model = LegModel.of_robot(robot)
    for leg in range(model.leg_count):
        joints = model.standing.copy()
        for bearing in np.linspace(0.0, 2.0 * np.pi, 12):
            way = robot.locomotion.largest_stride / 3.0 * np.array([np.cos(bearing), np.sin(bearing), 0.0])
            foot, found = robot.stance_in_body[leg] + way, np.zeros(model.joints_per_leg)
            left = solve_leg(
                model.dh, model.limits, model.closed_form, model.hips[leg], model.hip_axes[leg], foot, DOWN, joints,
                found,
            )  # fmt: skip
            assert left < 1e-4 * model.reach
            joints = found


@given(LEGS, FRACTIONS)
def test_the_jacobian_is_the_derivative_of_the_foot(leg, fractions):
    angles = angles_at(fractions)
    origins, axes = frames(leg, angles)
    jacobian = np.zeros((3, 5))
    foot_jacobian(origins, axes, jacobian)
    for joint in range(5):
        step = np.zeros(5)
        step[joint] = 1e-6
        difference = (frames(leg, angles + step)[0][-1] - frames(leg, angles - step)[0][-1]) / 2e-6
        np.testing.assert_allclose(jacobian[:, joint], difference, atol=1e-8)


def in_reach(angles):
    """Whether a leg stands well away from where its plane or its knee is not defined."""
    return abs(angles[3]) > 0.1 and angles[3] > 0.0


@settings(max_examples=200)
@given(LEGS, FRACTIONS)
def test_inverse_after_forward_is_the_identity_on_feet(leg, fractions):
    angles = angles_at(fractions)
    if not in_reach(angles):
        return
    origins, _ = frames(leg, angles)
    direction = (origins[5] - origins[4]) / ROBOT.dh[4, 2]
    solution = np.zeros(5)
    left = solve_leg(
        MODEL.dh, MODEL.limits, MODEL.closed_form, MODEL.hips[leg], MODEL.hip_axes[leg], origins[5].copy(), direction,
        angles + 0.05, solution,
    )  # fmt: skip
    reached, _ = frames(leg, solution)
    assert left < 1e-5
    np.testing.assert_allclose(reached[5], origins[5], atol=1e-5)
    assert (solution >= MODEL.limits[:, 0] - 1e-12).all()
    assert (solution <= MODEL.limits[:, 1] + 1e-12).all()


@given(LEGS, st.floats(-0.08, 0.08), st.floats(-0.08, 0.08), st.floats(-0.04, 0.05), st.floats(-0.2, 0.2))
def test_near_the_stance_the_last_link_points_where_it_should(leg, dx, dy, dz, tilt):
    foot = ROBOT.stance_in_body[leg] + np.array([dx, dy, dz])
    direction = np.array([np.sin(tilt), 0.0, -np.cos(tilt)])
    solution = np.zeros(5)
    solve_leg(
        MODEL.dh,
        MODEL.limits,
        MODEL.closed_form,
        MODEL.hips[leg],
        MODEL.hip_axes[leg],
        foot,
        direction,
        np.zeros(5),
        solution,
    )
    origins, _ = frames(leg, solution)
    np.testing.assert_allclose(origins[5], foot, atol=1e-9)
    # Where the leg can not have the direction, it tilts only inside the plane of hip, foot and direction.
    normal = np.cross(foot - MODEL.hips[leg], direction)
    link = (origins[5] - origins[4]) / ROBOT.dh[4, 2]
    assert abs(link @ normal) / np.linalg.norm(normal) < 1e-9


def test_standing_feet_carry_a_vertical_last_link():
    for leg in range(6):
        solution = np.zeros(5)
        foot = ROBOT.stance_in_body[leg]
        solve_leg(
            MODEL.dh,
            MODEL.limits,
            MODEL.closed_form,
            MODEL.hips[leg],
            MODEL.hip_axes[leg],
            foot,
            DOWN,
            np.zeros(5),
            solution,
        )
        origins, _ = frames(leg, solution)
        np.testing.assert_allclose((origins[5] - origins[4]) / ROBOT.dh[4, 2], DOWN, atol=1e-9)


@settings(max_examples=50)
@given(LEGS, FRACTIONS)
def test_damped_least_squares_finds_the_same_feet_without_the_closed_form(leg, fractions):
    angles = angles_at(fractions)
    if not in_reach(angles):
        return
    origins, _ = frames(leg, angles)
    direction = (origins[5] - origins[4]) / ROBOT.dh[4, 2]
    solution = np.clip(angles + 0.05, MODEL.limits[:, 0], MODEL.limits[:, 1])
    left = solve_damped(
        MODEL.dh,
        MODEL.limits,
        MODEL.hips[leg],
        MODEL.hip_axes[leg],
        origins[5].copy(),
        direction,
        1e-6,
        ITERATIONS,
        solution,
    )
    assert left < 1e-4
    np.testing.assert_allclose(frames(leg, solution)[0][5], origins[5], atol=1e-4)


@given(LEGS, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_a_foot_out_of_reach_keeps_the_limits_and_comes_as_near_as_it_says(leg, x, y, z):
    foot = np.array([x, y, z])
    solution = np.zeros(5)
    left = solve_leg(
        MODEL.dh,
        MODEL.limits,
        MODEL.closed_form,
        MODEL.hips[leg],
        MODEL.hip_axes[leg],
        foot,
        DOWN,
        np.zeros(5),
        solution,
    )
    assert (solution >= MODEL.limits[:, 0] - 1e-12).all()
    assert (solution <= MODEL.limits[:, 1] + 1e-12).all()
    assert np.linalg.norm(frames(leg, solution)[0][5] - foot) == pytest.approx(left, abs=1e-6)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_foot_that_is_no_place_leaves_the_joints_where_they_were(bad):
    previous, solution = np.full(5, 0.1), np.zeros(5)
    foot = np.array([0.3, bad, -0.1])
    left = solve_leg(
        MODEL.dh, MODEL.limits, MODEL.closed_form, MODEL.hips[0], MODEL.hip_axes[0], foot, DOWN, previous, solution
    )
    assert left == np.inf
    np.testing.assert_array_equal(solution, previous)


@given(LEGS, FRACTIONS, st.lists(st.floats(-50.0, 50.0), min_size=3, max_size=3))
def test_torques_in_balance_with_a_ground_force_give_that_force_back(leg, fractions, ground_force):
    angles = np.tile(angles_at(fractions), (6, 1))
    if not in_reach(angles[0]):
        return
    origins, axes = np.zeros((6, 6, 3)), np.zeros((6, 5, 3))
    all_leg_frames(MODEL.dh, MODEL.hips, MODEL.hip_axes, angles, origins, axes)
    jacobian, own = np.zeros((3, 5)), np.zeros(5)
    foot_jacobian(origins[leg], axes[leg], jacobian)
    if np.linalg.svd(jacobian, compute_uv=False)[-1] < 0.05:
        return
    link_gravity_torque(origins[leg], axes[leg], MODEL.link_mass, DOWN, own)
    torque, force = own - jacobian.T @ np.array(ground_force), np.zeros(3)
    foot_force(jacobian, torque, own, force)
    np.testing.assert_allclose(force, ground_force, atol=0.06 * np.linalg.norm(ground_force) + 1e-6)


def test_own_weight_needs_the_torque_of_potential_energy():
    angles = angles_at([0.5, 0.6, 0.4, 0.5, 0.5])

    def energy(q):
        origins, _ = frames(1, q)
        middle = 0.5 * (origins[:-1, 2] + origins[1:, 2])
        return float(MODEL.link_mass @ middle) * 9.80665

    own = np.zeros(5)
    origins, axes = frames(1, angles)
    link_gravity_torque(origins, axes, MODEL.link_mass, DOWN, own)
    for joint in range(5):
        step = np.eye(5)[joint] * 1e-6
        assert own[joint] == pytest.approx((energy(angles + step) - energy(angles - step)) / 2e-6, abs=1e-6)


@given(st.lists(st.floats(-0.5, 0.5), min_size=10, max_size=10))
def test_the_speed_limit_shortens_a_leg_without_bending_its_path(steps):
    previous, limit = np.zeros((2, 5)), np.full(5, 5.0)
    wanted = np.array(steps).reshape(2, 5)
    limited = wanted.copy()
    limit_joint_speed(previous, limited, limit, np.array([True, False]), 0.01)
    for leg in range(2):
        assert np.abs(limited[leg]).max() <= 0.05 + 1e-12
        cross = np.linalg.norm(limited[leg]) * np.linalg.norm(wanted[leg])
        assert limited[leg] @ wanted[leg] == pytest.approx(cross, abs=1e-12)


def test_legs_on_the_ground_slow_down_together():
    previous = np.zeros((3, 2))
    wanted = np.array([[0.1, 0.0], [0.02, 0.0], [0.0, 0.02]])
    factor = limit_joint_speed(previous, wanted, np.array([5.0, 5.0]), np.array([True, True, False]), 0.01)
    assert factor == pytest.approx(0.5)
    np.testing.assert_allclose(wanted, [[0.05, 0.0], [0.01, 0.0], [0.0, 0.02]])
