"""A robot that is asked to walk and stays where it is, is stuck; one that sways, turns or waits its turn is not."""

import numpy as np
import pytest

from robot_agent.headway import HEADING, PLACE, Headway
from weaver_shared.config.command import CommandLimits
from weaver_shared.transforms import Pose, rotation_z

SECOND = 1_000_000_000
PATIENCE = CommandLimits().stuck_seconds


def pose(x=0.0, y=0.0, yaw=0.0):
    return Pose(rotation=rotation_z(yaw), position=np.array([x, y, 0.2]))


def ever_stuck(headway, poses):
    """One pose a second."""
    return [headway.stuck(at, second * SECOND) for second, at in enumerate(poses)]


def test_standing_on_one_spot_is_stuck_after_the_patience_and_not_before():
    told = ever_stuck(Headway(), [pose(2.0, 1.0)] * int(PATIENCE + 3))
    assert told.index(True) == int(PATIENCE) + 1


def test_swaying_about_a_place_is_no_way():
    swaying = [pose(0.4 * PLACE * np.sin(t), 0.4 * PLACE * np.cos(t), 0.3 * HEADING * np.sin(t)) for t in range(60)]
    assert ever_stuck(Headway(), swaying)[-1]


@pytest.mark.parametrize("poses", [[pose(0.01 * t) for t in range(200)], [pose(yaw=0.03 * t) for t in range(200)]])
def test_a_slow_walk_and_a_slow_turn_get_on(poses):
    assert not any(ever_stuck(Headway(), poses))


def test_a_rest_begins_the_time_anew():
    headway = Headway()
    for second in range(int(PATIENCE)):
        assert not headway.stuck(pose(), second * SECOND)
    headway.rest()
    assert not headway.stuck(pose(), int(PATIENCE + 2) * SECOND)
