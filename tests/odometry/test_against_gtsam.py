"""GTSAM as a second opinion: its preintegration and its fixed-lag smoother on the same measurements."""

import gtsam
import numpy as np
import pytest
from gtsam.symbol_shorthand import B, L, V, X
from walking_motion import FRAME_NS, Ground, Walk, as_samples, begin_window, inertia

from robot_agent.odometry.landmarks import LEFT, RIGHT, Eyes
from robot_agent.odometry.preintegration import Preintegrations, begin, integrate
from robot_agent.odometry.start import begin_at_rest
from robot_agent.odometry.window import SlidingWindow
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import OdometryConfig, StartConfig
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose, rotation_log

FIRST, LAST = 10, 80  # frames of the walk
LAG = 0.6  # s
PIXEL = 0.5  # px, 1 sigma, as the window has it
BEGIN, END = 3_000_000_000, 3_500_000_000


def preintegration_of(imu: Imu) -> gtsam.PreintegrationCombinedParams:
    params = gtsam.PreintegrationCombinedParams.MakeSharedU(GRAVITY)
    params.setGyroscopeCovariance(imu.gyro_noise_density**2 * np.eye(3))
    params.setAccelerometerCovariance(imu.accel_noise_density**2 * np.eye(3))
    params.setIntegrationCovariance(1e-10 * np.eye(3))
    params.setBiasOmegaCovariance(imu.gyro_random_walk**2 * np.eye(3))
    params.setBiasAccCovariance(imu.accel_random_walk**2 * np.eye(3))
    return params


def integrated(params: gtsam.PreintegrationCombinedParams, bias: gtsam.imuBias.ConstantBias, samples: np.ndarray):
    pim = gtsam.PreintegratedCombinedMeasurements(params, bias)
    for dt, *motion in samples:
        pim.integrateMeasurement(np.array(motion[3:]), np.array(motion[:3]), dt)
    return pim


def test_preintegration_is_gtsams(robot: RobotDescription) -> None:
    samples = as_samples(inertia(Walk(sway=2.0), robot, BEGIN, END))
    ours, imu = Preintegrations.of(2), robot.imu
    begin(ours, 1, np.zeros(3), np.zeros(3))
    integrate(ours, 1, samples, imu.gyro_noise_density, imu.accel_noise_density)
    theirs = integrated(preintegration_of(imu), gtsam.imuBias.ConstantBias(), samples)
    assert rotation_log(ours.rotation[1].T @ theirs.deltaRij().matrix()) == pytest.approx(0.0, abs=1e-5)
    # Theirs takes a sample for the force at its beginning, ours for the mean: half a sample's turn apart.
    scale = np.abs(theirs.deltaVij()).max()
    assert ours.velocity[1] == pytest.approx(theirs.deltaVij(), abs=1e-3 * scale)
    assert ours.position[1] == pytest.approx(theirs.deltaPij(), abs=1e-3 * scale)
    order = np.r_[0:3, 6:9, 3:6]  # theirs: rotation, position, velocity
    sigmas = np.sqrt(np.diag(theirs.preintMeasCov())[:9])[order]
    assert np.sqrt(np.diag(ours.covariance[1])) == pytest.approx(sigmas, rel=0.1)


@pytest.fixture(scope="module")
def walked(robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes):
    """Samples, tracks and the IMU's true pose of every frame, the same for both."""
    random, walk, mount = np.random.default_rng(6), Walk(), robot.imu.body_from_imu
    ground = Ground(calibration, eyes, random, features=45)
    at_rest = as_samples(inertia(walk, robot, 0, FIRST * FRAME_NS, random))
    frames = []
    for k in range(FIRST, LAST):
        truth = walk.body(k * FRAME_NS * 1e-9) @ mount
        samples = as_samples(inertia(walk, robot, (k - 1) * FRAME_NS, k * FRAME_NS, random))
        frames.append((samples, ground.tracks(truth), truth))
    return at_rest, frames


def error_of_window(robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes, walked) -> float:
    at_rest, frames = walked
    window = SlidingWindow(eyes, robot.imu, calibration.left.fx, OdometryConfig())
    _, first, start = frames[0]
    begin_window(window, robot, start, at_rest, FIRST * FRAME_NS)
    window.see(first)
    for k, (samples, tracks, _) in enumerate(frames[1:], start=FIRST + 1):
        rate = samples[-1, 1:4] - window.frames.gyro_bias[window.newest]
        window.add_frame(k * FRAME_NS, samples, rate, tracks, resting=False)
        window.optimise()
    return float(np.linalg.norm(window.frames.position[window.newest] - frames[-1][2].position))


def error_of_smoother(robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes, walked) -> float:
    at_rest, frames = walked
    left_from_imu = Pose(rotation=eyes.rotation[0], position=eyes.translation[0])
    imu_from_left = gtsam.Pose3(left_from_imu.inverse().matrix)
    baseline = float(np.linalg.norm(eyes.translation[0] - eyes.translation[1]))
    camera = calibration.left
    stereo = gtsam.Cal3_S2Stereo(camera.fx, camera.fy, 0.0, camera.cx, camera.cy, baseline)
    noise = gtsam.noiseModel.Robust.Create(
        gtsam.noiseModel.mEstimator.Huber.Create(1.345), gtsam.noiseModel.Isotropic.Sigma(3, PIXEL)
    )
    params, smoother = preintegration_of(robot.imu), gtsam.IncrementalFixedLagSmoother(LAG)
    beginning = begin_at_rest(at_rest, frames[0][2].rotation, robot.imu, StartConfig())
    pose = gtsam.Pose3(gtsam.Rot3(beginning.rotation), frames[0][2].position)
    velocity, bias = np.zeros(3), gtsam.imuBias.ConstantBias(np.zeros(3), beginning.gyro_bias)
    known: set[int] = set()
    for n, (samples, tracks, _) in enumerate(frames):
        graph, values, stamps, t = gtsam.NonlinearFactorGraph(), gtsam.Values(), {}, n * FRAME_NS * 1e-9
        if n == 0:
            sigmas = np.array([1e-3, 1e-3, 1e-6, 1e-6, 1e-6, 1e-6])
            graph.add(gtsam.PriorFactorPose3(X(0), pose, gtsam.noiseModel.Diagonal.Sigmas(sigmas)))
            graph.add(gtsam.PriorFactorVector(V(0), velocity, gtsam.noiseModel.Isotropic.Sigma(3, 0.01)))
            spread = np.r_[0.05 * np.ones(3), 1e-3 * np.ones(3)]
            graph.add(gtsam.PriorFactorConstantBias(B(0), bias, gtsam.noiseModel.Diagonal.Sigmas(spread)))
        else:
            pim = integrated(params, bias, samples)
            graph.add(gtsam.CombinedImuFactor(X(n - 1), V(n - 1), X(n), V(n), B(n - 1), B(n), pim))
            state = pim.predict(gtsam.NavState(pose, velocity), bias)
            pose, velocity = state.pose(), state.velocity()
        for key, value in ((X(n), pose), (V(n), velocity), (B(n), bias)):
            values.insert(key, value)
            stamps[key] = t
        for identity, sight, seen in zip(tracks.identity, tracks.observation, tracks.seen, strict=True):
            if seen != LEFT | RIGHT:
                continue
            u, v, right = camera.fx * sight[0, 0], camera.fy * sight[0, 1], camera.fx * sight[1, 0]
            if u - right < 2.0:
                continue
            point = gtsam.StereoPoint2(u + camera.cx, right + camera.cx, v + camera.cy)
            graph.add(gtsam.GenericStereoFactor3D(point, noise, X(n), L(int(identity)), stereo, imu_from_left))
            if identity not in known or smoother.calculateEstimate().exists(L(int(identity))) is False:
                eye = gtsam.StereoCamera(pose.compose(imu_from_left), stereo)
                values.insert(L(int(identity)), eye.backproject(point))
                known.add(identity)
            stamps[L(int(identity))] = t
        smoother.update(graph, values, stamps)
        smoother.update()
        estimate = smoother.calculateEstimate()
        pose, velocity = estimate.atPose3(X(n)), estimate.atVector(V(n))
        bias = estimate.atConstantBias(B(n))
    return float(np.linalg.norm(pose.translation() - frames[-1][2].position))


def test_the_window_errs_no_more_than_twice_what_a_fixed_lag_smoother_does(
    robot: RobotDescription, calibration: StereoCalibration, eyes: Eyes, walked
) -> None:
    ours = error_of_window(robot, calibration, eyes, walked)
    theirs = error_of_smoother(robot, calibration, eyes, walked)
    path = float(np.linalg.norm(walked[1][-1][2].position - walked[1][0][2].position))
    assert theirs < 0.02 * path  # the oracle works
    assert ours < max(2.0 * theirs, 0.004 * path)
