"""What the vision pipeline hands from one stage to the next."""

from collections.abc import Mapping

import numpy as np
import pytest

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.loops import VisionLoop
from robot_agent.mapping import TerrainMap
from robot_agent.perception import FeltGround
from robot_agent.pipeline import FELT_LIFETIME_NS, VisionPipeline, VisionTick
from robot_agent.vision.camera import StereoCalibration
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.config.perception import PlaneMode
from weaver_shared.frames import GRAVITY
from weaver_shared.leg_batch import LegBatch
from weaver_shared.messages import AdaptationReport, ImuBatch, PerceptionOrder
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

FRAME_NS, SAMPLE_NS = 50_000_000, 5_000_000


class Standing:
    """A robot at rest over textured ground, and its vision."""

    def __init__(self, perceive_every: int) -> None:
        robot = load_robot("weaver")
        self._world_from_body = Pose(rotation=np.eye(3), position=np.array([0.0, 0.0, 0.165]))
        self._ground = TexturedGround(StereoCalibration.of_robot(robot), seed=2)
        self._pipeline = VisionPipeline(robot, self._world_from_body, perceive_every=perceive_every)
        self._at_rest = robot.imu.body_from_imu.rotation.T @ np.array([0.0, 0.0, GRAVITY])
        self._frames = 0

    def judge_ground(self, mode: PlaneMode) -> None:
        self._pipeline.judge_ground(mode)

    def step(self, *, closely: bool = False, legs: LegBatch | None = None) -> VisionTick:
        self._frames += 1
        end_ns = self._frames * FRAME_NS
        stamps = np.arange(end_ns - FRAME_NS + SAMPLE_NS, end_ns + 1, SAMPLE_NS)
        imu = ImuBatch(
            stamp_ns=stamps,
            angular_velocity_in_imu=np.zeros((len(stamps), 3)),
            specific_force_in_imu=np.tile(self._at_rest, (len(stamps), 1)),
        )
        frame = self._ground.look(end_ns, self._frames, self._world_from_body)
        return self._pipeline.step(frame, imu, legs or LegBatch.empty(), closely=closely)


def test_the_map_is_told_how_odometry_sees_earlier_pictures_now(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Mapping[int, Pose]] = []
    monkeypatch.setattr(TerrainMap, "follow", lambda _, corrected: bool(told.append(corrected)))
    standing = Standing(perceive_every=1)
    for _ in range(24):
        standing.step()
    assert told[0] == {}
    assert len(told[-1]) > 1
    assert max(told[-1]) == 24 * FRAME_NS


def test_a_close_look_is_taken_of_a_picture_that_would_be_left_out() -> None:
    standing = Standing(perceive_every=2)
    for _ in range(24):
        tick = standing.step()
        assert tick.look is None
    left_out = standing.step(closely=True)
    assert left_out.terrain is not None
    assert left_out.look is not None
    assert left_out.look.cells > 2000
    assert left_out.look.sigma < 0.002
    assert standing.step().look is None


def test_features_are_shown_of_the_pictures_that_people_see_where_they_were_followed() -> None:
    standing = Standing(perceive_every=2)
    shown = [tick.features for tick in (standing.step() for _ in range(12))]
    assert [number + 1 for number, features in enumerate(shown) if features is not None] == [1, 2, 4, 6, 8, 10, 12]
    features = shown[11]
    assert features is not None
    assert features.stamp_ns == 12 * FRAME_NS
    assert len(features.both_eyes) > 50
    assert ((features.both_eyes >= 0) & (features.both_eyes < [features.width, features.height])).all()


def test_the_ground_is_judged_as_ordered_from_the_next_picture_on() -> None:
    standing = Standing(perceive_every=1)
    first = standing.step()
    standing.judge_ground("paper")
    second = standing.step()
    assert [tick.report.perception for tick in (first, second) if tick.report] == ["robust", "paper"]
    assert [tick.terrain.mode for tick in (first, second) if tick.terrain] == ["robust", "paper"]


def test_the_vision_loop_judges_the_ground_as_the_walk_loop_says() -> None:
    bus, robot = MemoryBus(), load_robot("weaver")
    told: list[AdaptationReport] = []
    bus.subscribe("w", topics.DESIRED_GAIT, lambda _id, _key, report: told.append(report))
    loop = VisionLoop(robot_id="w", robot=robot, bus=bus)
    pose = Pose(rotation=np.eye(3), position=np.array([0.0, 0.0, 0.165]))
    ground = TexturedGround(StereoCalibration.of_robot(robot), seed=2)
    loop.begin(pose)
    for number in range(1, 7):
        loop.step(ground.look(number * FRAME_NS, number, pose))
        if number == 2:
            bus.publish("w", topics.PERCEPTION, PerceptionOrder(stamp_ns=0, mode="paper"))
    assert [report.perception for report in told] == ["robust", "paper", "paper"]


def test_a_picture_without_a_reading_of_the_legs_keeps_what_was_felt(monkeypatch: pytest.MonkeyPatch) -> None:
    felt: list[int] = []
    step = FeltGround.step
    monkeypatch.setattr(FeltGround, "step", lambda self, sense: felt.append(sense.stamp_ns) or step(self, sense))
    robot, standing = load_robot("weaver"), Standing(perceive_every=2)
    for tick in range(40):
        told = LegBatch(
            stamp_ns=np.array([(tick + 1) * FRAME_NS]),
            joint_position=np.zeros((1, robot.joint_count)),
            joint_torque=np.zeros((1, robot.joint_count)),
            foot_contact=np.ones((1, robot.leg_count), dtype=np.bool_),
        )
        standing.step(legs=told if tick < 20 else None)
    silent = [stamp_ns for stamp_ns in felt if stamp_ns > 20 * FRAME_NS]
    assert felt[:20] == [(tick + 1) * FRAME_NS for tick in range(20)]
    assert silent[0] == 20 * FRAME_NS + FELT_LIFETIME_NS  # from then on the feet are taken for gone
