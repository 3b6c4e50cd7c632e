"""Nothing passes to the servos that is not finite, within limits and within reach of their speed."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from robot_agent.body import JointTargets
from robot_agent.limits import JointGate
from weaver_shared.robots import load_robot

ROBOT = load_robot()
LOWER = np.tile(ROBOT.joint_limits[:, 0], ROBOT.leg_count)
UPPER = np.tile(ROBOT.joint_limits[:, 1], ROBOT.leg_count)
anything = st.floats(allow_nan=True, allow_infinity=True)


def targets(position: np.ndarray, *, torque_on: bool = True) -> JointTargets:
    return JointTargets(stamp_ns=0, position=position, torque_limit=np.full(30, np.inf), torque_on=torque_on)


@given(arrays(np.float64, (5, 30), elements=anything))
def test_any_sequence_of_targets_leaves_as_limited_ones(sequence: np.ndarray) -> None:
    gate = JointGate(ROBOT)
    last = np.zeros(30)
    for position in sequence:
        sent = gate.pass_on(targets(position), np.zeros(30), 0.01)
        assert np.isfinite(sent.position).all()
        assert np.isfinite(sent.torque_limit).all()
        assert ((sent.position >= LOWER) & (sent.position <= UPPER)).all()
        assert (np.abs(sent.position - last) <= 0.0818).all()
        last = sent.position


def test_switching_on_begins_where_the_joints_are() -> None:
    gate = JointGate(ROBOT)
    measured = np.full(30, 0.2)
    gate.pass_on(targets(np.zeros(30), torque_on=False), measured, 0.01)
    first = gate.pass_on(targets(np.full(30, 0.9)), measured, 0.01)
    assert np.abs(first.position - measured).max() < 0.09


def test_a_good_target_passes_unchanged() -> None:
    position = np.full(30, 0.01)
    sent = JointGate(ROBOT).pass_on(targets(position), np.zeros(30), 0.01)
    np.testing.assert_array_equal(sent.position, position)
