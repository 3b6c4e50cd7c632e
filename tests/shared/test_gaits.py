"""Gaits belong to a number of legs: every leg swings once a stride, and enough feet stay on the ground."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription, load_robot, robot_names
from weaver_shared.robots.gaits import predefined_gaits

ALL = [(legs, name) for legs in range(3, 9) for name in predefined_gaits(legs)]
DYNAMIC = {"bipod": 2, "trot": 2}


@pytest.mark.parametrize(("legs", "name"), ALL)
def test_a_gait_has_a_turn_for_every_leg_and_keeps_enough_feet_down(legs: int, name: str) -> None:
    gait = predefined_gaits(legs)[name]
    assert len(gait.offset) == legs
    assert all(0.0 <= offset < 1.0 for offset in gait.offset)
    phases = (np.linspace(0.0, 1.0, 2000, endpoint=False)[:, None] + gait.offsets) % 1.0
    standing = (phases >= gait.swing - 1e-9).sum(axis=1)
    assert gait.fewest_standing == standing.min()
    assert standing.min() >= DYNAMIC.get(name, min(legs - 1, 3))
    assert standing.mean() == pytest.approx(gait.duty * legs, abs=0.02)


@pytest.mark.parametrize("legs", [4, 6, 8])
def test_no_two_neighbours_of_a_wave_swing_together(legs: int) -> None:
    gait = predefined_gaits(legs)["wave"]
    phases = (np.linspace(0.0, 1.0, 2000, endpoint=False)[:, None] + gait.offsets) % 1.0
    assert ((phases < gait.swing - 1e-9).sum(axis=1) <= 1).all()


@given(st.integers(3, 8), st.data())
def test_a_custom_gait_is_taken_as_described(legs: int, data: st.DataObject) -> None:
    content = load_robot("octopod").model_dump()
    content["legs"] = list(content["legs"])[:legs]
    names = [leg["name"] for leg in content["legs"]]
    offsets = {name: data.draw(st.floats(0.0, 0.999)) for name in names}
    content["custom_gaits"] = [{"name": "own", "duty": 0.7, "offsets": offsets}]
    content["gaits"] = ["own", "wave"]
    parts = content["body"]["mass"] + legs * sum(joint["mass"] for joint in content["joints"])
    robot = RobotDescription.model_validate(content | {"mass": parts})
    assert robot.gait("own").offset == tuple(offsets.values())
    assert list(robot.gait_table) == ["own", "wave"]


@pytest.mark.parametrize("name", robot_names())
def test_a_robot_has_the_gaits_it_lists_and_no_others(name: str) -> None:
    robot = load_robot(name)
    assert tuple(robot.gait_table) == robot.gaits
    with pytest.raises(ConfigurationError, match=f"gait 'gallop' is unknown; known are {robot.gaits[0]}"):
        robot.gait("gallop")
