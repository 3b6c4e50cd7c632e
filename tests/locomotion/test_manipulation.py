"""Legs in the operator's hands: the others stand still, tips and joints go where asked, and come back."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.leg_order import LegOrder
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body

ROBOT = load_robot("weaver")
CONFIG = LocomotionConfig(feel_ground=False, compensate_servos=False)
HAND = CONFIG.manipulation
STANCE = ROBOT.stance_in_body
DT = 0.01
PARAMETERS = GaitParameters(
    stamp_ns=0, virtual_stiffness=2500.0, stride_frequency=1.0, stride_height=0.05, confidence=1.0
)


class Ideal:
    def __init__(self):
        self.walker = Walker(ROBOT, CONFIG, DT)
        self.joints = self.walker.begin_standing()

    def run(self, seconds, *legs, velocity=(0.0, 0.0, 0.0), stand=True):
        outs = []
        for _ in range(round(seconds / DT)):
            outs.append(
                self.walker.step(
                    WalkInput(
                        stamp_ns=0,
                        velocity=np.array(velocity),
                        parameters=PARAMETERS,
                        gait="tripod",
                        stand=stand,
                        joint_position=self.joints,
                        joint_torque=np.zeros(30),
                        foot_contact=np.ones(6, dtype=bool),
                        gravity_in_body=np.array([0.0, 0.0, -1.0]),
                        legs=legs,
                    )
                )
            )
            self.joints = outs[-1].joint_position
        return outs


@pytest.mark.parametrize("legs", [(0,), (4,), (1, 4), (0, 3), (5, 2)])
def test_one_or_two_legs_are_lifted_moved_and_put_back_while_the_others_stand_still(legs):
    ideal, others = Ideal(), [leg for leg in range(6) if leg not in legs]
    tip = (0.03, 0.01, 0.04)
    outs = ideal.run(4.0, *(LegOrder(leg=leg, tip=tip) for leg in legs))
    feet = feet_in_body(ROBOT, ideal.joints)
    for leg in legs:
        np.testing.assert_allclose(feet[leg], STANCE[leg] + tip + np.array([0.0, 0.0, HAND.lift_height]), atol=1e-4)
        assert outs[-1].leg_stages[leg] == "held"
    outs += ideal.run(6.0)
    assert set(outs[-1].leg_stages) == {"supporting"}
    np.testing.assert_allclose(feet_in_body(ROBOT, ideal.joints), STANCE, atol=1.5e-3)
    for out in outs:
        np.testing.assert_allclose(out.foot_in_body[others], STANCE[others], atol=1e-4)
        assert out.stability_margin > 0.02
    steps = np.diff([out.foot_in_body for out in outs], axis=0)
    assert np.linalg.norm(steps, axis=2).max() / DT < 1.5 * HAND.tip_speed


def test_a_leg_that_stability_needs_is_not_lifted_and_the_reason_is_said():
    ideal = Ideal()
    ideal.run(4.0, LegOrder(leg=4))
    margins = ideal.run(0.2, LegOrder(leg=4))[-1].lift_margins
    worst = int(np.argmin(margins))  # a neighbour: three of one side would be gone
    assert margins[worst] < CONFIG.stability.lift_static
    out = ideal.run(1.0, LegOrder(leg=4), LegOrder(leg=worst))[-1]
    assert out.leg_stages[worst] == "supporting"
    assert any("of stability would be left on the others" in reason for reason in out.reasons)


def test_no_more_than_two_legs_are_lifted():
    out = Ideal().run(3.0, LegOrder(leg=0), LegOrder(leg=3), LegOrder(leg=4))[-1]
    assert sum(stage != "supporting" for stage in out.leg_stages) == 2


def test_joints_are_turned_at_a_bounded_rate_and_the_leg_comes_back_the_same_way():
    ideal = Ideal()
    ideal.run(3.0, LegOrder(leg=5))
    before, nan = ideal.joints.reshape(6, 5).copy(), float("nan")
    turned = LegOrder(leg=5, joints=(0.4, nan, -1.2, nan, 9.0))
    outs = ideal.run(5.0, turned)
    angles = ideal.joints.reshape(6, 5)
    np.testing.assert_allclose(angles[5], [0.4, before[5, 1], -1.2, before[5, 3], ROBOT.joint_limits[4, 1]], atol=1e-9)
    rates = np.abs(np.diff([out.joint_position for out in outs], axis=0)).max() / DT
    assert rates <= HAND.joint_speed * (1 + 1e-9)
    outs = ideal.run(12.0)
    assert outs[-1].leg_stages[5] == "supporting"
    np.testing.assert_allclose(feet_in_body(ROBOT, ideal.joints), STANCE, atol=1.5e-3)
    rates = np.abs(np.diff([out.joint_position for out in outs], axis=0)).max() / DT
    assert rates < 2.0


def test_a_tip_beyond_reach_stops_within_it_and_says_so():
    ideal = Ideal()
    outs = ideal.run(6.0, LegOrder(leg=0, tip=(0.15, -0.15, 0.15)))
    assert "leg AR reaches no further" in outs[-1].reasons
    still = ideal.run(1.0, LegOrder(leg=0, tip=(0.15, -0.15, 0.15)))
    assert np.abs(still[-1].joint_position - still[0].joint_position).max() < 0.05
    near = ideal.run(4.0, LegOrder(leg=0, tip=(0.0, 0.0, 0.02)))[-1]
    assert "leg AR reaches no further" not in near.reasons


def test_a_held_tip_stays_off_the_ground():
    ideal = Ideal()
    lowest = min(out.foot_in_body[0, 2] for out in ideal.run(4.0, LegOrder(leg=0, tip=(0.0, 0.0, -0.15)))[200:])
    assert lowest > STANCE[0, 2] + 0.9 * HAND.ground_clearance


def test_nobody_walks_with_a_leg_in_hand_and_walking_follows_when_it_is_down():
    ideal = Ideal()
    outs = ideal.run(3.0, LegOrder(leg=0))
    outs = ideal.run(2.0, LegOrder(leg=0), velocity=(0.1, 0.0, 0.0))
    assert not any(out.velocity.any() for out in outs)
    outs = ideal.run(8.0, velocity=(0.1, 0.0, 0.0))
    assert outs[-1].posture == "walking"
    assert outs[-1].velocity[0] > 0.09


def test_sitting_down_lowers_the_legs_first():
    ideal = Ideal()
    ideal.run(3.0, LegOrder(leg=0))
    outs = ideal.run(10.0, LegOrder(leg=0), stand=False)
    assert outs[-1].posture == "sitting"
    lowering = next(i for i, out in enumerate(outs) if out.posture == "lowering")
    assert set(outs[lowering].leg_stages) == {"supporting"}


orders = st.builds(
    LegOrder,
    leg=st.integers(-2, 9),
    tip=st.tuples(*[st.one_of(st.floats(-0.3, 0.3), st.sampled_from([np.nan, np.inf]))] * 3),
    joints=st.one_of(st.none(), st.lists(st.floats(allow_nan=True), max_size=6).map(tuple)),
)


@settings(max_examples=15)
@given(st.lists(st.tuples(st.lists(orders, max_size=3), st.floats(0.05, 1.5), st.booleans()), max_size=6))
def test_no_order_makes_it_raise_or_leave_its_limits(sequence):
    ideal = Ideal()
    for legs, seconds, stand in sequence:
        for out in ideal.run(seconds, *legs, stand=stand):
            angles = out.joint_position.reshape(6, 5)
            assert np.isfinite(angles).all()
            assert (angles >= ROBOT.joint_limits[:, 0] - 1e-9).all()
            assert (angles <= ROBOT.joint_limits[:, 1] + 1e-9).all()
