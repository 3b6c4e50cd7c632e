"""`weaver cameras`: a robot's stereo cameras as a process of their own, pairs and previews onto the bus.

A camera that is gone blocks its driver for seconds, which no other loop of the robot could bear.
"""

from __future__ import annotations

import argparse
import logging
import signal
import threading
import time
from contextlib import closing
from pathlib import Path

import cv2

from robot_agent.hardware.cameras.aravis import aravis
from robot_agent.hardware.cameras.opening import open_cameras
from robot_agent.hardware.cameras.preview import preview
from robot_agent.hardware.cameras.source import StereoSource
from robot_agent.hardware.emulated_clock import EmulatedClock
from robot_agent.hardware.wiring import load_wiring
from weaver_shared import topics
from weaver_shared.bus import Bus, ZenohBus
from weaver_shared.clock import Clock, MonotonicClock
from weaver_shared.config.hardware import GenicamCameras, ReplayedCameras, VideoCameras
from weaver_shared.errors import ConfigurationError, ResourceError
from weaver_shared.messages import CameraPicture, Event, Severity

WAIT = 0.2  # s
PREVIEW_EVERY = 4
"""Pairs; previews are for people."""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.WARNING)
    if options.have_aravis:
        aravis()
        return 0
    if options.wiring is None:
        raise ConfigurationError("--wiring FILE is missing; its table [cameras] says which cameras there are")
    ended = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: ended.set())
    until = time.monotonic() + options.wait
    while not options.wiring.exists() and time.monotonic() < until and not ended.is_set():
        ended.wait(WAIT)
    config = load_wiring(options.wiring)
    if config.cameras is None:
        raise ConfigurationError(f"wiring {options.wiring} names no cameras; add a table [cameras]")
    cv2.setNumThreads(1)
    clock = EmulatedClock(Path(config.emulated.clock)) if config.emulated else MonotonicClock()
    with closing(_opened(config.cameras, clock, until, ended)) as source:
        bus = ZenohBus(connect=options.connect.split(",") if options.connect else [])
        with closing(bus):
            serve(source, bus, options.robot_id, ended)
    return 0


def _opened(
    config: GenicamCameras | VideoCameras | ReplayedCameras, clock: Clock, until: float, ended: threading.Event
) -> StereoSource:
    """The cameras, which may still be getting up until this monotonic time."""
    while True:
        try:
            return open_cameras(config, clock)
        except ResourceError:
            if time.monotonic() > until or ended.wait(WAIT):
                raise


def serve(source: StereoSource, bus: Bus, robot_id: str, ended: threading.Event) -> None:
    """Publish every pair until `ended`; what is wrong with the cameras is told once."""
    bus.announce(robot_id, "cameras")
    told = ""
    stamp_ns = 0
    while not ended.is_set():
        frame = source.read(WAIT)
        trouble = source.health().trouble
        if trouble and trouble != told:
            event = Event(stamp_ns=stamp_ns, severity=Severity.WARNING, source="cameras", text=trouble)
            bus.publish(robot_id, topics.EVENT, event)
        told = trouble
        if frame is None:
            continue
        stamp_ns = frame.stamp_ns
        bus.publish(robot_id, topics.STEREO, frame)
        if frame.sequence % PREVIEW_EVERY == 0:
            picture = CameraPicture(stamp_ns=stamp_ns, name="left", jpeg=preview(frame.left))
            bus.publish(robot_id, topics.CAMERA, picture, name=picture.name)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver cameras", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--wiring", type=Path, metavar="FILE", help="its table [cameras] says which")
    parser.add_argument("--wait", type=float, default=0.0, help="s to wait for the wiring file and the cameras")
    parser.add_argument(
        "--have-aravis", action="store_true", help="only say whether GenICam cameras can be opened on this computer"
    )
    parser.add_argument("--robot-id", default="weaver-1", help="name on the bus, unique per robot")
    parser.add_argument("--connect", default="tcp/127.0.0.1:7447", help="bus endpoints to join, comma-separated")
    return parser
