"""A body that sways on one spot neither stands still nor gets away from it, and its features stay what they are."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest
from walking_motion import FRAME_NS, REST, Walk, inertia

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.odometry import StereoInertialOdometry
from robot_agent.odometry.front_end import FrontEnd
from robot_agent.odometry.landmarks import LEFT
from robot_agent.odometry.seen_motion import SeenMotion
from robot_agent.odometry.tracks import Tracks
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.odometry import FrontEndConfig
from weaver_shared.messages import StereoFrame
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose, rotation_from_rpy

SWAYS, PERIOD, CREEP = 8, 1.5, 0.85
FRAMES = round((REST + SWAYS * PERIOD) / (FRAME_NS * 1e-9))


@dataclass(frozen=True)
class Sway(Walk):
    """Creeps forward and down for most of a period, too slowly to be seen between two pictures; is thrown back then."""

    def body(self, t: float) -> Pose:
        phase = max(0.0, t - REST) / PERIOD % 1.0
        way = phase / CREEP if phase < CREEP else (1.0 - phase) / (1.0 - CREEP)
        lean = 0.5 * (1.0 - np.cos(np.pi * way))
        return Pose(
            rotation=rotation_from_rpy(0.0, 0.005 * lean, 0.0),
            position=np.array([0.005 * lean, 0.0, 0.165 - 0.003 * lean]),
        )


@pytest.fixture(scope="module")
def pictures(calibration: StereoCalibration) -> list[StereoFrame]:
    ground = TexturedGround(calibration, seed=4)
    return [ground.look(k * FRAME_NS, k, Sway().body(k * FRAME_NS * 1e-9)) for k in range(1, FRAMES + 1)]


def test_creeping_again_and_again_leads_nowhere(
    pictures: list[StereoFrame], robot: RobotDescription, calibration: StereoCalibration
) -> None:
    walk, random = Sway(), np.random.default_rng(5)
    odometry = StereoInertialOdometry(calibration=calibration, imu=robot.imu, initial=walk.body(0.0))
    for frame in pictures:
        batch = inertia(walk, robot, frame.stamp_ns - FRAME_NS, frame.stamp_ns, random)
        estimate = odometry.step(frame, batch)
    truth = walk.body(estimate.stamp_ns * 1e-9)
    assert np.linalg.norm(estimate.position_in_world - truth.position) < 0.0015
    turned = estimate.world_from_body.rotation.T @ truth.rotation
    assert np.arccos(np.clip((np.trace(turned) - 1.0) / 2.0, -1.0, 1.0)) < np.deg2rad(0.1)


def test_features_do_not_wander_while_the_view_is_the_same(
    pictures: list[StereoFrame], calibration: StereoCalibration
) -> None:
    front_end, first, last = FrontEnd(calibration, FrontEndConfig()), {}, {}
    period, before = round(PERIOD / (FRAME_NS * 1e-9)), None
    for frame in pictures:
        left = Sway().body(frame.stamp_ns * 1e-9) @ calibration.left.body_from_camera
        tracks = front_end.step(frame, Pose.identity() if before is None else left.inverse() @ before)
        before = left
        if frame.sequence % period == 0:
            last = dict(zip(tracks.identity.tolist(), tracks.observation[:, 0], strict=True))
            first = first or last
    common = sorted(first.keys() & last.keys())
    assert len(common) > 60
    wandered = calibration.left.fx * np.array([last[k] - first[k] for k in common])
    assert np.abs(np.median(wandered, axis=0)).max() < 0.02
    assert np.median(np.linalg.norm(wandered, axis=1)) < 0.1


def sighted(shift: float, identities: range = range(20)) -> Tracks:
    observation = np.zeros((len(identities), 2, 2))
    observation[:, 0, 0] = shift + 0.01 * np.array(identities)
    seen = np.full(len(identities), LEFT, dtype=np.uint8)
    return Tracks(identity=np.array(identities), observation=observation, seen=seen, flow=0.0, problem="")


def stamps() -> Iterator[int]:
    return (k * FRAME_NS for k in range(1000))


def test_a_slow_creep_is_seen_over_a_while() -> None:
    motion, told = SeenMotion(0.8, focal_length=400.0), 0.0
    for k, stamp_ns in zip(range(40), stamps(), strict=False):
        told = motion.step(stamp_ns, sighted(0.0002 * k))  # 0.08 px a picture
    assert told == pytest.approx(16 * 0.08)


def test_a_view_that_trembles_has_not_moved() -> None:
    motion = SeenMotion(0.8, focal_length=400.0)
    for k, stamp_ns in zip(range(40), stamps(), strict=False):
        assert not motion.step(stamp_ns, sighted(0.0002 * (k % 2))) > 0.1


def test_features_that_are_gone_tell_of_motion_and_darkness_of_nothing() -> None:
    motion = SeenMotion(0.8, focal_length=400.0)
    motion.step(0, sighted(0.0))
    assert motion.step(FRAME_NS, sighted(0.0, range(100, 120))) == float("inf")
    dark = SeenMotion(0.8, focal_length=400.0)
    assert all(np.isnan(dark.step(k * FRAME_NS, Tracks.none("black"))) for k in range(5))


def test_a_view_thrown_back_to_where_it_was_has_moved() -> None:
    motion = SeenMotion(0.8, focal_length=400.0)
    for k, stamp_ns in zip(range(80), stamps(), strict=False):
        told = motion.step(stamp_ns, sighted(0.0002 * (k % 13)))
        assert k < 16 or told > 0.5
