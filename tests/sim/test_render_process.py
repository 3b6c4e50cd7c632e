"""The camera process: newest scene in, pair, preview and health out."""

import threading
from typing import Any

import cv2
import numpy as np
import pytest

from robot_agent.hardware.cameras.preview import SIZE, preview
from sim_agent.model import sitting_joints
from sim_agent.render_process import frame_sequence, main, render_scenes
from weaver_shared import topics
from weaver_shared.bus import MemoryBus, Receiver
from weaver_shared.errors import ConfigurationError
from weaver_shared.messages import CameraPicture, Event, SceneState, StereoFrame
from weaver_shared.robots import RobotDescription
from weaver_shared.topics import Topic


class SceneOnSubscription(MemoryBus):
    """Delivers one scene as soon as somebody wants scenes."""

    def __init__(self, scene: SceneState) -> None:
        super().__init__()
        self._scene = scene

    def subscribe(self, robot_id: str, topic: Topic, receiver: Receiver) -> None:
        super().subscribe(robot_id, topic, receiver)
        if topic is topics.SCENE:
            self.publish(robot_id, topics.SCENE, self._scene)


class GreyRenderer:
    """A renderer without a world, so that the process around it can be seen."""

    warning = "drawn coarsely"

    def render(self, scene: SceneState, sequence: int) -> StereoFrame:
        grey = np.full((480, 640), 90, dtype=np.uint8)
        return StereoFrame(stamp_ns=scene.stamp_ns, sequence=sequence, left=grey, right=grey)


def test_a_scene_becomes_a_pair_a_preview_and_a_warning_where_due(robot: RobotDescription) -> None:
    scene = SceneState(
        stamp_ns=1_600_000_000,
        position_in_world=np.zeros(3),
        wxyz=np.array([1.0, 0.0, 0.0, 0.0]),
        joint_position=sitting_joints(robot),
    )
    bus, stopping, got = SceneOnSubscription(scene), threading.Event(), dict[str, Any]()

    def pictured(_robot: str, key: str, message: CameraPicture) -> None:
        got[key] = message
        stopping.set()

    bus.subscribe("w", topics.STEREO, lambda _robot, key, message: got.__setitem__(key, message))
    bus.subscribe("w", topics.EVENT, lambda _robot, key, message: got.__setitem__(key, message))
    bus.subscribe("w", topics.CAMERA, pictured)
    render_scenes(bus, "w", robot, GreyRenderer(), stopping)  # type: ignore[arg-type]

    frame, picture, event = got["sensor/stereo"], got["tele/cam/left"], got["event"]
    assert (frame.stamp_ns, frame.sequence) == (scene.stamp_ns, 20)
    assert picture.stamp_ns == scene.stamp_ns
    decoded = cv2.imdecode(np.frombuffer(picture.jpeg, np.uint8), cv2.IMREAD_GRAYSCALE)
    assert decoded.shape == SIZE[::-1]
    assert isinstance(event, Event)
    assert event.text == "drawn coarsely"


def test_frames_are_counted_by_the_control_clock(robot: RobotDescription) -> None:
    assert [frame_sequence(robot, stamp) for stamp in (0, 80_000_000, 160_000_000, 2_000_000_000)] == [0, 1, 2, 25]


def test_a_preview_is_small_enough_for_five_a_second() -> None:
    noisy = np.random.default_rng(0).integers(0, 255, (480, 640)).astype(np.uint8)
    assert len(preview(noisy)) < 60_000


def test_an_unknown_world_or_robot_is_refused_before_anything_starts() -> None:
    with pytest.raises(ConfigurationError, match="'moon' is unknown"):
        main(["--robot-id", "w", "--world", "moon"])
    with pytest.raises(ConfigurationError, match="'crab' is unknown"):
        main(["--robot-id", "w", "--robot", "crab"])
