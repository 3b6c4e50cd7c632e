"""A foot that finds no ground below looks for it beside; the others wait, and stand, meanwhile."""

import numpy as np
import pytest

from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.feet import HANG, REACH
from robot_agent.locomotion.ground_search import DOWN, PLACES
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot

ROBOT = load_robot()
DT = 0.01
LEVEL = float(ROBOT.stance_in_body[0, 2])  # m, of the ground in body
EDGE = 0.26  # m to the right, beyond which there is none: the right feet stand farther out
SECONDS = 40.0


class OnGround:
    """A walker without a body: feet are where it wants them, and touch where `has_ground` (legs,) at ground level."""

    def __init__(self, has_ground):
        self.walker = Walker(ROBOT, dt=DT)
        self.joints = self.walker.begin_standing()
        self.feet, self.has_ground = ROBOT.stance_in_body.copy(), has_ground
        self.modes = self.walker._state.cut("feet", "mode")

    def tick(self, velocity):
        touches = (self.feet[:, 2] <= LEVEL + 1e-3) & self.has_ground(self.feet)
        out = self.walker.step(
            WalkInput(
                stamp_ns=0,
                joint_position=self.joints,
                joint_torque=np.zeros(ROBOT.joint_count),
                foot_contact=touches,
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
                velocity=np.array(velocity),
                parameters=GaitParameters(
                    stamp_ns=0, virtual_stiffness=2500.0, stride_frequency=0.8, stride_height=0.06, confidence=1.0
                ),
                gait="tripod",
                stand=True,
            )
        )
        self.joints, self.feet = out.joint_position, out.foot_in_body
        return out, touches


def right_of_the_edge(feet):
    return feet[:, 1] > -EDGE


@pytest.fixture(scope="module")
def along_an_edge():
    """Modes (ticks, legs), touches and the places of the right front foot, on a walk along the edge of the ground."""
    robot, rows = OnGround(right_of_the_edge), []
    for _ in range(round(SECONDS / DT)):
        _, touches = robot.tick((0.05, 0.0, 0.0))
        rows.append((robot.modes[:6].copy(), touches, robot.feet[0].copy()))
    modes, touches, feet = zip(*rows, strict=True)
    return np.array(modes), np.array(touches), np.array(feet)


def test_a_foot_beyond_an_edge_is_put_down_nearer_to_the_body(along_an_edge):
    modes, touches, feet = along_an_edge
    assert not (modes == HANG).any()
    stands = touches[:, 0] & (modes[:, 0] == 0)
    assert stands[200:].mean() > 0.3
    assert (feet[stands][200:, 1] > -EDGE - 1e-3).all()


def test_no_foot_lifts_while_another_looks_for_ground(along_an_edge):
    modes, _, _ = along_an_edge
    searching = (modes == REACH).any(axis=1)
    lifted = (np.diff(modes, axis=0) == 1) & (modes[:-1] == 0)
    assert searching.sum() > 100
    assert not lifted[searching[:-1]].any()


def test_the_robot_gets_on_along_an_edge():
    robot, way = OnGround(right_of_the_edge), 0.0
    for _ in range(round(SECONDS / DT)):
        out, _ = robot.tick((0.05, 0.0, 0.0))
        way += float(out.velocity[0]) * DT
    assert way > 0.2


def test_where_there_is_no_ground_at_all_the_foot_gives_up_after_some_places():
    robot = OnGround(lambda feet: np.arange(6) != 0)
    gave_up = tried = 0
    for tick in range(round(SECONDS / DT)):
        robot.tick((0.05, 0.0, 0.0))
        tried = max(tried, int(robot.walker._state.cut("feet", "tried")[0]))
        if robot.modes[0] == HANG:
            gave_up = tick * DT
            break
    assert tried == PLACES
    assert 2.0 < gave_up < 25.0


def test_a_stop_ends_the_search():
    robot = OnGround(lambda feet: np.arange(6) != 0)
    seeking = robot.walker._state.cut("feet", "seeking")
    while seeking[0] == DOWN:
        robot.tick((0.05, 0.0, 0.0))
    for _ in range(round(3.0 / DT)):
        out, _ = robot.tick((0.0, 0.0, 0.0))
    assert out.posture == "standing"
    assert robot.modes[0] == HANG
