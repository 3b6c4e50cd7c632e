"""What the vision pipeline hands from one stage to the next."""

from collections.abc import Mapping

import numpy as np
import pytest

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.mapping import TerrainMap
from robot_agent.pipeline import VisionPipeline
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.frames import GRAVITY
from weaver_shared.leg_batch import LegBatch
from weaver_shared.messages import ImuBatch
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose

FRAME_NS, SAMPLE_NS = 50_000_000, 5_000_000


def test_the_map_is_told_how_odometry_sees_earlier_pictures_now(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[Mapping[int, Pose]] = []
    monkeypatch.setattr(TerrainMap, "follow", lambda _, corrected: bool(told.append(corrected)))
    robot = load_robot("weaver")
    world_from_body = Pose(rotation=np.eye(3), position=np.array([0.0, 0.0, 0.165]))
    ground = TexturedGround(StereoCalibration.of_robot(robot), seed=2)
    pipeline = VisionPipeline(robot, world_from_body, perceive_every=1)
    at_rest = robot.imu.body_from_imu.rotation.T @ np.array([0.0, 0.0, GRAVITY])
    for k in range(1, 25):
        stamps = np.arange((k - 1) * FRAME_NS + SAMPLE_NS, k * FRAME_NS + 1, SAMPLE_NS)
        imu = ImuBatch(
            stamp_ns=stamps,
            angular_velocity_in_imu=np.zeros((len(stamps), 3)),
            specific_force_in_imu=np.tile(at_rest, (len(stamps), 1)),
        )
        pipeline.step(ground.look(k * FRAME_NS, k, world_from_body), imu, LegBatch.empty())
    assert told[0] == {}
    assert len(told[-1]) > 1
    assert max(told[-1]) == 24 * FRAME_NS
