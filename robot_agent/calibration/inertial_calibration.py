"""Where the IMU stands from the camera and how late it is: one batch over a continuous-time trajectory.

As in Furgale et al. 2013: the IMU's pose is a spline, every corner and every sample a measurement of it at its own
instant, so that the delay between the clocks has a derivative like any other parameter.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_solve_banded, cholesky_banded

from robot_agent.calibration.camera_calibration import locate_views
from robot_agent.calibration.corner_table import CornerTable
from robot_agent.calibration.excitation import check_excitation
from robot_agent.calibration.inertial_kernels import (
    BIASES,
    CONTROL,
    MOVE,
    OFFSET,
    PULL,
    REACH,
    SCALE,
    TURN,
    add_inertia,
    add_pictures,
)
from robot_agent.calibration.inertial_start import InertialStart, align, seconds_of
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.rig_batch import solve_rig
from robot_agent.calibration.robust import BEND
from robot_agent.calibration.sightings import View
from robot_agent.calibration.spline import ORDER, blending
from robot_agent.calibration.target import Target
from weaver_shared.errors import InputError
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch
from weaver_shared.robots.description import Imu
from weaver_shared.transforms import Pose, rotation_exp, rotation_log

Array = NDArray[np.float64]

GRAVITY_SIGMA = 0.02
"""How far the place's gravity may be from the standard one, m/s^2: equator to pole and some height."""

BIAS_INTERVAL = 5.0
"""Between nodes of the biases, s; linear in between."""

PADDING = 0.04
"""Of the spline beyond the first and last picture, s: room for the time offset to move."""

MOST_STEPS = 25


@dataclass(frozen=True, slots=True, kw_only=True)
class Trajectory:
    """The IMU's pose in the target's frame over time, and what the IMU measures wrongly."""

    rotations: Array  # controls (n, 3, 3)
    positions: Array  # controls (n, 3)
    imu_from_camera: Pose
    time_offset: float
    gravity: Array  # (3,) in the target's frame
    biases: Array  # nodes (k, 6): gyro rad/s, accelerometer m/s^2


@dataclass(frozen=True, slots=True, kw_only=True)
class InertialEstimate:
    imu_from_camera: Pose
    time_offset: float
    gravity_in_target: Array  # (3,) m/s^2
    gyro_bias: Array  # (3,) mean over the recording
    accel_bias: Array  # (3,)
    bias_sigma: Array  # (6,) of both means, gyro first
    rotation_sigma: Array  # (3,) rad, about the camera's axes
    position_sigma: Array  # (3,) m, along the IMU's axes
    time_offset_sigma: float
    position_covariance: Array  # (3, 3)
    corner_errors: Array  # (n, 2) px
    gyro_errors: Array  # (m, 3) in sigmas of the IMU's own noise
    accel_errors: Array  # (m, 3)
    pictures: int
    target_scale: float  # by the accelerometer, over what the target's file says
    target_scale_sigma: float
    start: InertialStart


def calibrate_imu(
    rig: Rig,
    views: Sequence[View],
    target: Target,
    inertia: ImuBatch,
    imu: Imu,
    *,
    knots_per_second: float = 50.0,
    tell: Callable[[str], None] = lambda _: None,
) -> InertialEstimate:
    """`rig` is known; raises InputError where pictures or samples are too few or do not belong together.

    `tell` hears what is being done.
    """
    if len(inertia.stamp_ns) < 100:
        raise InputError(f"the recording has {len(inertia.stamp_ns)} IMU samples; the camera-IMU part needs its IMU")
    tell("places of the pictures")
    located, poses = locate_views(rig, views, target)
    if len(located) < 20:
        raise InputError(f"the target is in {len(located)} pictures; the camera-IMU part needs at least 20")
    refined = solve_rig(rig, poses, CornerTable.of(located, target, range(rig.eyes)), free="poses")
    poses = list(refined.first_from_target)
    origin_ns = located[0].stamp_ns
    stamps = np.array([(view.stamp_ns - origin_ns) * 1e-9 for view in located])
    during = (inertia.stamp_ns >= located[0].stamp_ns) & (inertia.stamp_ns <= located[-1].stamp_ns)
    if during.sum() < 100:
        raise InputError("pictures and IMU samples have no time in common: are they of one recording and one clock?")
    check_excitation(inertia.angular_velocity_in_imu[during], float(stamps[-1]))
    tell("turn and delay")
    start = align(stamps, poses, seconds_of(inertia, origin_ns), inertia.angular_velocity_in_imu)
    batch = _Batch(
        rig,
        refined.table.only(refined.used),
        stamps,
        refined.sigma,
        inertia,
        origin_ns,
        imu,
        start,
        1.0 / knots_per_second,
    )
    trajectory = batch.first(poses, start)
    try:
        trajectory = batch.solve(trajectory, tell)
        tell("how sure it is")
        return batch.estimate(trajectory, start)
    except np.linalg.LinAlgError as error:
        raise InputError(
            "pictures and IMU samples together do not tell where the IMU is: record again, with more motion"
        ) from error


class _Batch:
    def __init__(
        self,
        rig: Rig,
        table: CornerTable,
        stamps: Array,
        sigma: float,
        inertia: ImuBatch,
        origin_ns: int,
        imu: Imu,
        start: InertialStart,
        interval: float,
    ) -> None:
        self._rig, self._table, self._sigma, self._interval = rig, table, sigma, interval
        begin = stamps[0] + start.time_offset - PADDING
        times = seconds_of(inertia, origin_ns) - begin
        span = stamps[-1] - stamps[0] + 2.0 * PADDING
        inside = (times >= 0.0) & (times <= span)
        self._times = times[inside]
        if len(self._times) < 100:
            raise InputError("pictures and IMU samples have hardly any time in common")
        self._rates = np.ascontiguousarray(inertia.angular_velocity_in_imu[inside])
        self._forces = np.ascontiguousarray(inertia.specific_force_in_imu[inside])
        # The stamps are counted so that adding the time offset leads to the spline's time.
        self._stamps = stamps - begin
        self._first_corner = np.searchsorted(table.view, np.arange(len(stamps) + 1)).astype(np.int64)
        self._segments = int(np.ceil(span / interval)) + 1
        self._nodes = max(2, int(np.ceil(span / BIAS_INTERVAL)) + 1)
        self._node_interval = self._segments * interval / (self._nodes - 1)
        root = np.sqrt(1.0 / float(np.median(np.diff(self._times))))
        self._sigmas = np.array([imu.gyro_noise_density, imu.accel_noise_density]) * root
        walk = np.sqrt(self._node_interval)
        self._walk = np.repeat(np.array([imu.gyro_random_walk, imu.accel_random_walk]) * walk, 3)

    def first(self, camera_from_target: list[Pose], start: InertialStart) -> Trajectory:
        """Controls on the camera's own poses; gravity is what the accelerometer feels on average."""
        rotations = np.array([pose.rotation.T @ start.imu_from_camera.T for pose in camera_from_target])
        positions = np.array([pose.inverse().position for pose in camera_from_target])
        times = self._stamps + start.time_offset
        # A control acts most in the middle of its six segments.
        at: Array = (np.arange(self._segments + ORDER - 1, dtype=np.float64) - 2.0) * self._interval
        controls = _rotations_at(times, rotations, at)
        positions = np.stack([np.interp(at, times, column) for column in positions.T], axis=1)
        felt = _rotations_at(times, rotations, self._times) @ self._forces[:, :, None]
        gravity = -felt[:, :, 0].mean(axis=0)
        biases = np.zeros((self._nodes, 6))
        biases[:, :3] = start.gyro_bias
        return Trajectory(
            rotations=controls,
            positions=positions,
            imu_from_camera=Pose(rotation=start.imu_from_camera, position=np.zeros(3)),
            time_offset=start.time_offset,
            gravity=gravity * GRAVITY / np.linalg.norm(gravity),
            biases=biases,
        )

    def solve(self, trajectory: Trajectory, tell: Callable[[str], None]) -> Trajectory:
        damping = 1e-6
        equations = self._equations(trajectory)
        for number in range(MOST_STEPS):
            tell(f"all together, step {number + 1} of at most {MOST_STEPS}")
            while True:
                step, border_step = _solve(equations, damping)
                candidate = _moved(trajectory, step, border_step)
                then = self._equations(candidate)
                if then.cost <= equations.cost or damping > 1e6:
                    break
                damping *= 10.0
            if not then.cost <= equations.cost:
                break
            gain = equations.cost - then.cost
            trajectory, equations = candidate, then
            damping = max(damping * 0.1, 1e-9)
            if gain < 1e-7 * equations.cost:
                break
        return trajectory

    def estimate(self, trajectory: Trajectory, start: InertialStart) -> InertialEstimate:
        equations = self._equations(trajectory)
        reduced, slope, _ = _reduced(equations, 1e-9)
        known = np.delete(np.arange(len(reduced)), SCALE)
        covariance = np.zeros_like(reduced)
        covariance[np.ix_(known, known)] = np.linalg.inv(reduced[np.ix_(known, known)])
        sigma = np.sqrt(np.diag(covariance))
        nodes = covariance[BIASES:, BIASES:].reshape(self._nodes, 6, self._nodes, 6).mean(axis=(0, 2))
        # One step with the target's size unknown too: where it would go, and how sure.
        inverse = np.linalg.inv(reduced)
        return InertialEstimate(
            imu_from_camera=trajectory.imu_from_camera,
            time_offset=trajectory.time_offset,
            gravity_in_target=trajectory.gravity,
            gyro_bias=trajectory.biases[:, :3].mean(axis=0),
            accel_bias=trajectory.biases[:, 3:].mean(axis=0),
            bias_sigma=np.sqrt(np.diag(nodes)),
            rotation_sigma=sigma[TURN : TURN + 3],
            position_sigma=sigma[MOVE : MOVE + 3],
            time_offset_sigma=float(sigma[OFFSET]),
            position_covariance=covariance[MOVE : MOVE + 3, MOVE : MOVE + 3],
            corner_errors=equations.corner_errors * self._sigma,
            gyro_errors=equations.inertial_errors[:, :3],
            accel_errors=equations.inertial_errors[:, 3:],
            pictures=len(self._stamps),
            target_scale=1.0 - float(inverse[SCALE] @ slope),
            target_scale_sigma=float(np.sqrt(inverse[SCALE, SCALE])),
            start=start,
        )

    def _equations(self, trajectory: Trajectory) -> _Equations:
        size, border = CONTROL * len(trajectory.positions), BIASES + 6 * self._nodes
        band, across, dense = np.zeros((REACH, size)), np.zeros((size, border)), np.zeros((border, border))
        gradient, border_gradient = np.zeros(size), np.zeros(border)
        inertial_errors, corner_errors = np.empty((len(self._times), 6)), np.empty((len(self._table), 2))
        sums = (band, across, dense, gradient, border_gradient)
        spline = (blending(), self._interval, trajectory.rotations, trajectory.positions)
        samples = (self._times, self._rates, self._forces, self._sigmas)
        add_inertia(
            *spline, trajectory.gravity, trajectory.biases, self._node_interval, *samples, *sums, inertial_errors
        )
        cost = 0.5 * float((inertial_errors**2).sum())
        rig, table = self._rig, self._table
        cost += add_pictures(
            *spline,
            trajectory.imu_from_camera.rotation,
            trajectory.imu_from_camera.position,
            trajectory.time_offset,
            self._stamps,
            self._first_corner,
            rig.model_numbers,
            rig.intrinsics,
            rig.rotations,
            rig.positions,
            table.eye,
            table.point,
            table.pixel,
            self._sigma,
            BEND,
            *sums,
            corner_errors,
        )
        cost += self._add_knowledge(trajectory, dense, border_gradient)
        return _Equations(*sums, cost=cost, inertial_errors=inertial_errors, corner_errors=corner_errors)

    def _add_knowledge(self, trajectory: Trajectory, dense: Array, gradient: Array) -> float:
        """Gravity's length, and biases that wander no faster than the IMU's file says."""
        length = float(np.linalg.norm(trajectory.gravity))
        along = trajectory.gravity / length / GRAVITY_SIGMA
        error = (length - GRAVITY) / GRAVITY_SIGMA
        dense[PULL : PULL + 3, PULL : PULL + 3] += np.outer(along, along)
        gradient[PULL : PULL + 3] += along * error
        cost = 0.5 * error**2
        inverse = 1.0 / self._walk**2
        for node in range(self._nodes - 1):
            change = trajectory.biases[node + 1] - trajectory.biases[node]
            cost += 0.5 * float((change**2 * inverse).sum())
            one, two = (slice(BIASES + 6 * k, BIASES + 6 * k + 6) for k in (node, node + 1))
            gradient[one] -= change * inverse
            gradient[two] += change * inverse
            for a, b, sign in ((one, one, 1.0), (two, two, 1.0), (one, two, -1.0), (two, one, -1.0)):
                dense[a, b] += sign * np.diag(inverse)
        # A bias far outside of what such sensors have; keeps the equations regular where nothing moves.
        loose = np.repeat([1.0 / 0.5**2, 1.0 / 2.0**2], 3)
        first = slice(BIASES, BIASES + 6)
        gradient[first] += loose * trajectory.biases[0]
        dense[first, first] += np.diag(loose)
        return cost + 0.5 * float((loose * trajectory.biases[0] ** 2).sum())


@dataclass(frozen=True, slots=True)
class _Equations:
    band: Array
    across: Array
    dense: Array
    gradient: Array
    border_gradient: Array
    cost: float
    inertial_errors: Array
    corner_errors: Array


def _reduced(equations: _Equations, damping: float) -> tuple[Array, Array, Array]:
    """The border's equations without the spline (Schur complement), its gradient, and the band's solved columns."""
    band = equations.band.copy()
    band[0] += damping * np.maximum(band[0], 1e-6)
    factor = cholesky_banded(band, lower=True, overwrite_ab=True, check_finite=False)
    columns = np.concatenate([equations.across, equations.gradient[:, None]], axis=1)
    solved = cho_solve_banded((factor, True), columns, check_finite=False)
    reduced = equations.dense - equations.across.T @ solved[:, :-1]
    reduced = 0.5 * (reduced + reduced.T)
    reduced[np.diag_indices_from(reduced)] += damping * np.diag(equations.dense) + 1e-12
    return reduced, equations.border_gradient - equations.across.T @ solved[:, -1], solved


def _solve(equations: _Equations, damping: float) -> tuple[Array, Array]:
    """Steps of the spline's columns and of the border's; the target's size is taken as given."""
    reduced, gradient, solved = _reduced(equations, damping)
    known = np.delete(np.arange(len(reduced)), SCALE)
    scale = 1.0 / np.sqrt(np.maximum(np.diag(reduced)[known], 1e-12))
    step = np.zeros(len(reduced))
    step[known] = -scale * np.linalg.solve(
        reduced[np.ix_(known, known)] * scale[:, None] * scale, gradient[known] * scale
    )
    return -solved[:, -1] - solved[:, :-1] @ step, step


def _moved(trajectory: Trajectory, step: Array, border: Array) -> Trajectory:
    by_control = step.reshape(-1, 6)
    turns = np.array([rotation_exp(turn) for turn in by_control[:, :3]])
    place = trajectory.imu_from_camera
    return replace(
        trajectory,
        rotations=trajectory.rotations @ turns,
        positions=trajectory.positions + by_control[:, 3:],
        imu_from_camera=Pose(
            rotation=place.rotation @ rotation_exp(border[TURN : TURN + 3]),
            position=place.position + border[MOVE : MOVE + 3],
        ),
        time_offset=trajectory.time_offset + float(border[OFFSET]),
        gravity=trajectory.gravity + border[PULL : PULL + 3],
        biases=trajectory.biases + border[BIASES:].reshape(-1, 6),
    )


def _rotations_at(times: Array, rotations: Array, wanted: Array) -> Array:
    """Rotations (n, 3, 3) in between, at constant rate from one to the next."""
    begin = np.clip(np.searchsorted(times, wanted, side="right") - 1, 0, len(times) - 2)
    steps = np.array([rotation_log(a.T @ b) for a, b in pairwise(rotations)])
    late = np.clip((wanted - times[begin]) / (times[begin + 1] - times[begin]), 0.0, 1.0)
    return np.array([rotations[k] @ rotation_exp(share * steps[k]) for k, share in zip(begin, late, strict=True)])
