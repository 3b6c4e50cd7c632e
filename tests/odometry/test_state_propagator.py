"""Between pictures the state follows inertia; corrections arrive late and without a jump."""

from dataclasses import replace

import numpy as np
import pytest
from walking_motion import FRAME_NS, Walk, inertia

from robot_agent.odometry import StatePropagator
from weaver_shared.messages import ImuBatch, OdometryEstimate, OdometryQuality
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose, rotation_from_rpy, wxyz_from_rotation

TICK_NS = 10_000_000
WALK = Walk(sway=2.0)


def _estimate(stamp_ns: int, offset: float = 0.0) -> OdometryEstimate:
    t = stamp_ns * 1e-9
    pose = WALK.body(t)
    return OdometryEstimate(
        stamp_ns=stamp_ns,
        position_in_world=pose.position + np.array([offset, 0.0, 0.0]),
        wxyz=wxyz_from_rotation(pose.rotation),
        velocity_in_world=WALK.velocity(t, Pose.identity()),
        angular_velocity_in_body=_rate(t),
        gyro_bias=np.zeros(3),
        accel_bias=np.zeros(3),
        covariance=np.eye(6),
        quality=OdometryQuality.GOOD,
        reason="",
        tracked_features=100,
    )


def _rate(t: float) -> np.ndarray:
    h = 1e-5
    turn = WALK.body(t - h).rotation.T @ WALK.body(t + h).rotation
    return np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / (4.0 * h)


def test_late_corrections_keep_it_on_the_walk(robot: RobotDescription) -> None:
    propagator = StatePropagator(robot.imu, WALK.body(0.0))
    for k in range(1, 401):
        stamp = k * TICK_NS
        state = propagator.propagate(inertia(WALK, robot, stamp - TICK_NS, stamp))
        if k % 5 == 0 and k > 10:
            propagator.correct(_estimate(stamp - 2 * FRAME_NS))
        if k > 20:
            truth = WALK.body(stamp * 1e-9)
            assert state.world_from_body.position == pytest.approx(truth.position, abs=0.003)
            assert state.world_from_body.rotation == pytest.approx(truth.rotation, abs=0.003)
            assert state.gravity_in_body == pytest.approx(-truth.rotation[2], abs=0.003)
            assert state.velocity_in_world == pytest.approx(WALK.velocity(stamp * 1e-9, Pose.identity()), abs=0.05)
            assert state.age <= 0.15 + 1e-9


def test_a_jump_of_the_odometry_is_spread_over_time(robot: RobotDescription) -> None:
    propagator = StatePropagator(robot.imu, WALK.body(0.0))
    positions = []
    for k in range(1, 200):
        stamp = k * TICK_NS
        state = propagator.propagate(inertia(WALK, robot, stamp - TICK_NS, stamp))
        positions.append(state.world_from_body.position[0] - WALK.body(stamp * 1e-9).position[0])
        if k % 5 == 0:
            propagator.correct(_estimate(stamp, offset=0.05 if k >= 100 else 0.0))
    assert np.abs(np.diff(positions)).max() < 0.006
    assert positions[-1] == pytest.approx(0.05, abs=0.003)


def test_attitude_works_from_inertia_alone(robot: RobotDescription) -> None:
    propagator = StatePropagator(robot.imu, Pose.identity())
    tilted = rotation_from_rpy(0.2, -0.1, 0.0)
    still = inertia(Walk(speed=0.0, sway=0.0), robot, 0, 3_000_000_000)
    turned = replace(
        still,
        specific_force_in_imu=still.specific_force_in_imu @ tilted,
        angular_velocity_in_imu=still.angular_velocity_in_imu + np.array([0.002, -0.002, 0.0]),
    )
    state = propagator.propagate(turned)
    assert state.gravity_in_body == pytest.approx(-tilted[2], abs=0.01)
    assert state.age == float("inf")
    assert np.linalg.norm(state.world_from_body.position) < 0.01


def test_without_corrections_the_robot_does_not_fly_away(robot: RobotDescription) -> None:
    propagator = StatePropagator(robot.imu, WALK.body(0.0))
    bias = np.array([0.3, 0.0, 0.0])
    propagator.propagate(inertia(WALK, robot, 0, 2_000_000_000))
    propagator.correct(_estimate(2_000_000_000))
    state = propagator.propagate(inertia(Walk(0.0, 0.0), robot, 2_000_000_000, 6_000_000_000, accel_bias=bias))
    assert np.linalg.norm(state.world_from_body.position - WALK.body(2.0).position) < 0.4
    assert np.linalg.norm(state.velocity_in_world) < 0.01
    assert state.age == pytest.approx(4.0)


def test_nonsense_samples_are_left_out(robot: RobotDescription) -> None:
    propagator = StatePropagator(robot.imu, Pose.identity())
    batch = inertia(Walk(0.0, 0.0), robot, 0, 500_000_000)
    force = batch.specific_force_in_imu.copy()
    force[20:30] = np.nan
    state = propagator.propagate(replace(batch, specific_force_in_imu=force))
    assert state.gravity_in_body == pytest.approx([0.0, 0.0, -1.0], abs=1e-3)
    assert propagator.propagate(ImuBatch.empty()).stamp_ns == state.stamp_ns
