"""Stereo-inertial odometry of the body (ICRA'17 III-A): front end, sliding window, start, standstill and failure."""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.contacts import ContactStream
from robot_agent.odometry.followed import Followed
from robot_agent.odometry.front_end import FrontEnd
from robot_agent.odometry.imu_stream import ImuStream, Inertia
from robot_agent.odometry.landmarks import RIGHT, Eyes
from robot_agent.odometry.leg_way import Way, guessed_way, joined, way_of
from robot_agent.odometry.own_legs import OwnLegs
from robot_agent.odometry.propagation import propagate
from robot_agent.odometry.seen_motion import SeenMotion
from robot_agent.odometry.start import Beginning, begin_again, begin_at_rest, begin_in_motion, is_still, levelled
from robot_agent.odometry.tracks import Tracks
from robot_agent.odometry.window import SlidingWindow
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import OdometryConfig
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.messages import ImuBatch, OdometryEstimate, OdometryQuality, StereoFrame
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose, rotation_z, skew, wxyz_from_rotation

Array = NDArray[np.float64]

DRIFT_SPEED, DRIFT_ACCELERATION = 0.02, 0.05
"""m/s and m/s^2: how fast the pose's uncertainty grows on inertia alone (velocity and tilt errors after a good fix)."""

SEEN_STILL = 0.7
"""Share of the flow allowed at rest below which pictures alone say that the body stands."""

BLOW = 1000.0
"""Times the sensor's noise, where a blow was beyond its range or a sample is missing: some 0.2 m/s that nobody has
measured."""

UNFOLLOWED = 3
"""Pictures in a row, hardly a feature of which is followed to the next, after which the pose rests on inertia alone."""

STEEP = 0.9
"""A body whose x axis points this far up or down has no heading to keep."""


class TrackSource(Protocol):
    """Whoever follows features: our front end on pictures, or a recording's tracks."""

    def step(self, frame: StereoFrame, left_from_previous: Pose, legs: OwnLegs | None = None) -> Tracks: ...

    def forget(self, identities: NDArray[np.int64]) -> None: ...


class StereoInertialOdometry:
    """One `step` per stereo pair. Bad pictures or inertia never raise: the estimate says what is wrong with it."""

    def __init__(
        self,
        *,
        calibration: StereoCalibration,
        imu: Imu,
        initial: Pose,
        config: OdometryConfig | None = None,
        body_from_imu: Pose | None = None,
        front_end: TrackSource | None = None,
    ) -> None:
        """`initial` is world_from_body at the first picture: its position and heading count, its tilt is measured.

        A body that moves on its feet before gravity is found begins where they have brought it.
        `body_from_imu` replaces the pose of the robot description (for recordings with rotated IMUs);
        `front_end` replaces our own (for recordings of tracks).
        """
        self._config = config if config is not None else OdometryConfig()
        self._imu = imu
        self._body_from_imu = body_from_imu if body_from_imu is not None else imu.body_from_imu
        self._imu_from_body = self._body_from_imu.inverse()
        eyes = [eye.body_from_camera.inverse() @ self._body_from_imu for eye in (calibration.left, calibration.right)]
        self._left_from_imu = eyes[0]
        self._time_offset_ns = round(calibration.time_offset * 1e9)
        self._front_end: TrackSource = (
            front_end if front_end is not None else FrontEnd(calibration, self._config.front_end)
        )
        self._window = SlidingWindow(
            Eyes(np.stack([e.rotation for e in eyes]), np.stack([e.position for e in eyes])),
            imu,
            calibration.left.fx,
            self._config,
        )
        self._stream = ImuStream(self._config.failure)
        self._feet = ContactStream(self._config.feet)
        self._initial = initial
        self._stamp: int | None = None
        self._started = False
        self._lost = False
        self._stereo = front_end is None  # tracks recorded by others may be of one eye
        self._on_feet = False  # the feet tell the way as well
        self._stepping = False  # and did so since the last picture
        self._footless = 0.0  # s that neither pictures nor feet have told anything
        self._waited = 0.0
        self._legs: OwnLegs | None = None  # when the newest pair was taken
        self._way_waiting: Way | None = None  # of the body's origin over its feet, from the first picture to the start
        self._history: deque[Array] = deque()
        self._remembered = 0.0  # s, of the history
        self._flows: deque[float] = deque(maxlen=100)  # px, motion seen in the last pictures
        self._seen_motion = SeenMotion(self._config.rest.seen_duration, calibration.left.fx)
        self._pending: list[Array] = []  # inertia since the window's newest frame
        self._pending_trusted = True
        self._pending_unmeasured = False
        self._pending_way: Way | None = None  # of the feet, likewise
        self._last_seen = np.zeros(0, dtype=np.int64)  # identities in the last picture
        self._unfollowed = 0  # pictures in a row
        self._rate = np.zeros(3)
        self._world_from_imu = initial @ self._body_from_imu
        self._velocity = np.zeros(3)
        self._forgotten = np.zeros((6, 6))  # covariance of the pose that the last restart began with

    @property
    def time_offset(self) -> float:
        """Estimated correction to the calibrated camera to IMU time offset, s."""
        return float(self._window.frames.time_offset[0])

    @property
    def mounting(self) -> Pose:
        """Estimated correction to where the calibrated eyes sit: imu_from_rig, the identity if they sit there."""
        return self._window.mounting()

    @property
    def bias_sigmas(self) -> Array:
        """(6,) standard deviations of the gyro (rad/s) and accelerometer bias (m/s^2)."""
        return self._window.bias_sigmas() if self._started else np.full(6, np.inf)

    @property
    def settled_poses(self) -> dict[int, Pose]:
        """world_from_body of the window's frames as it is believed now, by their pictures' stamps in ns."""
        if not self._started:
            return {}
        frames = self._window.frames
        return {
            stamp_ns: Pose(rotation=frames.rotation[k].copy(), position=frames.position[k].copy()) @ self._imu_from_body
            for k, stamp_ns in enumerate(self._window.stamps)
        }

    @property
    def followed(self) -> Followed:
        """Where features were followed in the newest left picture; nothing in tracks recorded by others."""
        return self._front_end.followed if isinstance(self._front_end, FrontEnd) else Followed.nothing()

    def step(
        self,
        frame: StereoFrame,
        imu: ImuBatch,
        contacts: FootContacts | None = None,
        legs: OwnLegs | None = None,
    ) -> OdometryEstimate:
        """The body's pose at the frame's stamp, from the pair and all inertial samples since the previous one.

        `contacts`, where the robot feels its feet, say how far it went over them; without pictures they go on alone.
        Nothing is followed where `legs`, as they were when the pair was taken, show in the pictures.
        """
        jump = self._jump_back(frame)
        if jump:
            self._forget_time()
        self._stream.add(imu)
        if contacts is not None:
            self._feet.add(contacts)
        if self._stamp is not None and frame.stamp_ns <= self._stamp:
            return self._report(OdometryQuality.DEGRADED, "picture repeated or out of order", 0)
        self._stamp = frame.stamp_ns
        end_ns = frame.stamp_ns + self._time_offset_ns
        inertia = self._stream.take_until(end_ns)
        if inertia.gap > self._config.failure.clock_jump:
            jump, inertia = inertia.gap, _nothing(inertia)
            self._forget_time()
            self._stream.take_until(end_ns)  # from here on time counts again
            self._stamp = frame.stamp_ns
        if jump and self._started:
            self._begin_again(self._front_end.step(frame, Pose.identity(), legs))
            return self._report(
                OdometryQuality.DEGRADED, f"the clock jumped by {jump:+.1f} s; began again where it was", 0
            )
        self._legs = legs
        self._walk_on(inertia, end_ns)
        self._rate = inertia.rate
        self._remember(inertia)
        return self._track(frame, inertia) if self._started else self._start(frame, inertia)

    def _jump_back(self, frame: StereoFrame) -> float:
        """Seconds (negative) by which a picture's clock is behind the last one's, if that is more than disorder."""
        if self._stamp is None:
            return 0.0
        back = (frame.stamp_ns - self._stamp) * 1e-9
        return back if back < -self._config.failure.clock_jump else 0.0

    def _forget_time(self) -> None:
        """What was felt belongs to another clock."""
        self._stream = ImuStream(self._config.failure)
        self._feet = ContactStream(self._config.feet)
        self._seen_motion.forget()
        self._history.clear()
        self._remembered = 0.0
        self._stamp = None
        self._clear_pending()

    # ---- beginning -------------------------------------------------------------------------------------------------

    def _start(self, frame: StereoFrame, inertia: Inertia) -> OdometryEstimate:
        tracks = self._front_end.step(frame, Pose.identity(), self._legs)
        if self._flows and self._pending_way is not None:
            before, way = self._way_waiting, self._pending_way
            self._way_waiting = way if before is None else joined(before, way, self._config.feet)
        start, samples = self._config.start, self._recent()
        duration = float(samples[:, 0].sum())
        self._waited += float(inertia.samples[:, 0].sum())
        guess = (self._initial @ self._body_from_imu).rotation
        self._flows.append(tracks.flow)
        moved, still = tracks.flow > self._config.rest.flow, self._seen_still()
        if (
            duration >= start.rest_duration - 1e-6
            and (still or not moved)
            and is_still(samples, None, self._config.rest, seen_still=still)
        ):
            self._begin(begin_at_rest(samples, guess, self._imu, start), tracks)
        elif self._waited >= start.patience:
            self._begin(begin_in_motion(samples, guess, start), tracks)
        else:
            self._set_attitude(levelled(guess, _direction(samples)) if len(samples) else guess)
            return self._report(OdometryQuality.INITIALISING, "waiting for rest to find gravity", tracks.number)
        return self._report(*self._judge(tracks, inertia), tracks.number)

    def _begin(self, beginning: Beginning, tracks: Tracks) -> None:
        self._set_attitude(beginning.rotation)
        self._window_begins(beginning, tracks)
        self._started = True

    def _set_attitude(self, rotation: Array) -> None:
        """Turn the body to `rotation` (world_from_imu) with its first heading, where it was or its feet went since."""
        body = rotation @ self._imu_from_body.rotation
        if abs(body[2, 0]) < STEEP and abs(self._initial.rotation[2, 0]) < STEEP:
            body = rotation_z(self._initial.yaw - Pose(rotation=body, position=np.zeros(3)).yaw) @ body
        position = self._initial.position
        if self._way_waiting is not None:
            first_rotation = body @ self._body_from_imu.rotation @ self._way_waiting.turn.T
            position = position + first_rotation @ self._way_waiting.displacement
        self._world_from_imu = Pose(rotation=body, position=position) @ self._body_from_imu

    def _window_begins(self, beginning: Beginning, tracks: Tracks) -> None:
        assert self._stamp is not None
        self._window.begin(
            self._stamp,
            rotation=self._world_from_imu.rotation,
            position=self._world_from_imu.position,
            velocity=self._velocity,
            gyro_bias=beginning.gyro_bias,
            accel_bias=beginning.accel_bias,
            rate=self._rate - beginning.gyro_bias,
            information=beginning.information,
        )
        self._window.see(tracks)
        self._clear_pending()
        self._lost = False

    # ---- following -------------------------------------------------------------------------------------------------

    def _track(self, frame: StereoFrame, inertia: Inertia) -> OdometryEstimate:
        before = self._world_from_imu
        self._pending.append(inertia.samples)
        self._pending_trusted &= inertia.trusted
        self._pending_unmeasured |= inertia.unmeasured
        self._predict()
        left_from_imu = self._left_from_imu @ self._window.mounting().inverse()
        left_from_previous = left_from_imu @ self._world_from_imu.inverse() @ before @ left_from_imu.inverse()
        tracks = self._front_end.step(frame, left_from_previous, self._legs)
        followed = int(np.isin(tracks.identity, self._last_seen).sum())
        self._unfollowed = 0 if followed >= self._config.failure.least_features else self._unfollowed + 1
        self._last_seen = tracks.identity
        resting = self._is_resting(tracks, inertia)
        blind = tracks.number < self._config.failure.least_features
        if self._lost and (self._stepping or not blind):
            self._begin_again(tracks)
            return self._report(OdometryQuality.DEGRADED, "began again after being lost", tracks.number)
        if blind and not resting and not self._may_go_on_feet():
            return self._report_blind(tracks)
        try:
            self._settle(tracks, resting)
        except np.linalg.LinAlgError:
            self._lost = True
            return self._report(OdometryQuality.LOST, "the window has no solution", tracks.number)
        return self._report(*self._judge(tracks, inertia), tracks.number)

    def _settle(self, tracks: Tracks, resting: bool) -> None:
        """Give the frame to the window and take its state over; begin again if that state can not be true."""
        assert self._stamp is not None
        window, failure = self._window, self._config.failure
        noise_scale = 1.0 if self._pending_trusted else 30.0
        if self._pending_unmeasured:
            noise_scale = BLOW
        window.add_frame(
            self._stamp,
            np.concatenate(self._pending),
            self._rate - window.frames.gyro_bias[window.newest],
            tracks,
            resting=resting,
            noise_scale=noise_scale,
            way=self._pending_way,
        )
        solved, wrong = window.optimise()
        k = window.newest
        velocity = window.frames.velocity[k]
        if not solved or not float(np.linalg.norm(velocity)) < failure.greatest_speed:
            self._lost = True
            self._begin_again(tracks)
            return
        self._front_end.forget(wrong)
        self._world_from_imu = Pose(
            rotation=window.frames.rotation[k].copy(), position=window.frames.position[k].copy()
        )
        self._velocity = velocity.copy()
        self._lost = False
        self._on_feet = not resting and (self._stepping or self._on_feet)
        self._clear_pending()

    def _predict(self) -> None:
        """Carry pose and velocity from the window's newest frame to now; a lost robot stays where it is."""
        window = self._window
        k = window.newest
        frames = window.frames
        rotation, position, velocity = propagate(
            frames.rotation[k],
            frames.position[k],
            frames.velocity[k],
            frames.gyro_bias[k],
            frames.accel_bias[k],
            np.concatenate(self._pending),
        )
        if self._lost or not float(np.linalg.norm(velocity)) < self._config.failure.greatest_speed:
            position, velocity = self._world_from_imu.position, np.zeros(3)
        self._world_from_imu = Pose(rotation=rotation, position=position)
        self._velocity = velocity

    def _begin_again(self, tracks: Tracks) -> None:
        """A new window in the old world: at the pose known last, with biases kept."""
        window = self._window
        k = window.newest
        self._forgotten = self._covariance_in_world()
        self._velocity = np.zeros(3)
        self._window_begins(
            begin_again(
                self._world_from_imu.rotation,
                window.frames.gyro_bias[k].copy(),
                window.frames.accel_bias[k].copy(),
                self._config.start,
            ),
            tracks,
        )

    def _walk_on(self, inertia: Inertia, end_ns: int) -> None:
        """Add what the feet went since the previous picture to what they went since the window's newest frame."""
        bias = self._window.frames.gyro_bias[self._window.newest] if self._started else np.zeros(3)
        # Before the gyro's bias is known it is the body's origin that is followed, amid the feet: there a wrong turn
        # does little.
        place = self._imu_from_body.position if self._started else np.zeros(3)
        imu_from_body = Pose(rotation=self._imu_from_body.rotation, position=place)
        way = way_of(self._feet.take_until(end_ns), inertia.samples, end_ns, bias, imu_from_body, self._config.feet)
        self._stepping = way is not None
        self._footless = 0.0 if self._stepping else self._footless + float(inertia.samples[:, 0].sum())
        if way is None and self._may_go_on_feet() and len(inertia.samples):
            way = guessed_way(
                self._world_from_imu.rotation.T @ self._velocity, inertia.samples, bias, self._config.feet
            )
        self._pending_way = joined(self._pending_way, way, self._config.feet) if self._pending else way

    def _may_go_on_feet(self) -> bool:
        """Do the feet tell the way, or have they until a moment ago? Between two steps inertia bridges the gap."""
        return self._stepping or (self._on_feet and self._footless < self._config.feet.longest_guess)

    def _clear_pending(self) -> None:
        self._pending = []
        self._pending_trusted = True
        self._pending_unmeasured = False
        self._pending_way = None

    # ---- standstill ------------------------------------------------------------------------------------------------

    def _remember(self, inertia: Inertia) -> None:
        self._history.append(inertia.samples)
        self._remembered += float(inertia.samples[:, 0].sum())
        longest = self._config.rest.duration if self._started else self._config.start.patience
        while len(self._history) > 1 and self._remembered > longest + 1e-6:
            self._remembered -= float(self._history.popleft()[:, 0].sum())

    def _recent(self) -> Array:
        return np.concatenate(self._history)

    def _is_resting(self, tracks: Tracks, inertia: Inertia) -> bool:
        assert self._stamp is not None
        self._flows.append(tracks.flow)
        still = self._seen_still()
        moved = self._seen_motion.step(self._stamp, tracks)
        if self._stereo and moved > self._config.rest.seen_motion:  # tracks recorded by others may wander at rest
            return False
        if not inertia.trusted or (tracks.flow > self._config.rest.flow and not still):
            return False
        gyro_bias = self._window.frames.gyro_bias[self._window.newest]
        return is_still(self._recent(), gyro_bias, self._config.rest, seen_still=still)

    def _seen_still(self) -> bool:
        """Have the last pictures, but for the odd one, shown hardly any motion?"""
        flows = list(self._flows)[-len(self._history) :]
        known = [flow for flow in flows if np.isfinite(flow)]
        if len(known) < 4 or 2 * len(known) < len(flows):
            return False
        return float(np.median(known)) < SEEN_STILL * self._config.rest.flow

    # ---- reporting -------------------------------------------------------------------------------------------------

    def _judge(self, tracks: Tracks, inertia: Inertia) -> tuple[OdometryQuality, str]:
        reasons = [problem for problem in (tracks.problem, inertia.problem) if problem]
        matched = float(((tracks.seen & RIGHT) > 0).mean()) if tracks.number else 1.0
        if not tracks.problem and self._stereo and matched < self._config.failure.least_matched:
            reasons.append(f"the eyes agree on {100.0 * matched:.0f} % of the features: is their calibration right?")
        if self._unfollowed >= UNFOLLOWED and tracks.number >= self._config.failure.least_features:
            reasons.append("features are not followed from picture to picture; on inertia alone")
        if tracks.number < self._config.failure.least_features:
            reasons.append("on inertia and feet" if self._on_feet else "standing without sight")
        elif tracks.number < self._config.failure.good_features:
            reasons.append(f"only {tracks.number} features")
        return (OdometryQuality.DEGRADED, "; ".join(reasons)) if reasons else (OdometryQuality.GOOD, "")

    def _report_blind(self, tracks: Tracks) -> OdometryEstimate:
        duration = self._blind_duration()
        why = tracks.problem or f"only {tracks.number} features"
        if duration > self._config.failure.blind_duration or self._lost:
            self._lost = True
            self._velocity = np.zeros(3)
            return self._report(OdometryQuality.LOST, f"{why}; inertia alone for {duration:.1f} s", tracks.number)
        return self._report(OdometryQuality.DEGRADED, f"{why}; on inertia alone", tracks.number)

    def _blind_duration(self) -> float:
        return float(sum(samples[:, 0].sum() for samples in self._pending))

    def _covariance_in_world(self) -> Array:
        covariance = self._window.pose_covariance() + self._forgotten
        alone = self._blind_duration()
        spread = DRIFT_SPEED * alone + DRIFT_ACCELERATION * alone**2
        return np.asarray(covariance + np.diag(np.repeat([(0.002 * alone) ** 2, spread**2], 3)))

    def _report(self, quality: OdometryQuality, reason: str, features: int) -> OdometryEstimate:
        assert self._stamp is not None
        world_from_body = self._world_from_imu @ self._imu_from_body
        if self._started:
            k = self._window.newest
            gyro_bias, accel_bias = self._window.frames.gyro_bias[k].copy(), self._window.frames.accel_bias[k].copy()
            rate = self._rate - gyro_bias
            covariance = self._covariance_in_world()
        else:
            gyro_bias, accel_bias, rate = np.zeros(3), np.zeros(3), np.zeros(3)
            covariance = np.diag(np.repeat([self._config.start.moving_tilt_sigma**2, 1e-6], 3))
        lever_in_imu = self._imu_from_body.position
        return OdometryEstimate(
            stamp_ns=self._stamp,
            position_in_world=world_from_body.position,
            wxyz=wxyz_from_rotation(world_from_body.rotation),
            velocity_in_world=self._velocity + self._world_from_imu.rotation @ np.cross(rate, lever_in_imu),
            angular_velocity_in_body=self._body_from_imu.rotation @ rate,
            gyro_bias=gyro_bias,
            accel_bias=accel_bias,
            covariance=_moved(covariance, self._world_from_imu.rotation, self._body_from_imu, lever_in_imu),
            quality=quality,
            reason=reason,
            tracked_features=features,
        )


def _nothing(inertia: Inertia) -> Inertia:
    return replace(inertia, samples=np.zeros((0, 7)), trusted=False)


def _direction(samples: Array) -> Array:
    force = samples[:, 4:7].mean(axis=0)
    norm = float(np.linalg.norm(force))
    return np.asarray(force / norm) if norm > 0.0 else np.array([0.0, 0.0, 1.0])


def _moved(covariance: Array, world_from_imu: Array, body_from_imu: Pose, body_in_imu: Array) -> Array:
    """Covariance (6, 6) of the IMU's pose as that of the body's."""
    carry = np.eye(6)
    carry[:3, :3] = body_from_imu.rotation
    carry[3:, :3] = -world_from_imu @ skew(body_in_imu)
    return np.asarray(carry @ covariance @ carry.T)
