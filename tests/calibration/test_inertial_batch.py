"""Camera and IMU from corners and samples: the truth within its own covariance, poor motion refused by its axis."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from target_scenes import GRID, IMU, Scene, made_up

from robot_agent.calibration.inertial_calibration import InertialEstimate, calibrate_imu
from robot_agent.calibration.target import AprilGrid
from robot_agent.calibration.verdicts import judge_imu
from weaver_shared.errors import InputError
from weaver_shared.transforms import rotation_log


@pytest.fixture(scope="module")
def told() -> list[str]:
    return []


@pytest.fixture(scope="module")
def estimate(scene: Scene, told: list[str]) -> InertialEstimate:
    tell = told.append
    return calibrate_imu(scene.truth.rig, scene.views, GRID, scene.inertia, IMU, knots_per_second=30.0, tell=tell)


def test_every_step_of_the_long_work_is_told(estimate: InertialEstimate, told: list[str]) -> None:
    first, second, *steps, last = told
    assert (first, second, last) == ("places of the pictures", "turn and delay", "how sure it is")
    assert len(steps) > 1
    assert [step.partition(" of at most")[0] for step in steps] == [
        f"all together, step {number}" for number in range(1, len(steps) + 1)
    ]


def test_place_and_delay_come_out_as_they_are(scene: Scene, estimate: InertialEstimate) -> None:
    truth = scene.truth.camera_from_imu.inverse()
    turned = estimate.imu_from_camera.rotation.T @ truth.rotation
    assert np.degrees(np.linalg.norm(rotation_log(turned))) < 0.02
    assert np.linalg.norm(estimate.imu_from_camera.position - truth.position) < 3e-4
    assert abs(estimate.time_offset - scene.truth.time_offset) < 30e-6


def test_errors_are_within_the_covariance(scene: Scene, estimate: InertialEstimate) -> None:
    truth = scene.truth.camera_from_imu.inverse()
    turned = rotation_log(estimate.imu_from_camera.rotation.T @ truth.rotation)
    assert (np.abs(turned) < 4.0 * estimate.rotation_sigma).all()
    assert (np.abs(estimate.imu_from_camera.position - truth.position) < 4.0 * estimate.position_sigma).all()
    assert abs(estimate.time_offset - scene.truth.time_offset) < 4.0 * estimate.time_offset_sigma


def test_biases_and_gravity_are_found(scene: Scene, estimate: InertialEstimate) -> None:
    assert np.abs(estimate.gyro_bias - scene.truth.biases[0]).max() < 5e-4
    assert np.abs(estimate.gravity_in_target - scene.truth.gravity_in_target).max() < 0.02
    assert judge_imu(estimate).usable
    assert estimate.gyro_errors.std() == pytest.approx(1.0, abs=0.15)


def test_a_target_of_another_size_than_its_file_says_is_noticed(scene: Scene) -> None:
    rig = scene.truth.rig
    wrong = AprilGrid(columns=4, rows=4, tag_size=GRID.tag_size * 1.06, spacing=GRID.spacing)
    larger = replace(
        rig, eye_from_first=tuple(replace(place, position=place.position * 1.06) for place in rig.eye_from_first)
    )
    estimate = calibrate_imu(larger, scene.views, wrong, scene.inertia, IMU, knots_per_second=30.0)
    assert estimate.target_scale == pytest.approx(1.0 / 1.06, abs=0.01)
    verdict = judge_imu(estimate)
    assert not verdict.usable
    assert "measure the print" in str(verdict)


def test_turning_about_one_axis_only_is_refused_by_its_name() -> None:
    poor = made_up(np.random.default_rng(4), seconds=4.0, axes=(0.0, 0.0, 1.0, 1.0, 1.0, 1.0))
    along = poor.truth.camera_from_imu.rotation.T @ np.array([0.0, 0.0, 1.0])
    in_camera = replace(
        poor.inertia,
        angular_velocity_in_imu=np.outer(poor.inertia.angular_velocity_in_imu @ along, [0.0, 0.0, 1.0]),
    )
    with pytest.raises(InputError, match="hardly any turning about the IMU's x and y axis"):
        calibrate_imu(poor.truth.rig, poor.views, GRID, in_camera, IMU)


def test_pictures_and_samples_of_different_times_are_refused(scene: Scene) -> None:
    late = replace(scene.inertia, stamp_ns=scene.inertia.stamp_ns + 10**12)
    with pytest.raises(InputError, match="no time in common"):
        calibrate_imu(scene.truth.rig, scene.views, GRID, late, IMU)


def test_a_recording_with_few_samples_is_refused(scene: Scene) -> None:
    few = replace(
        scene.inertia,
        stamp_ns=scene.inertia.stamp_ns[:10],
        angular_velocity_in_imu=scene.inertia.angular_velocity_in_imu[:10],
        specific_force_in_imu=scene.inertia.specific_force_in_imu[:10],
    )
    with pytest.raises(InputError, match="10 IMU samples"):
        calibrate_imu(scene.truth.rig, scene.views, GRID, few, IMU)
