"""The hardware code walks the simulated robot through emulated servos, IMU and power monitor, with the same gait."""

import argparse

import pytest

pytest.importorskip("pybullet")

from sim_agent.command_line.walk import parser, walk

pytestmark = pytest.mark.walk


def options(robot: str) -> argparse.Namespace:
    return parser().parse_args(["--robot", robot, "--world", "flat", "--goal", "0.35,0", "--seed", "1"])


def test_the_twin_walks_where_the_simulated_robot_walks() -> None:
    twin, simulated = walk(options("twin")), walk(options("sim"))
    assert twin["reached"]
    assert twin["distance"] == pytest.approx(simulated["distance"], abs=0.1)
    assert twin["odometry"]["final_error"] < 0.03
    assert twin["joint_tracking_rms_deg"] == pytest.approx(simulated["joint_tracking_rms_deg"], abs=1.0)
