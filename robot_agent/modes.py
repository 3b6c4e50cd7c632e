"""The robot's states: OFF, READY, STAND, WALK, SIT, HOLD, FAULT, ESTOP, and what each permits."""

from __future__ import annotations

from dataclasses import dataclass

from robot_agent.orders import Orders
from robot_agent.safety import Verdict
from weaver_shared.messages import SafetyAction


@dataclass(frozen=True, slots=True, kw_only=True)
class Permission:
    """What the tick may do: `stand` is the posture asked of the walker, `walk` whether it may be given a velocity."""

    mode: str
    torque_on: bool
    stand: bool
    walk: bool
    settled: bool  # a latched stop has come to its end: seated or without torque


class ModeMachine:
    """Combines the operator's orders with the verdict of safety and the posture the walker has reached."""

    def __init__(self, *, torque_on: bool = False) -> None:
        self._torque_on = torque_on
        self._fallen = False

    def step(self, orders: Orders, verdict: Verdict, posture: str) -> Permission:
        seated = posture == "sitting"
        if verdict.action is SafetyAction.CUT or orders.stop_level or self._fallen:
            return self._stopped(orders, verdict, seated)
        if verdict.action is SafetyAction.SIT or not orders.stand:
            if not seated:
                return self._permission("SIT")
            return self._permission("READY" if self._torque_on else "OFF", settled=True)
        if verdict.action is SafetyAction.HOLD:
            if seated and not self._torque_on:
                return self._permission("OFF")
            return self._permission("HOLD", stand=not seated)
        self._torque_on = True
        moving = posture == "walking" or orders.mission_active or orders.teleop_velocity is not None
        upright = posture in ("standing", "walking")
        return self._permission("WALK" if moving and upright else "STAND", stand=True, walk=upright)

    def _stopped(self, orders: Orders, verdict: Verdict, seated: bool) -> Permission:
        """Cut, the latched stop, and the time after a fall until the order that stood has been withdrawn."""
        if verdict.action is SafetyAction.CUT:
            self._torque_on = False
            self._fallen = not orders.stop_level
        elif orders.stop_level:
            self._torque_on = self._torque_on and not seated
        else:
            self._fallen = orders.stand
        mode = "ESTOP" if orders.stop_level else "FAULT"
        return self._permission(mode, settled=not self._torque_on)

    def _permission(self, mode: str, *, stand: bool = False, walk: bool = False, settled: bool = False) -> Permission:
        return Permission(mode=mode, torque_on=self._torque_on, stand=stand, walk=walk, settled=settled)


def way_out(permission: Permission, verdict: Verdict) -> tuple[str, ...]:
    """What an operator has left to do when the torque was cut and nothing is wrong any more."""
    ended = permission.mode == "FAULT" and verdict.action is not SafetyAction.CUT
    return ("what cut the torque is over: Sit takes the order to stand back, then Stand",) if ended else ()
