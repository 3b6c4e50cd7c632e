"""A robot that stands up before its odometry has found gravity begins as high as its legs have lifted it."""

from dataclasses import dataclass

import numpy as np
import pytest
from walking_motion import FRAME_NS, Walk, inertia

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.odometry import StereoInertialOdometry
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.messages import OdometryEstimate, OdometryQuality
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

FOOTHOLDS = np.array([[0.3, 0.3, 0.0], [0.0, 0.35, 0.0], [-0.3, 0.3, 0.0], [0.3, -0.3, 0.0], [-0.3, -0.3, 0.0]])
TICK_NS = 10_000_000
FRAMES = 44
LOW, HIGH = 0.11, 0.165  # m
BEGIN, END = 0.2, 1.8  # s
GYRO_BIAS, ACCEL_BIAS = np.array([0.004, -0.006, 0.008]), np.array([0.01, 0.02, -0.02])


@dataclass(frozen=True)
class Rise(Walk):
    """Straight up, and a little askew on the way."""

    def body(self, t: float) -> Pose:
        share = min(max((t - BEGIN) / (END - BEGIN), 0.0), 1.0)
        smooth = share * share * (3.0 - 2.0 * share)
        return Pose.of([0.0, 0.0, LOW + (HIGH - LOW) * smooth], [1.0, 0.02 * np.sin(np.pi * smooth), 0.0, 0.0])


def _felt(begin_ns: int, end_ns: int) -> FootContacts:
    stamps = np.arange(begin_ns + TICK_NS, end_ns + 1, TICK_NS, dtype=np.int64)
    feet = np.array([Rise().body(stamp * 1e-9).inverse().transform(FOOTHOLDS) for stamp in stamps])
    return FootContacts(
        stamp_ns=stamps, foot_in_body=feet, sole_in_body=feet, touching=np.ones(feet.shape[:2], dtype=np.bool_)
    )


def _estimates(robot: RobotDescription, calibration: StereoCalibration, *, felt: bool) -> list[OdometryEstimate]:
    rise, random = Rise(), np.random.default_rng(1)
    ground = TexturedGround(calibration, seed=2)
    initial = Pose(rotation=np.eye(3), position=rise.body(FRAME_NS * 1e-9).position)
    odometry = StereoInertialOdometry(calibration=calibration, imu=robot.imu, initial=initial)
    estimates = []
    for k in range(1, FRAMES + 1):
        begin, end = (k - 1) * FRAME_NS, k * FRAME_NS
        frame = ground.look(end, k, rise.body(end * 1e-9))
        samples = inertia(rise, robot, begin, end, random, GYRO_BIAS, ACCEL_BIAS)
        estimates.append(odometry.step(frame, samples, _felt(begin, end) if felt else None))
    return estimates


def _off(estimate: OdometryEstimate) -> float:
    truth = Rise().body(estimate.stamp_ns * 1e-9)
    return float(np.linalg.norm(estimate.position_in_world - truth.position))


def test_the_height_gained_while_gravity_is_sought_is_kept(
    robot: RobotDescription, calibration: StereoCalibration
) -> None:
    estimates = _estimates(robot, calibration, felt=True)
    waiting = [e for e in estimates if e.quality is OdometryQuality.INITIALISING]
    gained = Rise().body(waiting[-1].stamp_ns * 1e-9).position[2] - LOW
    assert gained > 0.02  # gravity was found on the way up
    assert max(_off(e) for e in waiting) < 0.002
    assert estimates[-1].quality is OdometryQuality.GOOD
    assert _off(estimates[-1]) < 0.003
    assert estimates[-1].world_from_body.yaw == pytest.approx(0.0, abs=0.003)


def test_without_feet_it_begins_where_it_was_put(robot: RobotDescription, calibration: StereoCalibration) -> None:
    estimates = _estimates(robot, calibration, felt=False)
    waiting = [e for e in estimates if e.quality is OdometryQuality.INITIALISING]
    for estimate in waiting:
        assert estimate.position_in_world == pytest.approx(waiting[0].position_in_world, abs=1e-9)
