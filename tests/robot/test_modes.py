"""Modes follow orders as far as safety lets them; torque comes back only by a new order."""

import dataclasses

import pytest

from robot_agent.modes import ModeMachine, Permission, way_out
from robot_agent.orders import idle_orders
from robot_agent.safety import Verdict
from weaver_shared.messages import SafetyAction

STANDING_ORDERS = dataclasses.replace(idle_orders(), stand=True, attended=True, operator_silence=0.0)


def verdict(action: SafetyAction = SafetyAction.ALLOW) -> Verdict:
    return Verdict(action=action, reasons=() if action is SafetyAction.ALLOW else ("why",), warnings=())


def standing_machine() -> ModeMachine:
    machine = ModeMachine()
    for posture in ("sitting", "rising", "standing"):
        machine.step(STANDING_ORDERS, verdict(), posture)
    return machine


def step(machine: ModeMachine, posture: str, action: SafetyAction = SafetyAction.ALLOW, **orders: object) -> Permission:
    return machine.step(dataclasses.replace(STANDING_ORDERS, **orders), verdict(action), posture)


def test_a_robot_without_orders_is_off() -> None:
    permission = ModeMachine().step(idle_orders(), verdict(), "sitting")
    assert (permission.mode, permission.torque_on, permission.walk) == ("OFF", False, False)


def test_standing_up_comes_before_walking() -> None:
    machine = ModeMachine()
    rising = step(machine, "rising", mission_active=True)
    assert (rising.mode, rising.torque_on, rising.stand, rising.walk) == ("STAND", True, True, False)
    standing = step(machine, "standing", mission_active=True)
    assert (standing.mode, standing.walk) == ("WALK", True)


def test_sitting_down_keeps_the_torque_on() -> None:
    machine = standing_machine()
    assert step(machine, "lowering", stand=False).mode == "SIT"
    seated = step(machine, "sitting", stand=False)
    assert (seated.mode, seated.torque_on) == ("READY", True)


def test_a_hold_stops_walking_and_keeps_standing() -> None:
    held = step(standing_machine(), "walking", SafetyAction.HOLD, mission_active=True)
    assert (held.mode, held.stand, held.walk, held.torque_on) == ("HOLD", True, False, True)


def test_a_hold_keeps_a_seated_robot_down() -> None:
    held = ModeMachine().step(STANDING_ORDERS, verdict(SafetyAction.HOLD), "sitting")
    assert (held.mode, held.torque_on, held.stand) == ("OFF", False, False)


def test_the_stop_lowers_the_robot_before_it_cuts_the_torque() -> None:
    machine = standing_machine()
    lowering = step(machine, "lowering", SafetyAction.SIT, stop_level="settle", stand=False)
    assert (lowering.mode, lowering.torque_on, lowering.walk, lowering.settled) == ("ESTOP", True, False, False)
    seated = step(machine, "sitting", SafetyAction.SIT, stop_level="settle", stand=False)
    assert (seated.mode, seated.torque_on, seated.settled) == ("ESTOP", False, True)
    released = step(machine, "sitting", stand=False)
    assert (released.mode, released.torque_on) == ("OFF", False)


@pytest.mark.parametrize(("stop_level", "mode"), [("cut", "ESTOP"), ("", "FAULT")])
def test_a_cut_takes_the_torque_at_once(stop_level: str, mode: str) -> None:
    cut = step(standing_machine(), "walking", SafetyAction.CUT, stop_level=stop_level)
    assert (cut.mode, cut.torque_on, cut.walk) == (mode, False, False)


def test_after_a_fall_the_old_order_to_stand_is_void() -> None:
    machine = standing_machine()
    step(machine, "standing", SafetyAction.CUT)
    assert step(machine, "sitting").mode == "FAULT"
    assert not step(machine, "sitting").torque_on
    assert way_out(step(machine, "sitting"), verdict(SafetyAction.CUT)) == ()
    assert "Sit takes the order to stand back" in way_out(step(machine, "sitting"), verdict())[0]
    step(machine, "sitting", stand=False)
    assert way_out(step(machine, "sitting", stand=False), verdict()) == ()
    assert step(machine, "sitting", stand=False).mode == "OFF"
    assert step(machine, "sitting").torque_on
