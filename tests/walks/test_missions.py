"""Whole missions in lock step: rendered pictures in, servo torques out, judged by the truth that no stage may see."""

import argparse
from typing import Any

import pytest

pytest.importorskip("pybullet")

from sim_agent.command_line.walk import parser, walk

pytestmark = pytest.mark.walk


def options(*arguments: str) -> argparse.Namespace:
    return parser().parse_args([*arguments, "--seed", "1"])


@pytest.fixture(scope="module")
def flat() -> dict[str, Any]:
    return walk(options("--world", "flat", "--goal", "0.6,0"))


@pytest.fixture(scope="module")
def testbed() -> dict[str, Any]:
    return walk(options("--world", "testbed", "--goal", "5,0"))


def test_a_goal_on_flat_ground_is_reached(flat: dict[str, Any]) -> None:
    assert flat["reached"]
    assert 0.3 < flat["distance"] < 0.8
    assert flat["odometry"]["final_error"] < 0.02
    assert flat["cost_of_transport"]["total"] > flat["cost_of_transport"]["motors"] > 0.0


def test_no_stage_reads_the_truth(flat: dict[str, Any]) -> None:
    blind = walk(options("--world", "flat", "--goal", "0.6,0"), tell_truth=False)
    assert blind["digest"] == flat["digest"]
    assert "distance" not in blind


def test_the_digest_covers_the_run(flat: dict[str, Any]) -> None:
    other = walk(options("--world", "flat", "--goal", "0.6,0", "--adapt", "off", "--timeout", "1"))
    assert not other["reached"]
    assert other["digest"] != flat["digest"]


def test_the_testbed_is_crossed_into_its_blocks(testbed: dict[str, Any]) -> None:
    assert testbed["reached"]
    assert set(testbed["segments"]) >= {"A", "B", "C"}
    assert testbed["odometry"]["drift_percent"] < 1.0


@pytest.mark.parametrize("name", ["roughness", "step_height", "stride_height"])
def test_blocks_are_rougher_and_stepped_over_higher_than_the_flat_start(testbed: dict[str, Any], name: str) -> None:
    assert testbed["segments"]["C"][name] > testbed["segments"]["A"][name]


@pytest.mark.parametrize("name", ["virtual_stiffness", "stride_frequency"])
def test_blocks_are_walked_softer_and_slower_than_the_flat_start(testbed: dict[str, Any], name: str) -> None:
    assert testbed["segments"]["C"][name] < testbed["segments"]["A"][name]


def test_a_goal_behind_a_wall_is_reached_around_it() -> None:
    around = walk(options("--world", "wall", "--goal", "2.9,0", "--navigate", "auto", "--timeout", "60"))
    assert around["reached"]
    assert around["distance"] > 3.6  # the straight line ends at the wall, 2.9 m would pass through it
