"""Trajectory errors are what a ruler would say, whatever the frames the trajectories are given in."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.evaluation.trajectory import Trajectory, align, evaluate, path_length, read_tum, write_tum
from weaver_shared.errors import InputError
from weaver_shared.transforms import Pose, rotation_from_rpy, rotation_z


def _arc(count: int = 60) -> Trajectory:
    poses = [
        Pose(rotation=rotation_from_rpy(0.02, 0.05, 0.03 * n), position=np.array([0.1 * n, 0.002 * n * n, 0.01 * n]))
        for n in range(count)
    ]
    return Trajectory.of([1_403_715_273_262_142_976 + 50_000_000 * n for n in range(count)], poses)


def _moved(trajectory: Trajectory, pose: Pose) -> Trajectory:
    poses = [
        pose @ Pose(rotation=trajectory.rotation(n), position=trajectory.position[n]) for n in range(len(trajectory))
    ]
    return Trajectory.of([int(s) for s in trajectory.stamp_ns], poses)


@given(st.floats(-3.0, 3.0), st.floats(-5.0, 5.0), st.floats(-5.0, 5.0))
@settings(max_examples=15, deadline=None)
def test_heading_and_place_of_the_world_do_not_count(yaw: float, x: float, y: float) -> None:
    errors = evaluate(_moved(_arc(), Pose(rotation=rotation_z(yaw), position=np.array([x, y, 0.4]))), _arc())
    assert errors.ate_m == pytest.approx(0.0, abs=1e-6)
    assert errors.final_error == pytest.approx(0.0, abs=1e-6)
    assert errors.gravity_error_deg == pytest.approx(0.0, abs=1e-4)


def test_a_wrong_scale_is_a_drift_of_as_many_percent() -> None:
    straight = Trajectory.of(
        [50_000_000 * n for n in range(101)],
        [Pose.of([0.2 * n, 0.0, 0.0]) for n in range(101)],
    )
    long = Trajectory(stamp_ns=straight.stamp_ns, position=1.03 * straight.position, wxyz=straight.wxyz)
    errors = evaluate(long, straight)
    assert errors.path_length == pytest.approx(20.0)
    assert errors.final_error == pytest.approx(0.6)
    assert errors.drift_percent == pytest.approx(3.0)


def test_a_tilt_is_seen_against_gravity() -> None:
    tilted = _moved(_arc(), Pose(rotation=rotation_from_rpy(0.0, np.radians(2.0), 0.0), position=np.zeros(3)))
    assert evaluate(tilted, _arc()).gravity_error_deg == pytest.approx(2.0, abs=1e-6)


def test_free_alignment_undoes_any_turn() -> None:
    points = np.random.default_rng(0).normal(0.0, 1.0, (20, 3))
    pose = Pose(rotation=rotation_from_rpy(0.4, -0.7, 2.0), position=np.array([1.0, -2.0, 0.5]))
    assert align(points, pose.transform(points), "se3").matrix == pytest.approx(pose.matrix)


def test_the_noise_of_a_robot_at_rest_is_no_path() -> None:
    assert path_length(np.random.default_rng(0).normal(0.0, 0.002, (500, 3))) == 0.0


def test_standing_has_no_drift_in_percent() -> None:
    still = Trajectory.of([0, 50_000_000, 100_000_000], [Pose.identity()] * 3)
    assert np.isnan(evaluate(still, still).drift_percent)


def test_tum_files_keep_every_digit(tmp_path: Path) -> None:
    write_tum(tmp_path / "a.txt", _arc())
    again = read_tum(tmp_path / "a.txt")
    assert (again.stamp_ns == _arc().stamp_ns).all()
    assert again.position == pytest.approx(_arc().position, abs=1e-6)
    assert again.wxyz == pytest.approx(_arc().wxyz, abs=1e-6)


@pytest.mark.parametrize("text", ["", "1 2 3\n", "0 0 0 0 0 0 0 one\n"])
def test_other_files_are_refused_with_the_format(tmp_path: Path, text: str) -> None:
    (tmp_path / "b.txt").write_text(text)
    with pytest.raises(InputError, match="TUM format"):
        read_tum(tmp_path / "b.txt")


def test_truth_that_covers_nothing_is_refused() -> None:
    early = Trajectory.of([0, 50_000_000], [Pose.identity(), Pose.of([1.0, 0.0, 0.0])])
    with pytest.raises(InputError, match="covers 0 of 60"):
        evaluate(_arc(), early)
