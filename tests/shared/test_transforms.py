"""Poses form a group, rotations keep lengths, and every parametrisation returns to where it came from."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from weaver_shared.transforms import (
    Pose,
    rotation_exp,
    rotation_from_rpy,
    rotation_from_wxyz,
    rotation_log,
    rpy_from_rotation,
    skew,
    wrap_angle,
    wxyz_from_rotation,
    yaw_of,
)

coordinates = st.floats(-100.0, 100.0)
vectors = st.tuples(coordinates, coordinates, coordinates).map(np.array)
rotation_vectors = (
    st.tuples(*[st.floats(-math.pi, math.pi)] * 3).map(np.array).filter(lambda v: np.linalg.norm(v) < math.pi - 1e-3)
)


@st.composite
def poses(draw: st.DrawFn) -> Pose:
    return Pose(rotation=rotation_exp(draw(rotation_vectors)), position=draw(vectors))


def assert_same(one: Pose, other: Pose) -> None:
    assert_allclose(one.matrix, other.matrix, atol=1e-9)


@given(a=poses(), b=poses(), c=poses())
def test_poses_form_a_group(a: Pose, b: Pose, c: Pose) -> None:
    assert_same((a @ b) @ c, a @ (b @ c))
    assert_same(a @ Pose.identity(), a)
    assert_same(Pose.identity() @ a, a)
    assert_same(a @ a.inverse(), Pose.identity())
    assert_same(a.inverse() @ a, Pose.identity())


@given(a=poses(), b=poses(), point=vectors)
def test_a_product_acts_as_its_factors_in_turn(a: Pose, b: Pose, point: np.ndarray) -> None:
    assert_allclose((a @ b).transform(point), a.transform(b.transform(point)), atol=1e-8)
    assert_allclose((a @ b).matrix, a.matrix @ b.matrix, atol=1e-9)


@given(a=poses(), points=st.lists(vectors, min_size=2, max_size=5).map(np.array))
def test_a_pose_keeps_distances_and_maps_many_points_as_one_by_one(a: Pose, points: np.ndarray) -> None:
    moved = a.transform(points)
    assert_allclose(
        np.linalg.norm(moved[1:] - moved[:-1], axis=1), np.linalg.norm(points[1:] - points[:-1], axis=1), atol=1e-9
    )
    assert_allclose(moved, [a.transform(point) for point in points], atol=1e-9)


@given(vector=rotation_vectors)
def test_log_undoes_exp(vector: np.ndarray) -> None:
    rotation = rotation_exp(vector)
    assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1.0)
    assert_allclose(rotation_log(rotation), vector, atol=1e-6)


@given(vector=rotation_vectors, scale=st.sampled_from([1e-3, 1e-6, 1e-9, 1e-12, 0.0]))
def test_log_undoes_exp_for_the_smallest_rotations(vector: np.ndarray, scale: float) -> None:
    assert_allclose(rotation_log(rotation_exp(scale * vector)), scale * vector, rtol=1e-6, atol=1e-16)


@given(direction=vectors.filter(lambda v: np.linalg.norm(v) > 1e-3))
def test_a_half_turn_has_a_log_of_length_pi(direction: np.ndarray) -> None:
    axis = direction / np.linalg.norm(direction)
    vector = rotation_log(rotation_exp(math.pi * axis))
    assert np.linalg.norm(vector) == pytest.approx(math.pi)
    assert abs(vector @ axis) == pytest.approx(math.pi, rel=1e-6)


@given(vector=rotation_vectors)
def test_quaternions_and_matrices_are_the_same_rotation(vector: np.ndarray) -> None:
    wxyz = wxyz_from_rotation(rotation_exp(vector))
    assert wxyz[0] >= 0.0
    assert np.linalg.norm(wxyz) == pytest.approx(1.0)
    assert_allclose(rotation_from_wxyz(wxyz), rotation_exp(vector), atol=1e-12)
    assert_allclose(rotation_from_wxyz(-3.0 * wxyz), rotation_exp(vector), atol=1e-12)


def test_a_zero_quaternion_is_no_rotation() -> None:
    with pytest.raises(ValueError, match="length above zero"):
        rotation_from_wxyz([0.0, 0.0, 0.0, 0.0])


@given(roll=st.floats(-3.1, 3.1), pitch=st.floats(-1.5, 1.5), yaw=st.floats(-3.1, 3.1))
def test_roll_pitch_yaw_return(roll: float, pitch: float, yaw: float) -> None:
    rotation = rotation_from_rpy(roll, pitch, yaw)
    assert_allclose(rpy_from_rotation(rotation), [roll, pitch, yaw], atol=1e-9)
    assert yaw_of(rotation) == pytest.approx(yaw, abs=1e-9)


def test_axes_turn_as_rep_103_says() -> None:
    assert_allclose(rotation_from_rpy(0, 0, math.pi / 2) @ [1, 0, 0], [0, 1, 0], atol=1e-15)  # turning left
    assert_allclose(rotation_from_rpy(0, math.pi / 2, 0) @ [1, 0, 0], [0, 0, -1], atol=1e-15)  # nose down
    assert_allclose(rotation_from_rpy(math.pi / 2, 0, 0) @ [0, 1, 0], [0, 0, 1], atol=1e-15)  # left side up


@given(a=vectors, b=vectors)
def test_skew_is_the_cross_product(a: np.ndarray, b: np.ndarray) -> None:
    assert_allclose(skew(a) @ b, np.cross(a, b), atol=1e-9)


@given(angle=st.floats(-50.0, 50.0), turns=st.integers(-3, 3))
def test_wrapping_forgets_whole_turns_only(angle: float, turns: int) -> None:
    wrapped = wrap_angle(angle + 2.0 * math.pi * turns)
    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)


def test_a_half_turn_wraps_to_plus_pi() -> None:
    assert wrap_angle(-math.pi) == math.pi
