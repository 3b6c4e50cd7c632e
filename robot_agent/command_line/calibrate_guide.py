"""`weaver calibrate guide`: the robot's calibrator, guided from the console's page."""

from __future__ import annotations

import argparse
import signal
import threading
from datetime import datetime

from robot_agent.calibration_process import CalibrationProcess
from weaver_shared.bus import ZenohBus
from weaver_shared.robots import load_robot


def run(options: argparse.Namespace) -> int:
    robot = load_robot(options.robot)
    ended = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: ended.set())
    endpoints = options.connect.split(",") if options.connect else []

    def open_bus() -> ZenohBus:
        return ZenohBus(connect=endpoints)

    bus = open_bus()
    try:
        CalibrationProcess(
            robot_id=options.robot_id,
            robot=robot,
            bus=bus,
            open_bus=open_bus,
            recordings=options.recordings,
            folder=options.folder,
            wall_time=lambda: datetime.now().astimezone(),
        ).run(ended)
    finally:
        bus.close()
    return 0
