"""`weaver replay`: plays a recording on the bus, for any console to show as it was."""

from __future__ import annotations

import argparse
import logging
import os
import signal
import threading
from pathlib import Path

from robot_agent.recording.playback import Playback
from robot_agent.recording.player import FASTEST, Player, replay_id_of
from weaver_shared.bus import ZenohBus
from weaver_shared.clock import MonotonicClock
from weaver_shared.errors import ConfigurationError

PERIOD = 0.02
"""s between two looks at what is due: the period of the fastest of what consoles show."""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s")
    if not 0.0 <= options.speed <= FASTEST:
        raise ConfigurationError(f"--speed {options.speed:g} is not possible; use 0 (paused) to {FASTEST:g}")
    playback = Playback(options.file)
    parent = os.getppid()
    ended = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: ended.set())
    bus = ZenohBus(connect=options.connect.split(","))
    try:
        player = Player(
            playback,
            bus,
            MonotonicClock(),
            replay_id=options.robot_id or replay_id_of(options.file.name),
            run=f"{os.getpid()}",
            speed=options.speed,
        )
        while not (ended.wait(PERIOD) or player.ended or (options.attended and os.getppid() != parent)):
            player.turn()
    finally:
        bus.close()
        playback.close()
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver replay", description="Play a recording on the bus as a robot of the kind REPLAY."
    )
    parser.add_argument("file", metavar="FILE", type=Path, help=".mcap of `weaver record` or of the console")
    parser.add_argument("--speed", type=float, default=1.0, help="recorded s a second, 0 to begin paused (%(default)s)")
    parser.add_argument("--robot-id", default="", help="name on the bus (replay- and the file's)")
    parser.add_argument("--connect", default="tcp/127.0.0.1:7447", help="bus endpoints to join, comma-separated")
    parser.add_argument("--attended", action="store_true", help="end when the program that started this one has ended")
    return parser
