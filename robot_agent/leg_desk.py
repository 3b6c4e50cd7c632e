"""Which legs the operator has taken in hand, and what is asked of them."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite

from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.manipulation import refusal
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.errors import InputError
from weaver_shared.messages import Command
from weaver_shared.robots import RobotDescription

AXES = ("x", "y", "z")


class LegDesk:
    """Every method takes a command and returns the value applied; all raise InputError with what is valid instead."""

    def __init__(self, robot: RobotDescription, config: LocomotionConfig) -> None:
        self._robot = robot
        self._config = config
        self._orders: dict[int, LegOrder] = {}
        self.lift_margins: tuple[float, ...] = ()  # m of stability without each leg; empty while it does not stand

    @property
    def orders(self) -> tuple[LegOrder, ...]:
        return tuple(self._orders.values())

    def clear(self) -> None:
        self._orders.clear()

    def lift(self, command: Command) -> float:
        """Take a leg off the ground; refused while that would leave too little stability."""
        leg, most = self._leg(command.name), self._config.manipulation.most_legs
        if leg in self._orders:
            return 0.0
        if len(self._orders) >= most:
            raise InputError(f"at most {most} legs may be lifted at a time; lower one first")
        if not self.lift_margins:
            raise InputError("legs are lifted only while the robot stands still")
        margin, needed = self.lift_margins[leg], self._config.stability.lift_static
        if margin < needed:
            raise InputError(f"leg {command.name} is not lifted: {refusal(margin, needed)}")
        self._orders[leg] = LegOrder(leg=leg)
        return margin

    def lower(self, command: Command) -> float:
        """Put a leg back, or all of them without a name."""
        if command.name:
            del self._orders[self._held(command.name)]
        else:
            self.clear()
        return 0.0

    def move_tip(self, command: Command) -> float:
        """Name LEG.x, LEG.y or LEG.z: its tip's place in m, in body, from where it was lifted to."""
        name, _, axis = command.name.partition(".")
        leg = self._held(name)
        if axis not in AXES:
            raise InputError(f"axis {axis!r:.40} of a tip is unknown; known are {', '.join(AXES)}, as in {name}.x")
        largest = self._config.manipulation.largest_tip
        tip = list(self._orders[leg].tip)
        tip[AXES.index(axis)] = applied = min(max(_number(command), -largest), largest)
        self._orders[leg] = replace(self._orders[leg], tip=(tip[0], tip[1], tip[2]), joints=None)
        return applied

    def move_joint(self, command: Command) -> float:
        """Name LEG_joint: its angle in rad, within the joint's limits; the leg's other joints stay as asked."""
        if command.name not in self._robot.joint_names:
            raise InputError(f"joint {command.name!r:.40} is unknown; known are {', '.join(self._robot.joint_names)}")
        leg, joint = divmod(self._robot.joint_names.index(command.name), self._robot.joints_per_leg)
        self._held(self._robot.leg_names[leg])
        lower, upper = self._robot.walking_limits[joint]
        applied = float(min(max(_number(command), lower), upper))
        angles = list(self._orders[leg].joints or [float("nan")] * self._robot.joints_per_leg)  # NaN: as it is
        angles[joint] = applied
        self._orders[leg] = replace(self._orders[leg], joints=tuple(angles))
        return applied

    def _leg(self, name: str) -> int:
        if name not in self._robot.leg_names:
            raise InputError(f"leg {name!r:.40} is unknown; known are {', '.join(self._robot.leg_names)}")
        return self._robot.leg_names.index(name)

    def _held(self, name: str) -> int:
        leg = self._leg(name)
        if leg not in self._orders:
            raise InputError(f"leg {name} is not lifted; lift it first")
        return leg


def _number(command: Command) -> float:
    if not isfinite(command.value):
        raise InputError(f"{command.name} {command.value:g} is not a number")
    return command.value
