"""A walking-like motion known in closed form, with the inertia and the sightings it causes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.landmarks import LEFT, RIGHT, Eyes
from robot_agent.odometry.start import begin_at_rest
from robot_agent.odometry.tracks import Tracks
from robot_agent.odometry.window import SlidingWindow
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import StartConfig
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose, rotation_exp, rotation_from_rpy, rotation_log

Array = NDArray[np.float64]

SAMPLE_NS = 5_000_000
FRAME_NS = 50_000_000
REST = 1.0  # s before the first step


@dataclass(frozen=True)
class Walk:
    """Pose of the body over time: rest, then `speed` forward with the sway of a tripod gait."""

    speed: float = 0.2
    sway: float = 1.0

    def body(self, t: float) -> Pose:
        d = max(0.0, t - REST)
        way = self.speed * (d - 0.5 * (1.0 - np.exp(-d / 0.5)))
        g = min(1.0, d / 0.6) ** 2 * (3.0 - 2.0 * min(1.0, d / 0.6)) * self.sway
        w = 2.0 * np.pi * 0.9
        position = [way, 0.008 * g * np.sin(w * t) + 0.2 * np.sin(0.5 * way), 0.165 + 0.005 * g * np.sin(2 * w * t)]
        rotation = rotation_from_rpy(
            0.015 * g * np.sin(w * t + 0.4), 0.015 * g * np.sin(2 * w * t + 1.0), 0.1 * np.sin(0.5 * way)
        )
        return Pose(rotation=rotation, position=np.array(position))

    def velocity(self, t: float, body_from_point: Pose) -> Array:
        h = 2e-4
        ahead, behind = self.body(t + h) @ body_from_point, self.body(t - h) @ body_from_point
        return np.asarray((ahead.position - behind.position) / (2.0 * h))


def inertia(
    walk: Walk,
    robot: RobotDescription,
    begin_ns: int,
    end_ns: int,
    random: np.random.Generator | None = None,
    gyro_bias: Array | None = None,
    accel_bias: Array | None = None,
) -> ImuBatch:
    """Samples that end in (begin, end]: means over 5 ms, with the described noise if `random` is given."""
    stamps = np.arange(begin_ns // SAMPLE_NS * SAMPLE_NS + SAMPLE_NS, end_ns + 1, SAMPLE_NS, dtype=np.int64)
    dt = SAMPLE_NS * 1e-9
    mount = robot.imu.body_from_imu
    gyro, force = np.zeros((len(stamps), 3)), np.zeros((len(stamps), 3))
    for n, stamp in enumerate(stamps):
        t1 = float(stamp) * 1e-9
        t0 = t1 - dt
        first, second = (walk.body(t0) @ mount).rotation, (walk.body(t1) @ mount).rotation
        gyro[n] = rotation_log(first.T @ second) / dt
        middle = first @ rotation_exp(gyro[n] * dt / 2.0)
        gained = walk.velocity(t1, mount) - walk.velocity(t0, mount)
        force[n] = middle.T @ (gained / dt + np.array([0.0, 0.0, GRAVITY]))
    if random is not None:
        gyro += random.normal(0.0, robot.imu.gyro_noise_density / np.sqrt(dt), gyro.shape)
        force += random.normal(0.0, robot.imu.accel_noise_density / np.sqrt(dt), force.shape)
    if gyro_bias is not None:
        gyro += gyro_bias
    if accel_bias is not None:
        force += accel_bias
    return ImuBatch(stamp_ns=stamps, angular_velocity_in_imu=gyro, specific_force_in_imu=force)


def as_samples(batch: ImuBatch) -> Array:
    """(n, 7) duration, angular velocity, specific force."""
    durations = np.full(len(batch.stamp_ns), SAMPLE_NS * 1e-9)
    return np.column_stack([durations, batch.angular_velocity_in_imu, batch.specific_force_in_imu])


def begin_window(window: SlidingWindow, robot: RobotDescription, start: Pose, at_rest: Array, stamp_ns: int) -> None:
    """Begin at world_from_imu `start` with what `at_rest` (n, 7) samples of standing tell of tilt and biases."""
    beginning = begin_at_rest(at_rest, start.rotation, robot.imu, StartConfig())
    window.begin(
        stamp_ns,
        rotation=beginning.rotation,
        position=start.position,
        velocity=np.zeros(3),
        gyro_bias=beginning.gyro_bias,
        accel_bias=beginning.accel_bias,
        rate=np.zeros(3),
        information=beginning.information,
    )


class Ground:
    """Landmarks scattered over uneven ground, seen by an ideal front end that keeps `features` of them."""

    def __init__(self, calibration: StereoCalibration, eyes: Eyes, random: np.random.Generator, features: int) -> None:
        self._eyes, self._random, self._features = eyes, random, features
        self._focal = calibration.left.fx
        self._half = np.array([calibration.left.cx, calibration.left.cy]) / self._focal
        self._points = np.column_stack(
            [random.uniform(0.0, 4.0, 4000), random.uniform(-1.0, 1.0, 4000), random.uniform(-0.05, 0.05, 4000)]
        )
        self._active: set[int] = set()

    def forget(self, identities: NDArray[np.int64]) -> None:
        self._active -= {int(i) for i in identities}

    def tracks(self, world_from_imu: Pose, noise_px: float = 0.4, outliers: float = 0.0) -> Tracks:
        plane, visible = [], []
        for e in range(2):
            in_imu = (self._points - world_from_imu.position) @ world_from_imu.rotation
            in_eye = in_imu @ self._eyes.rotation[e].T + self._eyes.translation[e]
            xy = in_eye[:, :2] / in_eye[:, 2:]
            plane.append(xy)
            visible.append((in_eye[:, 2] > 0.15) & (in_eye[:, 2] < 1.2) & (np.abs(xy) < self._half).all(axis=1))
        self._active = {i for i in self._active if visible[0][i]}
        candidates = self._random.permutation(np.flatnonzero(visible[0]))
        for i in candidates[: 2 * self._features]:
            if len(self._active) >= self._features:
                break
            self._active.add(int(i))
        identity = np.array(sorted(self._active), dtype=np.int64)
        observation = np.stack([plane[0][identity], plane[1][identity]], axis=1)
        observation += self._random.normal(0.0, noise_px / self._focal, observation.shape)
        wrong = identity % 100 < 100 * outliers  # the same tracks again and again, as feet and shadows are
        observation[wrong] += self._random.normal(0.0, 20.0 / self._focal, observation[wrong].shape)
        seen = np.where(visible[1][identity], LEFT | RIGHT, LEFT).astype(np.uint8)
        return Tracks(identity=identity, observation=observation, seen=seen, flow=1.0, problem="")
