"""The robustness study's troubles, done to a made walk: said in words, lived through, and over when they are over."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from walking_motion import FRAME_NS, Walk, inertia

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.odometry import StereoInertialOdometry
from robot_agent.vision.camera import StereoCalibration
from sim_agent.picture_troubles import BareGround, Moment, PasserBy, Trouble, blurred, dark, dropped, one_eyed
from weaver_shared.messages import ImuBatch, OdometryEstimate, OdometryQuality, StereoFrame
from weaver_shared.robots import RobotDescription

FRAMES, BEGIN, END = 80, 40, 65
Suffered = Callable[[Trouble], list[OdometryEstimate]]


def swapped(frame: StereoFrame, _: Moment) -> StereoFrame:
    return replace(frame, left=frame.right, right=frame.left)


@pytest.fixture(scope="module")
def recording(robot: RobotDescription, calibration: StereoCalibration) -> list[tuple[StereoFrame, ImuBatch]]:
    walk, random, ground = Walk(), np.random.default_rng(1), TexturedGround(calibration, seed=2)
    return [
        (
            ground.look(k * FRAME_NS, k, walk.body(k * FRAME_NS * 1e-9)),
            inertia(walk, robot, (k - 1) * FRAME_NS, k * FRAME_NS, random),
        )
        for k in range(1, FRAMES + 1)
    ]


@pytest.fixture
def suffered(
    recording: list[tuple[StereoFrame, ImuBatch]], robot: RobotDescription, calibration: StereoCalibration
) -> Suffered:
    def _suffered(trouble: Trouble) -> list[OdometryEstimate]:
        odometry = StereoInertialOdometry(calibration=calibration, imu=robot.imu, initial=Walk().body(0.0))
        random = np.random.default_rng(3)
        place = Walk().body(BEGIN * FRAME_NS * 1e-9).transform(np.array([[0.6, 0.0, 0.0]]))[0, :2]
        estimates, waiting = [], []
        for n, (frame, batch) in enumerate(recording):
            waiting.append(batch)
            shown: StereoFrame | None = frame
            if BEGIN <= n < END:
                body = Walk().body(frame.stamp_ns * 1e-9)
                seconds = (n - BEGIN) * FRAME_NS * 1e-9
                shown = trouble(frame, Moment(seconds=seconds, world_from_body=body, place=place, random=random))
            if shown is not None:
                estimates.append(odometry.step(shown, ImuBatch.join(waiting)))
                waiting = []
        for e in estimates:
            assert np.isfinite(np.concatenate([e.position_in_world, e.wxyz, e.covariance.ravel()])).all()
        return estimates

    return _suffered


def _error(estimate: OdometryEstimate) -> float:
    truth = Walk().body(estimate.stamp_ns * 1e-9)
    return float(np.linalg.norm(estimate.position_in_world - truth.position))


@pytest.mark.parametrize(
    ("name", "words", "most"),
    [
        ("dark", "black", 0.05),
        ("one eye", "right picture missing", 0.01),
        ("dropped", "", 0.01),
        ("blurred", "", 0.03),
        ("bare ground", "", 0.03),
        ("passer-by", "", 0.03),
        ("swapped", "eyes agree on", 0.05),
    ],
)
def test_a_trouble_is_lived_through(
    suffered: Suffered, calibration: StereoCalibration, name: str, words: str, most: float
) -> None:
    troubles: dict[str, Trouble] = {
        "dark": dark,
        "one eye": one_eyed,
        "dropped": dropped,
        "blurred": blurred,
        "bare ground": BareGround(calibration, side=0.5),
        "passer-by": PasserBy(calibration),
        "swapped": swapped,
    }
    estimates = suffered(troubles[name])
    meanwhile = [e for e in estimates if BEGIN * FRAME_NS < e.stamp_ns <= END * FRAME_NS]
    assert any(words in e.reason for e in meanwhile)
    if words:
        assert all(e.quality is not OdometryQuality.GOOD for e in meanwhile)
    assert estimates[-1].quality is OdometryQuality.GOOD
    assert _error(estimates[-1]) < most
