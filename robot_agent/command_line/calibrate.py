"""`weaver calibrate`: targets, cameras, camera and IMU, and whether existing files still hold."""

from __future__ import annotations

import argparse
from importlib import import_module
from pathlib import Path

EXAMPLES = """examples:
  weaver calibrate target --page a3 --out target.pdf
  weaver calibrate cameras PICTURES --target target.yaml --out calibration
  weaver calibrate imu RECORDING --cameras calibration/camchain.yaml --imu imu.yaml --target target.yaml
  weaver calibrate check RECORDING --cameras calibration/camchain.yaml --target target.yaml"""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    # Each part loads what it needs: the guide, which waits beside every robot, needs little.
    return int(import_module(f"robot_agent.command_line.calibrate_{options.part}").run(options))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver calibrate",
        description="Calibrate cameras and IMU with files as Kalibr's; lengths in m, angles in degrees, times in s.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parts = parser.add_subparsers(required=True, metavar="PART")

    target = parts.add_parser("target", help="an AprilGrid or chessboard to print, with its target.yaml")
    target.add_argument("--out", type=Path, required=True, help="PDF to write; target.yaml goes beside it")
    target.add_argument("--type", choices=("aprilgrid", "checkerboard"), default="aprilgrid")
    target.add_argument("--columns", type=int, default=6, help="tags, or inner corners, across (default 6)")
    target.add_argument("--rows", type=int, default=6, help="tags, or inner corners, upwards (default 6)")
    target.add_argument("--size", type=float, help="of a tag or square, m (default: the largest that fits)")
    target.add_argument("--spacing", type=float, default=0.3, help="gap between tags over their size (default 0.3)")
    target.add_argument("--page", default="a4", help="a4, a3, a2, a1, a0 or letter (default a4)")
    target.set_defaults(part="target")

    cameras = parts.add_parser("cameras", help="lenses and the eyes' places, from pictures or a recording")
    _add_source(cameras)
    cameras.add_argument(
        "--model", choices=("radtan", "equidistant"), default="radtan", help="of the lenses (default radtan)"
    )
    cameras.add_argument("--views", type=int, default=100, help="used of a long recording (default 100)")
    cameras.add_argument(
        "--watch", type=float, metavar="SECONDS", help="look for new pictures until nothing is missing, at most so long"
    )
    _add_output(cameras)
    cameras.set_defaults(part="cameras")

    imu = parts.add_parser("imu", help="where the IMU is from the cameras, and how late; from a recording with both")
    _add_source(imu)
    imu.add_argument("--cameras", type=Path, metavar="CAMCHAIN", required=True, help="camchain.yaml of the cameras")
    imu.add_argument("--imu", type=Path, required=True, help="imu.yaml: rate (Hz) and noise densities (SI)")
    imu.add_argument("--knots", type=float, default=50.0, help="of the trajectory's spline, per second (default 50)")
    _add_output(imu)
    imu.set_defaults(part="imu")

    check = parts.add_parser("check", help="whether a camchain.yaml still fits the cameras")
    _add_source(check)
    check.add_argument("--cameras", type=Path, metavar="CAMCHAIN", required=True, help="camchain.yaml to check")
    check.add_argument("--views", type=int, default=60, help="used of a long recording (default 60)")
    check.add_argument("--quiet", action="store_true", help="no progress bar")
    check.add_argument("--json", action="store_true", help="print one JSON object")
    check.set_defaults(part="check")

    guide = parts.add_parser("guide", help="wait for the console's page, which leads through a calibration")
    guide.add_argument("--folder", type=Path, default=Path("calibrations"), help="where results go")
    guide.add_argument(
        "--recordings", type=Path, default=Path("recordings"), help="those that may be looked at instead"
    )
    guide.add_argument("--robot-id", default="sim-1", help="name of the robot on the bus")
    guide.add_argument("--robot", default="weaver", help="robot description: a shipped name or a TOML file")
    guide.add_argument("--connect", default="tcp/127.0.0.1:7447", help="bus endpoints to join, comma-separated")
    guide.set_defaults(part="guide")
    return parser


def _add_source(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "pictures",
        type=Path,
        metavar="DIR|FILE",
        help="a robot's own recording (.mcap), ASL folder (mav0/cam0, cam1, imu0), left*/right* pairs, or pictures",
    )
    parser.add_argument("--target", type=Path, required=True, help="target.yaml: what the pictures show, sizes in m")


def _add_output(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", type=Path, default=Path("calibration"), help="folder for files and report")
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
