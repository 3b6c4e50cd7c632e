"""The robot's own legs give no features, wherever they reach into a picture."""

import cv2
import numpy as np
import pytest
from scipy.optimize import least_squares

from robot_agent.evaluation.textured_ground import TexturedGround
from robot_agent.odometry.front_end import FrontEnd
from robot_agent.odometry.own_legs import COARSE, OwnLegs, hidden
from robot_agent.vision.camera import StereoCalibration
from robot_agent.vision.distortion import project
from weaver_shared.config.odometry import FrontEndConfig
from weaver_shared.leg_batch import LegBatch
from weaver_shared.messages import StereoFrame
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.transforms import Pose

RADIUS = 0.02


def _reaching_ahead(calibration: StereoCalibration) -> OwnLegs:
    """One leg from behind the left eye's right edge to before its middle."""
    hip, knee, foot = [0.05, 0.15, -0.1], [0.12, 0.05, 0.25], [0.0, 0.02, 0.45]
    joints = calibration.left.body_from_camera.transform(np.array([hip, knee, foot]))
    return OwnLegs(joint_in_body=joints[None], radius=RADIUS)


def test_all_of_a_leg_is_covered_and_little_else(calibration: StereoCalibration) -> None:
    legs, eye = _reaching_ahead(calibration), calibration.left
    cover = legs.cover(eye)
    assert cover is not None
    knee, foot = legs.joint_in_body[0, 1:]
    share, random = np.linspace(0.0, 1.0, 200)[:, None], np.random.default_rng(1)
    within = random.normal(0.0, 1.0, (200, 3))
    within *= RADIUS / np.linalg.norm(within, axis=1, keepdims=True)
    skin = knee + share * (foot - knee) + within
    pixels = project(eye, eye.body_from_camera.inverse().transform(skin))
    assert hidden(cover, pixels).all()
    assert 0.02 < cover.mean() < 0.35
    assert not hidden(cover, np.array([[60.0, 60.0], [60.0, 420.0]])).any()


def test_legs_out_of_sight_cover_nothing(robot: RobotDescription, calibration: StereoCalibration) -> None:
    joints = _standing_joints(robot)
    legs = OwnLegs.of(
        robot,
        LegBatch(
            stamp_ns=np.array([0]),
            joint_position=joints[None],
            joint_torque=np.zeros((1, robot.joint_count)),
            foot_contact=np.ones((1, 6), dtype=np.bool_),
        ),
    )
    assert legs is not None
    assert legs.joint_in_body[:, -1] == pytest.approx(robot.stance_in_body, abs=0.02)
    assert legs.cover(calibration.left) is None
    assert OwnLegs.of(robot, LegBatch.empty()) is None
    behind = OwnLegs(joint_in_body=calibration.left.body_from_camera.transform(-np.eye(3))[None], radius=RADIUS)
    assert behind.cover(calibration.left) is None


def _standing_joints(robot: RobotDescription) -> np.ndarray:
    def miss(joints: np.ndarray) -> np.ndarray:
        return np.asarray((feet_in_body(robot, joints) - robot.stance_in_body).ravel())

    return np.asarray(least_squares(miss, np.full(robot.joint_count, 0.1)).x)


def test_a_leg_full_of_corners_is_not_followed(calibration: StereoCalibration) -> None:
    legs = _reaching_ahead(calibration)
    body = Pose.of([0.0, 0.0, 0.165])
    frame = _with_leg(TexturedGround(calibration, seed=2).look(0, 0, body), calibration, legs)
    covers = [legs.cover(eye) for eye in (calibration.left, calibration.right)]
    for shown in (None, legs):
        front_end = FrontEnd(calibration, FrontEndConfig())
        for _ in range(2):
            tracks = front_end.step(frame, Pose.identity(), shown)
        on_leg = []
        for e, eye in enumerate((calibration.left, calibration.right)):
            seen = (tracks.seen & (1 << e)) > 0
            rays = np.column_stack([tracks.observation[seen, e], np.ones(int(seen.sum()))])
            on_leg.append(int(hidden(covers[e], project(eye, rays)).sum()))
        if shown is None:
            assert on_leg[0] > 5
        else:
            assert on_leg == [0, 0]
            assert tracks.number > 60


def _with_leg(frame: StereoFrame, calibration: StereoCalibration, legs: OwnLegs) -> StereoFrame:
    """The leg painted over the pictures as a random checkerboard."""
    random = np.random.default_rng(3)
    pictures = []
    for picture, eye in ((frame.left, calibration.left), (frame.right, calibration.right)):
        cover = legs.cover(eye)
        assert cover is not None
        there = cv2.resize(cover, None, fx=COARSE, fy=COARSE, interpolation=cv2.INTER_NEAREST)[
            : eye.height, : eye.width
        ]
        checks = random.integers(0, 2, (eye.height // 8, eye.width // 8), dtype=np.uint8) * 255
        board = cv2.resize(checks, (eye.width, eye.height), interpolation=cv2.INTER_NEAREST)
        pictures.append(np.where(there > 0, board, picture))
    return StereoFrame(stamp_ns=frame.stamp_ns, sequence=frame.sequence, left=pictures[0], right=pictures[1])
