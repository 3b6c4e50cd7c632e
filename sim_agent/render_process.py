"""The simulated cameras as a process of their own: scenes in from the bus, stereo pairs and previews out.

Drawing holds Python's interpreter lock for tens of milliseconds, which neither physics nor walking could bear.
"""

from __future__ import annotations

import argparse
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import ExitStack, closing
from pathlib import Path

import cv2

from robot_agent.hardware.cameras.preview import preview
from sim_agent.render_timing import RenderTiming
from sim_agent.rendering import StereoRenderer, frame_sequence
from sim_agent.twin.shown_eyes import ShownEyes, awaited_cameras
from sim_agent.worlds import WORLD_NAMES, make_world
from weaver_shared import topics
from weaver_shared.bus import Bus, ZenohBus
from weaver_shared.errors import WeaverError
from weaver_shared.latest import LatestSlot
from weaver_shared.messages import CameraPicture, Event, SceneState, Severity, StereoFrame
from weaver_shared.robots import RobotDescription, load_robot

HEALTH_PERIOD = 0.5  # s


def main(arguments: list[str] | None = None) -> int:
    options = _parser().parse_args(arguments)
    robot = load_robot(options.robot)
    world = make_world(options.world, options.seed)
    cv2.setNumThreads(1)
    stopping = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stopping.set())
    bus = ZenohBus(connect=options.connect.split(",") if options.connect else [])
    try:
        with ExitStack() as opened:
            renderer = opened.enter_context(closing(StereoRenderer(robot, world, options.seed)))
            show = _on_bus(bus, options.robot_id, robot)
            if options.cameras is not None and (wired := awaited_cameras(options.cameras, stopping)) is not None:
                show = opened.enter_context(closing(ShownEyes(*wired, robot.camera))).show
            render_scenes(bus, options.robot_id, robot, renderer, stopping, show)
    finally:
        bus.close()
    return 0


def render_scenes(
    bus: Bus,
    robot_id: str,
    robot: RobotDescription,
    renderer: StereoRenderer,
    stopping: threading.Event,
    show: Callable[[StereoFrame], None] | None = None,
) -> None:
    """Draw the newest scene again and again until `stopping` is set; scenes it has no time for are left out.

    `show` gets each pair; without it they go onto the bus.
    """
    show = show or _on_bus(bus, robot_id, robot)
    scenes: LatestSlot[SceneState] = LatestSlot()
    bus.subscribe(robot_id, topics.SCENE, lambda _robot, _key, scene: scenes.put(scene))
    bus.announce(robot_id, "render")
    if renderer.warning:
        warning = Event(stamp_ns=0, severity=Severity.WARNING, source="render", text=renderer.warning)
        bus.publish(robot_id, topics.EVENT, warning)
    timing = RenderTiming(robot.camera.rate)
    overwritten = 0
    while not stopping.is_set():
        scene = scenes.take(timeout=0.1)
        if scene is not None:
            # Counted from the stamp, so that a frame that was left out leaves a gap, and lock step counts alike.
            sequence = frame_sequence(robot, scene.stamp_ns)
            show(renderer.render(scene, sequence))
            timing.rendered(scene.stamp_ns)
        if timing.seconds >= HEALTH_PERIOD:
            lost = scenes.overwritten
            bus.publish(robot_id, topics.HEALTH, timing.report(lost - overwritten), process="render")
            overwritten = lost


def _on_bus(bus: Bus, robot_id: str, robot: RobotDescription) -> Callable[[StereoFrame], None]:
    every = max(round(robot.camera.rate / topics.CAMERA.rate), 1)

    def publish(frame: StereoFrame) -> None:
        bus.publish(robot_id, topics.STEREO, frame)
        if frame.sequence % every == 0:
            picture = CameraPicture(stamp_ns=frame.stamp_ns, name="left", jpeg=preview(frame.left))
            bus.publish(robot_id, topics.CAMERA, picture, name=picture.name)

    return publish


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m sim_agent.render_process", description=__doc__.splitlines()[0])
    parser.add_argument("--robot-id", required=True, help="robot on the bus whose cameras these are")
    parser.add_argument("--robot", default="weaver", help="robot description: a name or a TOML file")
    parser.add_argument("--world", default="testbed", help=f"one of {', '.join(WORLD_NAMES)}")
    parser.add_argument("--seed", type=int, default=1, help="of world and sensor noise, from 0 up")
    parser.add_argument("--connect", default="tcp/127.0.0.1:7447", help="bus endpoints to join, comma-separated")
    parser.add_argument(
        "--cameras",
        type=Path,
        metavar="FILE",
        help="show the pictures by emulated GigE Vision cameras as this wiring names them, instead of on the bus",
    )
    return parser


if __name__ == "__main__":
    try:
        sys.exit(main())
    except WeaverError as failure:
        print(f"render: {failure}", file=sys.stderr)
        sys.exit(2)
