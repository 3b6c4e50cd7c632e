"""The IMU says what moved it, no more and no less than its data sheet allows."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.body import JointTargets
from sim_agent.body import SimulatedBody
from sim_agent.model import sitting_joints
from sim_agent.sensors import InertialSensor
from sim_agent.sensors.inertial import interval_means
from sim_agent.worlds import make_world
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import rotation_exp, rotation_from_wxyz, rotation_log

vectors = st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array)


@given(vectors, vectors, vectors, vectors)
def test_interval_means_agree_with_logarithm_and_exponential(
    attitude: np.ndarray, turn: np.ndarray, before: np.ndarray, after: np.ndarray
) -> None:
    start, dt = rotation_exp(attitude), 0.005
    end = start @ rotation_exp(turn)
    rate, force = means = np.empty((2, 3))
    interval_means(start, end, before, after, dt, means)
    assert np.allclose(rate * dt, rotation_log(start.T @ end), atol=1e-7)
    halfway = start @ rotation_exp(0.5 * turn)
    expected = halfway.T @ ((after - before) / dt + [0.0, 0.0, GRAVITY])
    assert np.allclose(force, expected, atol=1e-4)


def test_at_rest_it_feels_gravity_alone_within_its_bias(sitting: SimulatedBody) -> None:
    batch = _collect(sitting, 100)
    assert batch.stamp_ns.tolist() == [5_000_000 * (n + 1) for n in range(200)]
    assert batch.specific_force_in_imu.mean(axis=0) == pytest.approx([0.0, 0.0, GRAVITY], abs=0.05)
    assert np.abs(batch.angular_velocity_in_imu.mean(axis=0)).max() < 0.005


def test_noise_has_the_described_density(robot: RobotDescription) -> None:
    sensor = InertialSensor(robot.imu, np.random.default_rng(0))
    sensor.begin(np.eye(3), np.zeros(3))
    for index in range(4000):
        sensor.sample(index, np.eye(3), np.zeros(3))
    batch = sensor.take()
    root = np.sqrt(robot.imu.rate)
    for values, density in (
        (batch.angular_velocity_in_imu, robot.imu.gyro_noise_density),
        (batch.specific_force_in_imu, robot.imu.accel_noise_density),
    ):
        # Differences of neighbours hide the bias, which hardly moves from one to the next.
        white = np.diff(values, axis=0).std() / np.sqrt(2.0)
        assert white == pytest.approx(density * root, rel=0.03)


def test_dead_reckoning_of_ten_lively_seconds_ends_within_millimetres(robot: RobotDescription) -> None:
    silent = {name: 1e-12 for name in type(robot.imu).model_fields if "gyro" in name or "accel" in name}
    quiet_robot = robot.model_copy(update={"imu": robot.imu.model_copy(update=silent)})
    body = SimulatedBody(quiet_robot, make_world("flat", 1), 1)
    start = sitting_joints(robot)
    pose = body.scene_state().world_from_body
    imu_in_body = np.asarray(robot.imu.position_in_body)
    rotation, position, velocity = pose.rotation, pose.transform(imu_in_body), np.zeros(3)
    travelled = 0.0
    for tick in range(1000):
        body.wait_next()
        swing = 0.5 * np.sin(2.0 * np.pi * 1.3 * tick * 0.01) * np.tile([0.3, 0.2, 1.0, 0.0, 0.0], 6)
        body.write(
            JointTargets(
                stamp_ns=0, position=start + swing, torque_limit=np.full(robot.joint_count, 9.0), torque_on=True
            )
        )
        batch = body.read().imu
        for rate, force in zip(batch.angular_velocity_in_imu, batch.specific_force_in_imu, strict=True):
            dt = 1.0 / robot.imu.rate
            halfway = rotation @ rotation_exp(0.5 * rate * dt)
            acceleration = halfway @ force - [0.0, 0.0, GRAVITY]
            position = position + velocity * dt + 0.5 * acceleration * dt**2
            velocity = velocity + acceleration * dt
            rotation = rotation @ rotation_exp(rate * dt)
        travelled = max(travelled, abs(body.truth().position_in_world[2]))
    truth = body.truth()
    really = rotation_from_wxyz(truth.wxyz) @ imu_in_body + truth.position_in_world
    body.close()
    assert travelled > 0.02  # it did hop
    assert np.linalg.norm(position - really) < 0.005
    assert np.linalg.norm(rotation_log(rotation.T @ rotation_from_wxyz(truth.wxyz))) < 1e-4


def _collect(body: SimulatedBody, ticks: int) -> ImuBatch:
    batches = []
    for _ in range(ticks):
        body.wait_next()
        batches.append(body.read().imu)
    return ImuBatch.join(batches)
