"""`weaver up`: a robot - simulated, emulated or real - and the console, ready to be driven from a browser."""

from __future__ import annotations

import argparse
import contextlib
import json
import signal
import socket
import subprocess
import sys
import time
import tomllib
import types
import urllib.request
import webbrowser
from pathlib import Path

from weaver_shared.bus import free_port
from weaver_shared.errors import ConfigurationError, ResourceError
from weaver_shared.supervisor import Supervisor
from weaver_shared.topics import robot_key
from weaver_shared.twin_folder import twin_folder

HOST = "127.0.0.1"
RENDEZVOUS = 7447
"""Where the console waits for robots, so that further ones started on this machine appear by themselves."""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    real = options.robot == "hardware"
    options.robot_id = options.robot_id or ("weaver-1" if real else "sim-1")
    if real != (options.wiring is not None):
        raise ConfigurationError(
            "--robot hardware needs --wiring FILE, and no other robot takes one; see `weaver doctor`"
        )
    options.has_cameras = real and _has_cameras(options.wiring)
    robot_key(options.robot_id, "")
    if options.console:
        _require_free(options.port)
    rendezvous = f"tcp/{HOST}:{_port_or_free(RENDEZVOUS)}" if options.console else options.connect
    robot = f"tcp/{HOST}:{free_port()}"
    supervisor = Supervisor(lambda text: print(f"weaver up: {text}", file=sys.stderr, flush=True))
    signal.signal(signal.SIGTERM, _interrupt)
    try:
        _start(supervisor, options, rendezvous=rendezvous, robot=robot)
        if options.console:
            _announce(supervisor, options)
        while True:
            supervisor.watch()
            time.sleep(0.1)
    except KeyboardInterrupt:
        return 0
    finally:
        supervisor.close()


def _start(supervisor: Supervisor, options: argparse.Namespace, *, rendezvous: str, robot: str) -> None:
    known = ["--robot-id", options.robot_id, "--connect", f"{rendezvous},{robot}"]
    world = ["--world", options.world, "--seed", str(options.seed)]
    name = ["--robot", options.description]
    own = ["--robot-id", options.robot_id, "--connect", rendezvous, "--listen", robot]
    eyes: list[str] = []
    wiring = options.wiring
    if options.robot == "twin":
        # The ports of one that was killed lead nowhere.
        wiring = twin_folder(options.robot_id) / "wiring.toml"
        wiring.unlink(missing_ok=True)
        seen = _sees_gige()
        eyes = ["--cameras", str(wiring)] if seen else []
        devices = ["twin", "run", *known, *world, *name, *(["--cameras"] if seen else [])]
        supervisor.add("the emulated devices", ["weaver_shared.command_line", *devices], nice=-5)
        walk = ["--role", "walk", "--wiring", str(wiring), "--wait", "60", "--world", options.world, "--stand"]
        supervisor.add("the robot", ["weaver_shared.command_line", "robot", *walk, *own, *name], nice=-5)
    elif options.robot == "hardware":
        # It stands up when somebody who looks at it says so.
        walk = ["--role", "walk", "--wiring", str(wiring)]
        supervisor.add("the robot", ["weaver_shared.command_line", "robot", *walk, *own], nice=-5)
    else:
        supervisor.add("the robot", ["weaver_shared.command_line", "sim", *own, *world, *name, "--stand"], nice=-5)
    if options.robot != "hardware":
        supervisor.add("the renderer", ["sim_agent.render_process", *known, *world, *name, *eyes], nice=2)
    if eyes or options.has_cameras:
        cameras = ["cameras", "--wiring", str(wiring), "--wait", "60", *known]
        supervisor.add("the cameras", ["weaver_shared.command_line", *cameras], nice=2)
    supervisor.add("vision", ["weaver_shared.command_line", "robot", "--role", "vision", *known, *name], nice=2)
    recorder = ["--robot-id", options.robot_id, "--connect", f"{rendezvous},{robot}", "--folder", options.recordings]
    supervisor.add("the recorder", ["weaver_shared.command_line", "record", *recorder, *name], nice=2)
    calibrator = ["guide", "--robot-id", options.robot_id, "--connect", f"{rendezvous},{robot}"]
    folders = ["--recordings", options.recordings, "--folder", options.calibrations]
    supervisor.add("the calibrator", ["weaver_shared.command_line", "calibrate", *calibrator, *folders, *name], nice=10)
    if options.console:
        console = ["--host", HOST, "--port", str(options.port), "--listen", rendezvous, "--connect", robot]
        supervisor.add("the console", ["weaver_shared.command_line", "console", *console], nice=-5)
    print(json.dumps({"bus": rendezvous, "pids": supervisor.pids}), file=sys.stderr, flush=True)


def _has_cameras(wiring: Path) -> bool:
    """Whether a wiring names any; what else is in it is not looked at here."""
    try:
        return "cameras" in tomllib.loads(wiring.read_text())
    except (OSError, ValueError) as error:
        raise ConfigurationError(f"wiring {wiring} can not be read: {error}") from error


def _sees_gige() -> bool:
    """Whether this computer can see GigE Vision cameras; says so where it can not."""
    asked = [sys.executable, "-m", "weaver_shared.command_line", "cameras", "--have-aravis"]
    told = subprocess.run(asked, capture_output=True, text=True, check=False)
    if told.returncode:
        reason = (told.stderr.strip().splitlines() or ["no reason given"])[-1]
        print(f"weaver up: the twin's pictures come straight from the renderer, since {reason}", file=sys.stderr)
    return not told.returncode


def _announce(supervisor: Supervisor, options: argparse.Namespace, timeout: float = 60.0) -> None:
    address = f"http://{HOST}:{options.port}/"
    deadline = time.monotonic() + timeout
    while not _answers(address):
        supervisor.watch()
        if time.monotonic() > deadline:
            raise ResourceError(f"the console did not answer on {address} within {timeout:.0f} s")
        time.sleep(0.1)
    print(f"Weaver Console is on {address}  (end with Ctrl-C)", flush=True)
    if options.browser:
        webbrowser.open(address)


def _answers(address: str) -> bool:
    with contextlib.suppress(OSError), urllib.request.urlopen(f"{address}api/health", timeout=1.0) as reply:
        return bool(reply.status == 200)
    return False


def _require_free(port: int) -> None:
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OverflowError as error:
            raise ConfigurationError(f"port {port} is not a port; use 1 to 65535") from error
        except OSError as error:
            raise ResourceError(f"port {port} can not be used ({error.strerror}); choose one with --port") from error


def _port_or_free(port: int) -> int:
    try:
        _require_free(port)
    except ResourceError:
        return free_port()
    return port


def _interrupt(_signal: int, _frame: types.FrameType | None) -> None:
    raise KeyboardInterrupt


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver up", description=__doc__)
    parser.add_argument(
        "--robot",
        choices=("sim", "twin", "hardware"),
        default="sim",
        help="twin: real drivers on emulated servos, IMU, power and cameras; hardware: the real robot of --wiring",
    )
    parser.add_argument("--wiring", type=Path, metavar="FILE", help="where a real robot's devices are")
    parser.add_argument("--description", default="weaver", help="robot description: a shipped name or a TOML file")
    parser.add_argument("--robot-id", help="name on the bus, unique per robot (default: sim-1; hardware: weaver-1)")
    parser.add_argument("--world", default="testbed", help="flat, testbed, outdoor or stairs")
    parser.add_argument("--seed", type=int, default=1, help="seed of the world and of all sensor noise")
    parser.add_argument("--port", type=int, default=8080, help="TCP port of the page")
    parser.add_argument("--recordings", default="recordings", help="folder for recordings started from the page")
    parser.add_argument("--calibrations", default="calibrations", help="folder for calibrations made on the page")
    parser.add_argument("--no-browser", dest="browser", action="store_false", help="do not open a browser")
    parser.add_argument("--no-console", dest="console", action="store_false", help="start the robot alone")
    parser.add_argument("--connect", default=f"tcp/{HOST}:{RENDEZVOUS}", help="console to join with --no-console")
    return parser
