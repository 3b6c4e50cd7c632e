"""Bad pictures and bad inertia: the estimate says so, stays near the truth and comes back by itself."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from walking_motion import FRAME_NS, Walk, inertia

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.odometry import StereoInertialOdometry
from robot_agent.odometry.front_end import FrontEnd
from robot_agent.odometry.imu_stream import ImuStream
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import FailureConfig, FrontEndConfig, OdometryConfig
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.messages import ImuBatch, OdometryEstimate, OdometryQuality, StereoFrame
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose, rotation_exp

FRAMES = 90
GOOD, DEGRADED, LOST = OdometryQuality.GOOD, OdometryQuality.DEGRADED, OdometryQuality.LOST
Recording = list[tuple[StereoFrame, ImuBatch]]
BLACK = np.zeros((480, 640), dtype=np.uint8)


@pytest.fixture(scope="module")
def recording(robot: RobotDescription, calibration: StereoCalibration) -> Recording:
    walk, random = Walk(), np.random.default_rng(1)
    ground = TexturedGround(calibration, seed=2)
    bias = np.array([0.002, -0.003, 0.001]), np.array([0.01, 0.02, -0.02])
    return [
        (
            ground.look(k * FRAME_NS, k, walk.body(k * FRAME_NS * 1e-9)),
            inertia(walk, robot, (k - 1) * FRAME_NS, k * FRAME_NS, random, *bias),
        )
        for k in range(1, FRAMES + 1)
    ]


@pytest.fixture
def run(robot: RobotDescription, calibration: StereoCalibration) -> Callable[..., list[OdometryEstimate]]:
    def _run(recording: Recording, **failure: float) -> list[OdometryEstimate]:
        config = OdometryConfig(failure=FailureConfig.model_validate(failure))
        odometry = StereoInertialOdometry(
            calibration=calibration, imu=robot.imu, initial=Walk().body(0.0), config=config
        )
        estimates = [odometry.step(frame, batch) for frame, batch in recording]
        for e in estimates:
            for number in (e.position_in_world, e.wxyz, e.velocity_in_world, e.covariance):
                assert np.isfinite(number).all()
        return estimates

    return _run


def _error(estimate: OdometryEstimate) -> float:
    truth = Walk().body(estimate.stamp_ns * 1e-9)
    return float(np.linalg.norm(estimate.position_in_world - truth.position))


def _spoiled(recording: Recording, begin: int, end: int, spoil: Callable[[StereoFrame], StereoFrame]) -> Recording:
    return [(spoil(f) if begin <= n < end else f, batch) for n, (f, batch) in enumerate(recording)]


def test_clean_pictures_are_followed_to_millimetres(
    recording: Recording, run: Callable[..., list[OdometryEstimate]]
) -> None:
    estimates = run(recording)
    assert estimates[0].quality is OdometryQuality.INITIALISING
    assert all(e.quality is GOOD for e in estimates[12:])
    assert _error(estimates[-1]) < 0.008
    truth = Walk().body(estimates[-1].stamp_ns * 1e-9)
    assert estimates[-1].world_from_body.rotation == pytest.approx(truth.rotation, abs=0.01)


def test_poses_of_pictures_gone_by_are_corrected_as_long_as_they_are_in_the_window(
    recording: Recording, robot: RobotDescription, calibration: StereoCalibration
) -> None:
    odometry = StereoInertialOdometry(calibration=calibration, imu=robot.imu, initial=Walk().body(0.0))
    assert odometry.settled_poses == {}
    said = {frame.stamp_ns: odometry.step(frame, batch) for frame, batch in recording}
    settled = odometry.settled_poses
    assert max(settled) == recording[-1][0].stamp_ns
    assert settled[max(settled)].position == pytest.approx(said[max(settled)].position_in_world, abs=1e-9)
    changed = [np.linalg.norm(pose.position - said[stamp].position_in_world) for stamp, pose in settled.items()]
    assert max(changed) > 1e-5
    for stamp, pose in settled.items():
        assert np.linalg.norm(pose.position - Walk().body(stamp * 1e-9).position) < 0.008


def test_darkness_is_bridged_by_inertia(recording: Recording, run: Callable[..., list[OdometryEstimate]]) -> None:
    dark = _spoiled(recording, 50, 70, lambda f: replace(f, left=BLACK, right=BLACK))
    estimates = run(dark)
    assert all(e.quality is DEGRADED and "black" in e.reason for e in estimates[50:70])
    assert estimates[69].covariance[3, 3] > 4.0 * estimates[49].covariance[3, 3]
    assert estimates[-1].quality is GOOD
    assert _error(estimates[-1]) < 0.015


def test_long_darkness_is_a_loss_and_the_world_is_kept(
    recording: Recording, run: Callable[..., list[OdometryEstimate]]
) -> None:
    dark = _spoiled(recording, 40, 75, lambda f: replace(f, left=BLACK, right=BLACK))
    estimates = run(dark, blind_duration=1.0)
    assert estimates[70].quality is LOST
    assert "inertia alone" in estimates[70].reason
    assert estimates[75].quality is DEGRADED
    assert estimates[-1].quality is GOOD
    jumps = np.linalg.norm(np.diff([e.position_in_world for e in estimates], axis=0), axis=1)
    assert jumps.max() < 0.06
    assert _error(estimates[-1]) < 0.6


def test_one_eye_is_enough_for_a_while(recording: Recording, run: Callable[..., list[OdometryEstimate]]) -> None:
    one_eyed = _spoiled(recording, 50, 90, lambda f: replace(f, right=np.zeros((0, 0), dtype=np.uint8)))
    estimates = run(one_eyed)
    assert estimates[60].quality is DEGRADED
    assert "right picture missing" in estimates[60].reason
    assert _error(estimates[-1]) < 0.01


def test_dropped_pictures_do_no_harm(recording: Recording, run: Callable[..., list[OdometryEstimate]]) -> None:
    kept: Recording = []
    waiting: list[ImuBatch] = []
    for n, (frame, batch) in enumerate(recording):
        waiting.append(batch)
        if n % 5 != 3:
            kept.append((frame, ImuBatch.join(waiting)))
            waiting = []
    estimates = run(kept)
    assert estimates[-1].quality is GOOD
    assert _error(estimates[-1]) < 0.015


def test_repeated_and_late_pictures_are_named(recording: Recording, run: Callable[..., list[OdometryEstimate]]) -> None:
    frame, _ = recording[30]
    estimates = run([*recording[:40], (frame, ImuBatch.empty()), *recording[40:60]])
    assert estimates[40].quality is DEGRADED
    assert "out of order" in estimates[40].reason
    assert estimates[-1].quality is GOOD


def test_unusable_inertia_is_left_out_and_named(
    recording: Recording, run: Callable[..., list[OdometryEstimate]]
) -> None:
    spoiled: Recording = []
    for n, (frame, batch) in enumerate(recording):
        force = batch.specific_force_in_imu.copy()
        if n == 50:
            force[3] = np.nan
        if n == 55:
            force[2] = 1e4
        stamps = batch.stamp_ns[::-1].copy() if n == 60 else batch.stamp_ns
        spoiled.append((frame, replace(batch, specific_force_in_imu=force, stamp_ns=stamps)))
    estimates = run(spoiled)
    for n in (50, 55, 60):
        assert estimates[n].quality is DEGRADED
        assert "inertial samples" in estimates[n].reason
    assert estimates[-1].quality is GOOD
    assert _error(estimates[-1]) < 0.03


def test_a_gap_in_the_inertia_is_named_and_bridged(
    recording: Recording, run: Callable[..., list[OdometryEstimate]]
) -> None:
    estimates = run([(f, ImuBatch.empty() if 50 <= n < 53 else batch) for n, (f, batch) in enumerate(recording)])
    assert estimates[52].quality is DEGRADED
    assert "no inertial samples for" in estimates[52].reason
    assert estimates[-1].quality is GOOD
    assert _error(estimates[-1]) < 0.03


def test_a_saturated_sensor_is_named_and_survived(
    recording: Recording, run: Callable[..., list[OdometryEstimate]]
) -> None:
    spoiled: Recording = []
    for n, (frame, batch) in enumerate(recording):
        rate = batch.angular_velocity_in_imu.copy()
        if n == 55:
            rate[2:8, 1] = 20.0
        spoiled.append((frame, replace(batch, angular_velocity_in_imu=rate)))
    estimates = run(spoiled)
    assert estimates[55].quality is DEGRADED
    assert "6 inertial samples unusable" in estimates[55].reason
    assert estimates[-1].quality is GOOD
    assert _error(estimates[-1]) < 0.03


def test_a_blow_beyond_the_sensors_range_is_named_and_survived(
    recording: Recording, run: Callable[..., list[OdometryEstimate]]
) -> None:
    """A foot strikes: up and down again within two samples, of which the harder is beyond the range and left out."""
    struck = 60
    batch = recording[struck][1]
    force = batch.specific_force_in_imu.copy()
    force[3, 2] += 140.0
    force[4:6, 2] -= 70.0
    blow = [*recording[:struck], (recording[struck][0], replace(batch, specific_force_in_imu=force))]
    estimates = run([*blow, *recording[struck + 1 :]])
    assert "unusable" in estimates[struck].reason
    assert estimates[struck].quality is DEGRADED
    assert all(e.quality is GOOD for e in estimates[struck + 3 :])
    assert max(_error(e) for e in estimates[struck:]) < 0.03
    assert _error(estimates[-1]) < 0.01


def without(batch: ImuBatch, place: int, force: np.ndarray) -> ImuBatch:
    """A batch with other forces of which one sample was lost on its way."""
    kept = np.arange(batch.stamp_ns.size) != place
    return ImuBatch(
        stamp_ns=batch.stamp_ns[kept],
        angular_velocity_in_imu=batch.angular_velocity_in_imu[kept],
        specific_force_in_imu=force[kept],
    )


def test_a_sample_lost_while_a_foot_strikes_is_survived(
    recording: Recording, run: Callable[..., list[OdometryEstimate]]
) -> None:
    struck = 60
    frame, batch = recording[struck]
    force = batch.specific_force_in_imu.copy()
    force[3, 2] += 70.0
    force[4:6, 2] -= 35.0
    estimates = run([*recording[:struck], (frame, without(batch, 3, force)), *recording[struck + 1 :]])
    assert max(_error(e) for e in estimates[struck:]) < 0.03
    assert _error(estimates[-1]) < 0.01


def test_a_lost_sample_is_noticed_among_others_and_only_then(recording: Recording) -> None:
    for lost in (None, *range(1, 9)):
        stream = ImuStream(FailureConfig())
        for index, (frame, batch) in enumerate(recording[:12]):
            hit = index == 8 and lost is not None
            stream.add(without(batch, lost, batch.specific_force_in_imu) if hit else batch)
            assert stream.take_until(frame.stamp_ns).unmeasured == hit, (index, lost)


def test_features_are_found_again_after_a_wrong_prediction(
    recording: Recording, calibration: StereoCalibration
) -> None:
    front_end, before, known = FrontEnd(calibration, FrontEndConfig()), None, np.zeros(0)
    for k, (frame, _) in enumerate(recording[:50]):
        left = Walk().body(frame.stamp_ns * 1e-9) @ calibration.left.body_from_camera
        predicted = Pose.identity() if before is None else left.inverse() @ before
        wrong = Pose(rotation=predicted.rotation, position=predicted.position - np.array([0.0, 0.06, 0.0]))
        seen = front_end.step(frame, wrong if k >= 40 else predicted).identity
        if k >= 40:
            assert np.isin(seen, known).sum() > 0.6 * len(known)
        before, known = left, seen


@pytest.mark.parametrize("seconds", [100, -2])
def test_a_clock_that_jumps_is_named_and_the_world_is_kept(
    recording: Recording, run: Callable[..., list[OdometryEstimate]], seconds: int
) -> None:
    shift = seconds * 1_000_000_000
    jumped = [
        (replace(f, stamp_ns=f.stamp_ns + shift), replace(batch, stamp_ns=batch.stamp_ns + shift))
        if n >= 60
        else (f, batch)
        for n, (f, batch) in enumerate(recording)
    ]
    estimates = run(jumped)
    assert estimates[60].quality is DEGRADED
    assert "the clock jumped by" in estimates[60].reason
    assert estimates[-1].quality is GOOD
    steps = np.linalg.norm(np.diff([e.position_in_world for e in estimates], axis=0), axis=1)
    assert steps.max() < 0.06
    assert np.linalg.norm(estimates[-1].position_in_world - Walk().body(FRAMES * FRAME_NS * 1e-9).position) < 0.05


def test_pictures_black_from_the_beginning_are_never_called_good(
    recording: Recording, run: Callable[..., list[OdometryEstimate]]
) -> None:
    estimates = run(_spoiled(recording, 0, FRAMES, lambda f: replace(f, left=BLACK, right=BLACK)))
    assert GOOD not in {e.quality for e in estimates}
    assert "black" in estimates[40].reason


def test_eyes_that_do_not_fit_their_calibration_are_named(
    recording: Recording, robot: RobotDescription, calibration: StereoCalibration
) -> None:
    right = calibration.right
    nodded = replace(
        right,
        body_from_camera=right.body_from_camera @ Pose(rotation=rotation_exp([0.05, 0.0, 0.0]), position=np.zeros(3)),
    )
    odometry = StereoInertialOdometry(
        calibration=replace(calibration, right=nodded), imu=robot.imu, initial=Walk().body(0.0)
    )
    estimates = [odometry.step(frame, batch) for frame, batch in recording[:25]]
    assert estimates[-1].quality is DEGRADED
    assert "is their calibration right?" in estimates[-1].reason


def test_feet_carry_on_in_long_darkness_and_pictures_take_over_again(
    recording: Recording, robot: RobotDescription, calibration: StereoCalibration
) -> None:
    odometry = StereoInertialOdometry(calibration=calibration, imu=robot.imu, initial=Walk().body(0.0))
    footholds = np.array([[0.3, 0.3, 0.0], [0.3, -0.3, 0.0], [-0.2, 0.3, 0.0]])
    estimates = []
    for n, (frame, batch) in enumerate(_spoiled(recording, 40, 80, lambda f: replace(f, left=BLACK, right=BLACK))):
        stamps = np.arange(n * FRAME_NS, (n + 1) * FRAME_NS + 1, 10_000_000, dtype=np.int64)[int(n > 0) :]
        feet = np.array([Walk().body(float(stamp) * 1e-9).inverse().transform(footholds) for stamp in stamps])
        contacts = FootContacts(
            stamp_ns=stamps, foot_in_body=feet, sole_in_body=feet, touching=np.ones((len(stamps), 3), dtype=np.bool_)
        )
        estimates.append(odometry.step(frame, batch, contacts))
    assert all(e.quality is DEGRADED and "on inertia and feet" in e.reason for e in estimates[41:80])
    way_in_the_dark = float(np.linalg.norm(estimates[79].position_in_world - estimates[39].position_in_world))
    assert _error(estimates[79]) < _error(estimates[39]) + 0.03 * way_in_the_dark
    assert _error(estimates[79]) < 3.0 * np.sqrt(np.trace(estimates[79].covariance[3:, 3:]))
    assert estimates[-1].quality is GOOD


def test_a_start_in_motion_still_finds_gravity(
    recording: Recording, run: Callable[..., list[OdometryEstimate]]
) -> None:
    estimates = run(recording[32:])
    assert estimates[-1].quality is GOOD
    truth = Walk().body(estimates[-1].stamp_ns * 1e-9)
    tilt = estimates[-1].world_from_body.rotation[2] - truth.rotation[2]
    assert np.linalg.norm(tilt) < 0.02
    assert np.linalg.norm(estimates[-1].velocity_in_world[:2]) == pytest.approx(0.2, abs=0.05)
