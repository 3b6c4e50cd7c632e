"""The recorder hears everything but the scene, and nobody who speaks waits for it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from made_up_recordings import ROBOT_ID, begun, felt, heartbeat, lease, pair

from robot_agent.recording import Recorder, open_recording, recorder
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import SceneState

ALL = topics.TOPICS


def say_something(bus: MemoryBus, generator: np.random.Generator) -> None:
    bus.publish(ROBOT_ID, topics.HEARTBEAT, heartbeat(10))
    bus.publish(ROBOT_ID, topics.STEREO, pair(20, generator))
    bus.publish(ROBOT_ID, topics.PROPRIOCEPTION, felt(30, generator))
    scene = SceneState(stamp_ns=30, position_in_world=np.zeros(3), wxyz=np.zeros(4), joint_position=np.zeros(18))
    bus.publish(ROBOT_ID, topics.SCENE, scene)
    bus.publish("sim-2", topics.HEARTBEAT, heartbeat(40))


@pytest.mark.parametrize("pictures", [True, False])
def test_what_one_robot_says_is_written(tmp_path: Path, pictures: bool) -> None:
    bus = MemoryBus()
    bus.publish(ROBOT_ID, topics.LEASE, lease(7))  # said before, and kept by the bus for whoever comes later
    writer = begun(tmp_path / "a.mcap", SimulatedClock(), pictures=pictures)
    listener = Recorder(bus, ROBOT_ID, writer, pictures=pictures)
    say_something(bus, np.random.default_rng(1))
    listener.turn()
    writer.close()
    keys = [key for _, key, _ in open_recording(tmp_path / "a.mcap").messages(*ALL)]
    with_pictures = ["state/lease", "hb", "sensor/stereo", "sensor/body"]
    assert keys == [key for key in with_pictures if pictures or key != "sensor/stereo"]


def test_messages_a_slow_disk_has_no_room_for_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recorder, "MOST_PICTURES_WAITING", 2)
    bus = MemoryBus()
    writer = begun(tmp_path / "a.mcap", SimulatedClock())
    listener = Recorder(bus, ROBOT_ID, writer)
    generator = np.random.default_rng(1)
    for n in range(5):
        bus.publish(ROBOT_ID, topics.STEREO, pair(n, generator))
        bus.publish(ROBOT_ID, topics.PROPRIOCEPTION, felt(n, generator))
    listener.turn()
    assert listener.lost == 3
    bus.publish(ROBOT_ID, topics.STEREO, pair(9, generator))
    listener.turn()
    writer.close()
    read = [message.stamp_ns for _, _, message in open_recording(tmp_path / "a.mcap").messages(topics.STEREO)]
    assert read == [0, 1, 9]
