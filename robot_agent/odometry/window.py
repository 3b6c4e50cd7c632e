"""Keyframe sliding window: Gauss-Newton over the last frames' poses, velocities and biases, and the rig's place in time
and space.

Keyframe choice and bounded estimation follow OKVIS (Leutenegger et al., IJRR 2015); measured settings: 8 keyframes,
3 newest frames, 2 iterations.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpotrf, dpotrs

from robot_agent.odometry.inertial_factor import add_inertia
from robot_agent.odometry.landmark_elimination import Elimination, add_reprojections, move_points
from robot_agent.odometry.landmarks import Eyes, Landmarks, triangulate
from robot_agent.odometry.leg_way import Way, joined
from robot_agent.odometry.preintegration import Preintegrations, begin, integrate
from robot_agent.odometry.prior import Prior, eliminate
from robot_agent.odometry.reprojection_factor import exposure_views, reject
from robot_agent.odometry.rest_factor import add_rest
from robot_agent.odometry.tracks import Tracks
from robot_agent.odometry.way_factor import Ways, add_ways
from robot_agent.odometry.window_state import COMMON_FIELDS, GYRO_BIAS, STATE, Frames, advance, unknowns
from weaver_shared.config.odometry import OdometryConfig
from weaver_shared.frames import GRAVITY
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

ROWS = 768
"""Landmarks the table holds: more than 8 keyframes of 130 features with 85 % overlap can name."""

CONVERGED = 3e-4
"""After a step below this (m, rad), a second would be a thousandth of it: far below what the pictures can tell."""

GYRO_BIAS_DRIFT, ACCEL_BIAS_DRIFT = 0.01, 0.1
"""rad/s, m/s^2: a bias further than this from the one integrated with needs a second integration."""

RESIDUAL_MEMORY = 0.02
"""Share of the newest frame in the observations' mean error: fifty frames, four seconds."""

LEAST_SIGMA, MOST_SIGMA = 0.5, 4.0
"""Times the configured sigma: between which an observation's own is found."""


class SlidingWindow:
    """Give it `begin`, then per frame `add_frame` and `optimise`; the last used slot is the newest frame."""

    def __init__(self, eyes: Eyes, imu: Imu, focal_length: float, config: OdometryConfig) -> None:
        slots = config.window.keyframes + config.window.recent + 1
        self.frames = Frames.of(slots)
        self.landmarks = Landmarks.of(ROWS, slots)
        self.count = 0
        self.stamps: list[int] = []
        self._config = config.window
        self._feet = config.feet
        self._eyes = eyes
        self._imu = imu
        self._per_sigma = focal_length / config.window.pixel_sigma
        self._pre = Preintegrations.of(slots)
        self._samples: list[Array] = []
        self._noise_scales: list[float] = []  # of the samples: times the sensor's own noise
        self._ways: list[Way | None] = []
        self._way_slots = Ways.of(slots)
        self._resting = np.zeros(slots, dtype=np.bool_)
        self._keyframe = np.zeros(slots, dtype=np.bool_)
        self._tracked = np.zeros(slots, dtype=np.int64)  # features each frame came with
        self._elimination = Elimination.of(ROWS, slots)
        self._residual = 1.0 / max(
            config.window.correlation, 1.0
        )  # sigma, root mean square of the observations' errors of late
        self._prior = Prior(slots)
        self._bias_walk = np.array([imu.gyro_random_walk, imu.accel_random_walk])
        rest = config.rest
        self._rest_sigmas = np.repeat([rest.rotation_sigma, rest.position_sigma, rest.velocity_sigma], 3)
        self._factor: Array | None = None

    @property
    def newest(self) -> int:
        return self.count - 1

    def begin(
        self,
        stamp_ns: int,
        *,
        rotation: Array,
        position: Array,
        velocity: Array,
        gyro_bias: Array,
        accel_bias: Array,
        rate: Array,
        information: Array,
    ) -> None:
        """Start over with one frame, of which `information` (15, 15) is known; what all frames share is kept."""
        self.landmarks.forget(np.ones(ROWS, dtype=np.bool_))
        for array, value in zip(
            self.frames[:6], (rotation, position, velocity, gyro_bias, accel_bias, rate), strict=True
        ):
            array[0] = value
        self._keyframe[:] = False
        self._keyframe[0] = True
        self._resting[:] = False
        self._samples = [np.zeros((0, 7))]
        self._noise_scales = [1.0]
        self._ways = [None]
        self.stamps = [stamp_ns]
        self.count = 1
        self._factor = None
        self._prior.begin(self.frames, information, self._common_sigmas())

    def see(self, tracks: Tracks) -> None:
        """Enter the newest frame's tracks."""
        self._tracked[self.newest] = tracks.number
        self.landmarks.see(self.newest, tracks.identity, tracks.observation, tracks.seen)

    def add_frame(
        self,
        stamp_ns: int,
        samples: Array,
        rate: Array,
        tracks: Tracks,
        *,
        resting: bool,
        noise_scale: float = 1.0,
        way: Way | None = None,
    ) -> None:
        """Append a frame, predicted by the inertial `samples` (n, 7) since the newest; `way` is that of the feet."""
        self._make_room()
        k, frames = self.count, self.frames
        for array in frames[:-COMMON_FIELDS]:
            array[k] = array[k - 1]
        frames.rate[k] = rate
        self._resting[k] = resting
        self._keyframe[k] = False
        self._samples.append(samples)
        self._noise_scales.append(noise_scale)
        self._ways.append(way)
        self.stamps.append(stamp_ns)
        self.count += 1
        self._prior.append_frame()
        begin(self._pre, k, frames.gyro_bias[k], frames.accel_bias[k])
        self._integrate(k, samples, noise_scale)
        self._predict(k)
        self._enter_way(k)
        self.see(tracks)

    def optimise(self) -> tuple[bool, NDArray[np.int64]]:
        """Settle all states; False if the system has no solution. Also names the tracks found to be wrong."""
        self._integrate_again_where_biases_moved()
        count, frames, landmarks, config = self.count, self.frames, self.landmarks, self._config
        _, _, views = exposure_views(frames, self._eyes, count)
        triangulate(landmarks, views, count, config.parallax, 2.0 * config.gate / self._per_sigma)
        everything = np.ones(ROWS, dtype=np.bool_)
        for _ in range(config.iterations):
            hessian, gradient = self._system(0, count - 1, everything)
            step = self._solve(hessian, gradient)
            if step is None:
                return False, np.zeros(0, dtype=np.int64)
            advance(frames, count, step)
            move_points(landmarks, self._elimination, count, step)
            if float(np.abs(step[: STATE * count].reshape(count, STATE)[:, :6]).max()) < CONVERGED:
                break
        dead, left = reject(frames, landmarks, self._eyes, count, self._per_sigma, config.gate)
        if np.isfinite(left):
            self._residual += RESIDUAL_MEMORY * (left - self._residual)
        self._forget_hopeless()
        return True, landmarks.identity[dead & (landmarks.identity >= 0)].copy()

    def mounting(self) -> Pose:
        """Imu_from_rig: how the rig of both eyes sits on the IMU, the identity being as it was calibrated."""
        turn = self.frames.rig_rotation
        return Pose(rotation=turn.copy(), position=turn @ self.frames.rig_shift)

    def pose_covariance(self) -> Array:
        """(6, 6) of the newest IMU pose: rotation error (in imu, rad), position error (in world, m)."""
        if self._factor is None or len(self._factor) != unknowns(self.count):
            return np.diag(1.0 / np.diag(self._prior.hessian)[:6])
        return self._newest_covariance(0, 6)

    def bias_sigmas(self) -> Array:
        """(6,) standard deviations of the newest gyro (rad/s) and accelerometer bias (m/s^2)."""
        if self._factor is None or len(self._factor) != unknowns(self.count):
            return np.asarray(1.0 / np.sqrt(np.diag(self._prior.hessian)[GYRO_BIAS:STATE]))
        return np.asarray(np.sqrt(np.diag(self._newest_covariance(GYRO_BIAS, 6))))

    def _system(self, first: int, last: int, chosen: NDArray[np.bool_]) -> tuple[Array, Array]:
        """Hessian (upper triangle) and gradient of the prior, the inertia from `first` to `last`, and the `chosen`
        landmarks."""
        size = unknowns(self.count)
        hessian, gradient = np.zeros((size, size)), np.zeros(size)
        frames, prior = self.frames, self._prior
        prior.linearise_at(frames)
        prior.add_to(frames, hessian, gradient)
        add_inertia(frames, prior.origin, self._pre, first, last, self._bias_walk, hessian, gradient)
        add_rest(frames, prior.origin, self._resting, first, last, self._rest_sigmas, hessian, gradient)
        add_ways(frames, prior.origin, self._way_slots, first, last, self._feet.huber, hessian, gradient)
        add_reprojections(
            frames,
            prior.origin,
            self.landmarks,
            chosen,
            self._eyes,
            self.count,
            self._per_sigma,
            self._config.huber,
            self._trust(),
            self._elimination,
            hessian,
            gradient,
        )
        return hessian, gradient

    def _common_sigmas(self) -> Array:
        config = self._config
        return np.array([config.time_offset_sigma, *[config.rig_turn_sigma] * 3, *[config.rig_shift_sigma] * 3])

    def _trust(self) -> float:
        """How much more, or less, than by their sigma the observations count: by how well they have agreed of late.

        A followed corner is off by nearly the same in all the frames that see it, so that many sightings tell little
        more than one, and on broken ground they are off by more.
        """
        if self._config.correlation == 0.0:
            return 1.0
        sigma = min(max(self._config.correlation * self._residual, LEAST_SIGMA), MOST_SIGMA)
        return float(1.0 / sigma**2)

    def _solve(self, hessian: Array, gradient: Array) -> Array | None:
        for damping in (0.0, 1e-9, 1e-6):
            hessian[np.diag_indices_from(hessian)] *= 1.0 + damping
            # LAPACK wants columns: to it the upper triangle of our rows is a lower one.
            factor, failed = dpotrf(hessian.T, lower=1, clean=0)
            if failed:
                continue
            self._factor = factor
            step = -self._solved(gradient)
            return step if bool(np.isfinite(step).all()) else None
        return None

    def _solved(self, right: Array) -> Array:
        return np.asarray(dpotrs(self._factor, right, lower=1)[0])

    def _newest_covariance(self, first: int, number: int) -> Array:
        """Of `number` unknowns of the newest frame from `first` on, by the last solution."""
        place = STATE * self.newest + first
        columns = np.zeros((unknowns(self.count), number), order="F")
        columns[place : place + number] = np.eye(number)
        solved = self._solved(columns)[place : place + number]
        return np.asarray(0.5 * (solved + solved.T))

    def _make_room(self) -> None:
        """Decide about the frame that is no longer one of the newest, and let the oldest keyframe go."""
        candidate = self.count - self._config.recent
        if candidate < 1:
            return
        if not self._deserves_keyframe(candidate):
            self._drop(candidate)
            return
        self._keyframe[candidate] = True
        if int(self._keyframe[: self.count].sum()) > self._config.keyframes:
            self._marginalise_oldest()

    def _deserves_keyframe(self, candidate: int) -> bool:
        previous = candidate - 1
        if (self.stamps[candidate] - self.stamps[previous]) * 1e-9 > self._config.keyframe_interval:
            return True
        if self._resting[candidate] != self._resting[candidate + 1]:
            return True  # joined, the two intervals would no longer be known to hold a rest
        seen = self.landmarks.seen
        both = (seen[:, previous] > 0) & (seen[:, candidate] > 0)
        return bool(both.sum() < self._config.keyframe_overlap * self._tracked[previous])

    def _drop(self, slot: int) -> None:
        """Leave a frame out, its inertia joined to the next one's."""
        self._integrate(slot, self._samples[slot + 1], self._noise_scales[slot + 1])
        self._noise_scales[slot : slot + 2] = [max(self._noise_scales[slot : slot + 2])]
        self._pre.remove(slot + 1)
        self._samples[slot : slot + 2] = [np.concatenate(self._samples[slot : slot + 2])]
        self._ways[slot : slot + 2] = [joined(self._ways[slot], self._ways[slot + 1], self._feet)]
        self._way_slots.remove(slot + 1)
        self._enter_way(slot)
        self._resting[slot + 1] &= self._resting[slot]
        self._close_gap(slot)

    def _marginalise_oldest(self) -> None:
        """Fold the oldest keyframe, its inertia and the landmarks only old keyframes see into the prior."""
        undecided = self.count - self._config.recent + 1
        seen = self.landmarks.seen
        leaving = (seen[:, 0] > 0) & ~(seen[:, undecided : self.count] > 0).any(axis=1)
        hessian, gradient = self._system(0, 1, leaving)
        hessian = np.triu(hessian) + np.triu(hessian, 1).T
        self._prior.replace(self.frames, *eliminate(hessian, gradient, 0))
        self.landmarks.forget(leaving)
        self._pre.remove(0)
        self._samples.pop(0)
        self._noise_scales.pop(0)
        self._ways.pop(0)
        self._way_slots.remove(0)
        self._close_gap(0)

    def _close_gap(self, slot: int) -> None:
        self._prior.remove_frame(slot)
        self.frames.remove(slot)
        self.landmarks.remove_frame(slot)
        for column in (self._keyframe, self._resting, self._tracked):
            column[slot:-1] = column[slot + 1 :].copy()
        self.stamps.pop(slot)
        self.count -= 1

    def _enter_way(self, slot: int) -> None:
        way = self._ways[slot]
        self._way_slots.variance[slot] = 0.0 if way is None else way.variance
        if way is not None:
            self._way_slots.displacement[slot] = way.displacement

    def _integrate(self, slot: int, samples: Array, noise_scale: float = 1.0) -> None:
        gyro, accel = self._imu.gyro_noise_density, self._imu.accel_noise_density
        integrate(self._pre, slot, samples, gyro * noise_scale, accel * noise_scale)

    def _integrate_again_where_biases_moved(self) -> None:
        frames, pre = self.frames, self._pre
        for k in range(1, self.count):
            gyro_moved = np.abs(frames.gyro_bias[k - 1] - pre.gyro_bias[k]).max() > GYRO_BIAS_DRIFT
            if gyro_moved or np.abs(frames.accel_bias[k - 1] - pre.accel_bias[k]).max() > ACCEL_BIAS_DRIFT:
                begin(pre, k, frames.gyro_bias[k - 1], frames.accel_bias[k - 1])
                self._integrate(k, self._samples[k], self._noise_scales[k])

    def _predict(self, k: int) -> None:
        frames, pre = self.frames, self._pre
        dt = pre.duration[k]
        before = frames.rotation[k - 1]
        frames.rotation[k] = before @ pre.rotation[k]
        frames.position[k] += frames.velocity[k - 1] * dt + before @ pre.position[k] - [0.0, 0.0, _fall(dt)]
        frames.velocity[k] += before @ pre.velocity[k] - [0.0, 0.0, GRAVITY * dt]

    def _forget_hopeless(self) -> None:
        """Free the rows that no longer tie frames and are not followed any more."""
        seen = self.landmarks.seen[:, : self.count] > 0
        self.landmarks.forget(~seen[:, -1] & ((seen.sum(axis=1) < 2) | ~self.landmarks.solved))


def _fall(dt: float) -> float:
    return 0.5 * GRAVITY * dt * dt
