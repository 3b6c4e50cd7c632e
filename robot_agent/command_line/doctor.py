"""`weaver doctor WIRING`: whether servos, IMU and power of a real robot are as they have to be, and the fix if not.

Nothing moves: servos are read and made ready, without torque. With --hung-up, torque comes on for a second, to see
that servos stop by themselves when the computer falls silent.
"""

from __future__ import annotations

import argparse
import json
import logging
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import TypeVar

from robot_agent.hardware.cameras.opening import open_cameras
from robot_agent.hardware.cameras.source import StereoSource
from robot_agent.hardware.doctor import Examination, Finding, Verdict
from robot_agent.hardware.opening import open_imu, open_port, open_power
from robot_agent.hardware.servos.port import MonotonicLineClock, SerialPort
from robot_agent.hardware.wiring import Wiring, load_wiring
from weaver_shared.config.hardware import GenicamCameras, ReplayedCameras, VideoCameras
from weaver_shared.errors import ResourceError, WeaverError
from weaver_shared.robots import load_robot

Line = TypeVar("Line")
Device = TypeVar("Device")
BAR = 40
"""Characters of the histogram's longest bar."""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    # What the watchdogs' test provokes is no news.
    logging.basicConfig(level=logging.ERROR)
    config = load_wiring(options.wiring)
    wiring = Wiring(config, load_robot(config.robot))
    findings = []
    with _opened(wiring, options) as examination:
        for finding in examination.run():
            findings.append(finding)
            if not options.json:
                _print(finding)
    wrong = [finding.check for finding in findings if finding.verdict is Verdict.WRONG]
    if options.json:
        told = {"robot": config.robot, "wiring": str(options.wiring), "wrong": wrong}
        print(json.dumps(told | {"findings": [finding.as_json() for finding in findings]}))
    else:
        print("nothing is wrong" if not wrong else f"wrong: {', '.join(wrong)}")
    return 1 if wrong else 0


@contextmanager
def _opened(wiring: Wiring, options: argparse.Namespace) -> Iterator[Examination]:
    """All ports of a wiring, those that can be opened."""
    config = wiring.config
    with ExitStack() as stack:
        ports: dict[str, SerialPort | ResourceError] = {}
        for bus in config.buses:
            ports[bus.name] = port = _tried(partial(open_port, wiring), bus)
            if isinstance(port, SerialPort):
                stack.callback(port.closePort)
        imu = _tried(partial(open_imu, rate=wiring.robot.imu.rate), config.imu) if config.imu else None
        power = _tried(open_power, config.power) if config.power else None
        cameras = _seeing(config.cameras) if config.cameras else None
        for source in (imu, power, cameras):
            if source is not None and not isinstance(source, WeaverError):
                stack.callback(source.close)
        yield Examination(
            wiring=wiring,
            ports=ports,
            clock=MonotonicLineClock(),
            imu=imu,
            power=power,
            cycles=options.cycles,
            seconds=options.seconds,
            hung_up=options.hung_up,
            lying=options.lying,
            cameras=cameras,
        )


def _tried(opening: Callable[[Line], Device], line: Line) -> Device | ResourceError:
    try:
        return opening(line)
    except ResourceError as error:
        return error


def _seeing(config: GenicamCameras | VideoCameras | ReplayedCameras) -> StereoSource | WeaverError:
    try:
        return open_cameras(config, MonotonicLineClock())
    except WeaverError as error:
        return error


def _print(finding: Finding) -> None:
    print(f"{finding.verdict.upper():10}  {finding.check}: {finding.found}", flush=True)
    bars = finding.figures.get("histogram", [])
    most = max((bar["cycles"] for bar in bars), default=0)
    for bar in bars:
        print(f"{bar['from_ms']:20.1f} ms {bar['cycles']:6d} {'#' * -(-BAR * bar['cycles'] // most)}")
    if finding.fix:
        print(f"{'':12}→ {finding.fix}")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver doctor", description=__doc__)
    parser.add_argument("wiring", type=Path, help="the robot's wiring file, .toml (docs/hardware.md)")
    parser.add_argument("--cycles", type=_count, default=1000, help="readings of all servos")
    parser.add_argument(
        "--seconds", type=_seconds, default=5.0, help="s to listen to IMU and power monitor, and to watch the cameras"
    )
    parser.add_argument("--hung-up", action="store_true", help="the robot hangs with its feet free: test the watchdogs")
    parser.add_argument("--lying", action="store_true", help="the robot lies on its belly: test the motors' relay")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    return parser


def _count(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of readings; give 1 or more")
    return int(text)


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value <= 3600.0:
        raise argparse.ArgumentTypeError(f"{text!r} is no time to listen; give seconds above 0, at most 3600")
    return value
