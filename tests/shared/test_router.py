"""Processes that know only the meeting point find each other, and need it no more once they have."""

import queue
import subprocess
import sys
from typing import Any

from weaver_shared import topics
from weaver_shared.bus import ZenohBus, free_port
from weaver_shared.messages import Heartbeat

PATIENCE = 10.0  # s, never spent when all is well


def hear(robot: ZenohBus, received: "queue.Queue[int]", sequence: int) -> None:
    """Publish until the other end has heard this sequence number."""
    for _ in range(round(PATIENCE / 0.05)):
        robot.publish("w1", topics.HEARTBEAT, Heartbeat(stamp_ns=0, sequence=sequence, session="a"))
        try:
            while received.get(timeout=0.05) != sequence:
                pass
        except queue.Empty:
            continue
        return
    raise AssertionError(f"{sequence} was not heard")


def test_peers_meet_and_keep_in_touch_when_the_meeting_point_dies() -> None:
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    command = [sys.executable, "-m", "weaver_shared.command_line", "router", "--listen", endpoint]
    received: queue.Queue[int] = queue.Queue()

    def receive(robot_id: str, key: str, message: Any) -> None:
        received.put(message.sequence)

    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as router:
        assert router.stdout is not None
        assert router.stdout.readline() == f"the bus meets at {endpoint}\n"
        robot, console = ZenohBus(connect=[endpoint]), ZenohBus(connect=[endpoint])
        try:
            console.subscribe("*", topics.HEARTBEAT, receive)
            hear(robot, received, 1)
            router.kill()
            router.wait(timeout=PATIENCE)
            hear(robot, received, 2)
        finally:
            console.close()
            robot.close()
