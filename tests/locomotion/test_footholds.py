"""A foot swings to the place that was asked for, once, and never out of its walkspace."""

import numpy as np
import pytest

from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.footholds import FootholdOrder, orders_in_body
from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose, rotation_z

ROBOT = load_robot("weaver")
LEG = 1
DT = 0.01
OUT_OF_REACH = "a foothold asked for is out of reach"


class Walk:
    def __init__(self, gait="ripple"):
        self.walker = Walker(ROBOT, LocomotionConfig(feel_ground=False, compensate_servos=False), DT)
        self.joints, self.gait = self.walker.begin_standing(), gait
        self.world_from_body = Pose.identity()

    def tick(self, footholds=(), velocity=(0.05, 0.0, 0.0), posing=NO_POSING):
        self.out = self.walker.step(
            WalkInput(
                stamp_ns=0,
                velocity=np.array(velocity),
                parameters=GaitParameters(
                    stamp_ns=0, virtual_stiffness=2000.0, stride_frequency=0.5, stride_height=0.05, confidence=1.0
                ),
                gait=self.gait,
                stand=True,
                joint_position=self.joints,
                joint_torque=np.zeros(30),
                foot_contact=np.ones(6, dtype=np.bool_),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
                posing=posing,
                footholds=orders_in_body(footholds, self.world_from_body),
            )
        )
        self.joints = self.out.joint_position
        vx, vy, turn = self.out.velocity
        step = Pose(rotation=rotation_z(turn * DT), position=np.array([vx * DT, vy * DT, 0.0]))
        self.world_from_body = self.world_from_body @ step
        return self.out

    def landings(self, seconds, footholds=(), **changes):
        """Where the leg touches down, in body, each time, and all reasons."""
        places, reasons, swung = [], set(), self.out.swing[LEG] if hasattr(self, "out") else False
        for _ in range(round(seconds / DT)):
            out = self.tick(footholds, **changes)
            reasons |= set(out.reasons)
            if swung and not out.swing[LEG]:
                places.append(out.foot_in_body[LEG].copy())
            swung = out.swing[LEG]
        return places, reasons


def order(offset, serial=0, **changes):
    return FootholdOrder(leg=LEG, serial=serial, place=tuple(ROBOT.stance_in_body[LEG] + offset), **changes)


def test_one_swing_ends_where_it_was_asked_to_and_the_next_where_the_gait_wants():
    offset = np.array([0.03, -0.04, 0.02])
    places, reasons = Walk().landings(7.0, (order(offset),))
    np.testing.assert_allclose(places[0], ROBOT.stance_in_body[LEG] + offset, atol=2e-3)
    assert abs(places[1][1] - ROBOT.stance_in_body[LEG][1]) < 2e-3
    assert OUT_OF_REACH not in reasons


def test_another_order_is_carried_out_by_the_swing_after():
    walk = Walk()
    walk.landings(3.5, (order([0.03, 0.02, 0.0]),))
    places, _ = walk.landings(3.0, (order([0.0, -0.03, 0.0], serial=1),))
    np.testing.assert_allclose(places[-1], ROBOT.stance_in_body[LEG] + [0.0, -0.03, 0.0], atol=2e-3)


def test_a_place_in_the_world_stays_there_while_the_body_walks():
    walk = Walk()
    walk.landings(2.2)
    place = walk.world_from_body.transform(ROBOT.stance_in_body[LEG] + [0.06, -0.02, 0.0])
    wanted = FootholdOrder(leg=LEG, serial=0, place=tuple(place.tolist()), in_world=True)
    for _ in range(400):
        swung = walk.out.swing[LEG]
        out = walk.tick((wanted,))
        if swung and not out.swing[LEG]:
            landed = walk.world_from_body.transform(out.foot_in_body[LEG])
            np.testing.assert_allclose(landed, place, atol=3e-3)
            return
    pytest.fail("the leg never swung")


def test_what_is_out_of_reach_becomes_the_edge_of_the_walkspace_and_is_said():
    walk = Walk()
    places, reasons = walk.landings(3.5, (order([0.0, -0.5, 0.0]),))
    away, edge = walk.walker.leg_reach.beyond(LEG, places[0])
    assert away == pytest.approx(edge, rel=0.03)
    assert OUT_OF_REACH in reasons


def test_a_swing_under_way_keeps_its_target_when_the_order_goes_or_changes():
    walk, other = Walk(), order([-0.02, 0.03, 0.0], serial=1)
    wanted = order([0.03, -0.04, 0.0])
    while not (hasattr(walk, "out") and walk.out.swing[LEG]):
        walk.tick((wanted,))
    for _ in range(10):
        walk.tick((wanted,))
    places, _ = walk.landings(1.0, (other,))
    np.testing.assert_allclose(places[0], ROBOT.stance_in_body[LEG] + [0.03, -0.04, 0.0], atol=2e-3)


def test_feet_move_without_jumps_through_ordered_swings():
    walk, fastest = Walk(), 0.0
    feet = None
    for tick in range(900):
        offset = 0.05 * np.array([np.cos(tick // 150), np.sin(tick // 150), 0.0])
        out = walk.tick((order(offset, serial=tick // 150),))
        if feet is not None:
            fastest = max(fastest, np.linalg.norm(out.foot_in_body - feet, axis=1).max() / DT)
        feet = out.foot_in_body
    assert fastest < 1.2


def test_a_posed_body_puts_the_foot_where_it_sees_the_place():
    walk, posed = Walk(), PosingOrder(manual=(0.0, 0.0, 0.01, 0.03, 0.0, 0.05))
    walk.landings(2.0, velocity=(0.0, 0.0, 0.0), posing=posed)
    offset = np.array([0.02, -0.03, 0.0])
    places, _ = walk.landings(3.5, (order(offset),), posing=posed)
    np.testing.assert_allclose(places[0], ROBOT.stance_in_body[LEG] + offset, atol=3e-3)


@pytest.mark.parametrize("bad", [(np.nan, 0.0, 0.0), (np.inf, 0.0, 0.0)])
def test_places_that_are_no_numbers_and_legs_that_are_none_change_nothing(bad):
    walk = Walk()
    strange = (FootholdOrder(leg=LEG, serial=0, place=bad), FootholdOrder(leg=77, serial=0, place=(0.0, 0.0, 0.0)))
    places, _ = walk.landings(3.5, strange)
    assert abs(places[0][1] - ROBOT.stance_in_body[LEG][1]) < 2e-3
