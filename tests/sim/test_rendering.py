"""Pictures show the world that physics walks on, sharply enough to track, and the same every time."""

import hashlib
from collections.abc import Iterator

import cv2
import numpy as np
import pytest

from sim_agent.model import sitting_joints
from sim_agent.rendering import Observer, StereoRenderer
from sim_agent.rendering.graphics import open_context
from sim_agent.rendering.stereo import OpenGlPair
from sim_agent.worlds import World, make_world
from weaver_shared.errors import ResourceError
from weaver_shared.messages import SceneState
from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.transforms import Pose, rotation_from_rpy, wxyz_from_rotation


def _opengl_missing() -> str:
    try:
        open_context().release()
    except ResourceError as error:
        return str(error)
    return ""


MISSING = _opengl_missing()
needs_opengl = pytest.mark.skipif(bool(MISSING), reason=MISSING or "OpenGL works")


def scene_at(robot: RobotDescription, world: World, x: float, *, tilt: tuple = (0.0, 0.0, 0.0)) -> SceneState:
    height = float(world.elevation(x, 0.0)) + robot.clearance
    return SceneState(
        stamp_ns=0,
        position_in_world=np.array([x, 0.0, height]),
        wxyz=wxyz_from_rotation(rotation_from_rpy(*tilt)),
        joint_position=sitting_joints(robot),
    )


@pytest.fixture(scope="module")
def testbed() -> World:
    return make_world("testbed", 1)


@pytest.fixture(scope="module")
def pair(testbed: World) -> Iterator[OpenGlPair]:
    drawn = OpenGlPair(load_robot(), testbed)
    yield drawn
    drawn.close()


@pytest.fixture(scope="module")
def renderer(testbed: World) -> Iterator[StereoRenderer]:
    drawn = StereoRenderer(load_robot(), testbed, 1)
    yield drawn
    drawn.close()


def seen_points(robot: RobotDescription, scene: SceneState, depth: np.ndarray) -> np.ndarray:
    """World coordinates (height, width, 3) of what each pixel of the left eye shows."""
    fx, fy, cx, cy = robot.camera.intrinsics
    rows, columns = np.mgrid[0 : robot.camera.height, 0 : robot.camera.width]
    left = depth[:, : robot.camera.width]
    optical = np.stack([(columns - cx) / fx * left, (rows - cy) / fy * left, left], axis=-1)
    return (scene.world_from_body @ robot.camera.body_from_left).transform(optical)


@needs_opengl
@pytest.mark.parametrize("name", ["testbed", "outdoor", "stairs"])
def test_what_a_pixel_shows_lies_on_the_true_elevation(robot: RobotDescription, name: str) -> None:
    world = make_world(name, 1)
    drawn = OpenGlPair(robot, world)
    scene = scene_at(robot, world, 1.2 if name == "outdoor" else 3.2, tilt=(0.1, -0.05, 0.2))
    depth = drawn.depth(scene)
    drawn.close()
    points = seen_points(robot, scene, depth)[::6, ::6]
    near = (depth[::6, : robot.camera.width : 6] < 2.0) & (points[..., 0] > scene.position_in_world[0] + 0.6)
    error = np.abs(points[..., 2] - world.elevation(points[..., 0], points[..., 1]))[near]
    assert near.sum() > 800
    assert np.median(error) < 5e-4
    # Upright faces show points under the top of their edge; nothing may float.
    assert np.percentile(error, 70) < 2e-3
    around = [world.elevation(points[..., 0] + dx, points[..., 1] + dy) for dx in (-2e-3, 2e-3) for dy in (-2e-3, 2e-3)]
    assert np.percentile((points[..., 2] - np.max(around, axis=0))[near], 99) < 2e-3


@needs_opengl
def test_disparity_is_focal_length_times_baseline_over_depth(
    robot: RobotDescription, testbed: World, pair: OpenGlPair
) -> None:
    scene = scene_at(robot, testbed, 0.0)
    both = pair.draw(scene).copy()
    depth = pair.depth(scene)[:, : robot.camera.width]
    left, right = both[:, : robot.camera.width], both[:, robot.camera.width :]
    corners = cv2.goodFeaturesToTrack(left[100:400, 200:600], 150, 0.01, 8).reshape(-1, 2)
    corners = corners + np.array([200, 100])
    columns, rows = corners.round().astype(int).T
    expected = robot.camera.focal_length * robot.camera.baseline / depth[rows, columns]
    guess = (corners - np.column_stack([expected, np.zeros(len(expected))])).astype(np.float32)
    found, status, _ = cv2.calcOpticalFlowPyrLK(
        left, right, corners.astype(np.float32), guess.copy(), flags=cv2.OPTFLOW_USE_INITIAL_FLOW
    )
    error = np.linalg.norm(found - guess, axis=1)[status.ravel() == 1]
    assert error.size > 100
    assert np.median(error) < 0.3


@needs_opengl
@pytest.mark.parametrize("x", [0.5, 3.0, 4.2])
def test_corners_can_be_tracked_to_a_fraction_of_a_pixel(
    robot: RobotDescription, testbed: World, pair: OpenGlPair, renderer: StereoRenderer, x: float
) -> None:
    scenes = [scene_at(robot, testbed, x), scene_at(robot, testbed, x + 0.015, tilt=(0.01, 0.008, 0.01))]
    frames = [renderer.render(scene, index).left for index, scene in enumerate(scenes)]
    points = seen_points(robot, scenes[0], pair.depth(scenes[0]))
    corners = cv2.goodFeaturesToTrack(frames[0], 300, 0.01, 10).reshape(-1, 2)
    found, status, _ = cv2.calcOpticalFlowPyrLK(frames[0], frames[1], corners.astype(np.float32), None)
    columns, rows = corners.round().astype(int).T
    true = _projected(robot, scenes[1], points[rows, columns]) + (corners - corners.round())
    error = np.linalg.norm(found - true, axis=1)[status.ravel() == 1]
    assert len(corners) > 250
    assert error.size > 200
    assert np.median(error) < 0.25


def _projected(robot: RobotDescription, scene: SceneState, points: np.ndarray) -> np.ndarray:
    fx, fy, cx, cy = robot.camera.intrinsics
    eye: Pose = scene.world_from_body @ robot.camera.body_from_left
    x, y, z = eye.inverse().transform(points).T
    return np.column_stack([fx * x / z + cx, fy * y / z + cy])


@needs_opengl
def test_two_renderers_draw_the_same_bytes_and_another_seed_does_not(robot: RobotDescription) -> None:
    level = make_world("flat", 1)

    def digest(seed: int) -> str:
        renderer, found = StereoRenderer(robot, level, seed), hashlib.sha256()
        for index in range(3):
            frame = renderer.render(scene_at(robot, level, 0.2 * index), index)
            found.update(frame.left.tobytes() + frame.right.tobytes())
        renderer.close()
        return found.hexdigest()

    assert digest(1) == digest(1)
    assert digest(1) != digest(2)


@needs_opengl
def test_noise_has_its_strength_and_differs_from_picture_to_picture(
    robot: RobotDescription, testbed: World, renderer: StereoRenderer
) -> None:
    assert renderer.warning == ""
    scene = scene_at(robot, testbed, 0.0)
    one, other = (renderer.render(scene, index).left.astype(np.int16) for index in (0, 1))
    assert (one - other).std() == pytest.approx(1.5 * np.sqrt(2.0), rel=0.1)


@needs_opengl
def test_the_robot_sees_its_own_leg_when_it_reaches_forward(
    robot: RobotDescription, testbed: World, pair: OpenGlPair
) -> None:
    folded = scene_at(robot, testbed, 0.0)
    joints = folded.joint_position.copy()
    joints[-5:] = [-1.0, 0.0, -0.6, 0.6, 0.4]  # front left, swung ahead
    reaching = SceneState(
        stamp_ns=0, position_in_world=folded.position_in_world, wxyz=folded.wxyz, joint_position=joints
    )
    difference = np.abs(pair.draw(folded).astype(np.int16) - pair.draw(reaching).astype(np.int16))
    assert (difference > 10).mean() > 0.003


@needs_opengl
def test_an_observer_sees_the_robot_in_the_middle(robot: RobotDescription, testbed: World) -> None:
    observer = Observer(robot, make_world("flat", 1), width=320, height=240)
    picture = observer.picture(scene_at(robot, testbed, 0.0))
    observer.close()
    assert picture.shape == (240, 320, 3)
    assert picture[110:130, 150:170].mean() < 0.7 * picture.mean()  # the dark trunk


def test_without_opengl_pictures_come_enlarged_and_with_a_warning(robot: RobotDescription) -> None:
    stairs = make_world("stairs", 1)
    coarse = StereoRenderer(robot, stairs, 1, opengl=False)
    scene = scene_at(robot, stairs, 0.4)
    frame = coarse.render(scene, 7)
    coarse.close()
    assert "320x240" in coarse.warning
    assert frame.left.shape == frame.right.shape == (robot.camera.height, robot.camera.width)
    assert frame.sequence == 7
    if not MISSING:
        drawn = OpenGlPair(robot, stairs)
        sharp = drawn.draw(scene)[:, : robot.camera.width].copy()
        drawn.close()
        # The same scene: blurred alike, both show the same large shapes.
        blurred = [cv2.GaussianBlur(picture.astype(np.float32), (0, 0), 12) for picture in (frame.left, sharp)]
        assert np.corrcoef(blurred[0].ravel(), blurred[1].ravel())[0, 1] > 0.6
