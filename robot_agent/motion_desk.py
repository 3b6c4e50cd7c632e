"""What the operator wants of body and legs beyond walking. Answers are a value really applied, or why not."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from math import isfinite

from robot_agent.locomotion.posing.order import AXES, NO_POSING, PosingOrder, bounded
from robot_agent.locomotion.posture_order import NO_POSTURE_ORDER, PostureOrder
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.errors import InputError
from weaver_shared.messages import Command
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.counterpart import counterpart_of

START_UPS = ("direct", "sequence")
SWITCHES = ("automatic", "levelling")


class MotionDesk:
    """Every method takes a command and returns the value applied; all raise InputError with what is valid instead."""

    def __init__(self, robot: RobotDescription, config: LocomotionConfig | None = None) -> None:
        self._robot = robot
        self._config = config or robot.locomotion
        other = counterpart_of(robot)
        self._postures = [one.posture.name for one in (robot, other) if one is not None and one.posture is not None]
        self.posing: PosingOrder = NO_POSING
        self.in_sequence = False
        self.pack = False
        self.posture: PostureOrder = NO_POSTURE_ORDER

    def set_pose(self, command: Command) -> float:
        """One axis of the body's pose: x, y, z in m, roll, pitch, yaw in rad; clamped to what may be asked."""
        axis = self._axis(command.name)
        if not isfinite(command.value):
            raise InputError(f"{command.name} {command.value:g} is not a number")
        manual = list(self.posing.manual)
        manual[axis] = command.value
        applied = bounded(tuple(manual), self._config.posing)
        self._take(applied)
        return float(applied[axis])

    def clear_pose(self, command: Command) -> float:
        """One axis, or without a name all, back to zero."""
        kept = list(self.posing.manual) if command.name else [0.0] * len(AXES)
        if command.name:
            kept[self._axis(command.name)] = 0.0
        self._take(kept)
        return 0.0

    def set_posing(self, command: Command) -> float:
        """Switch automatic posing or levelling on (1) or off (0)."""
        if command.name not in SWITCHES:
            raise InputError(f"posing {command.name!r:.40} is unknown; known are {', '.join(SWITCHES)}")
        if command.value not in (0.0, 1.0):
            raise InputError(f"posing {command.name} is 1 for on or 0 for off, not {command.value:g}")
        on = command.value == 1.0
        if command.name == "automatic":
            self.posing = replace(self.posing, automatic=on)
        else:
            self.posing = replace(self.posing, levelling=on)
        return command.value

    def set_start_up(self, command: Command) -> float:
        """How to stand up and sit down from now on."""
        if command.name not in START_UPS:
            raise InputError(f"start-up {command.name!r:.40} is unknown; known are {', '.join(START_UPS)}")
        self.in_sequence = command.name == "sequence"
        return 0.0

    def choose_sitting(self, command: Command) -> float:
        """Whether to fold the legs away after sitting down."""
        if command.name not in ("", "pack"):
            raise InputError(f"a robot sits with the name pack or none, not {command.name!r:.40}")
        if command.name and self._robot.packed_joints is None:
            raise InputError(f"robot {self._robot.name} can not be packed: its description has no packed joint angles")
        self.pack = command.name == "pack"
        return 0.0

    def change_posture(self, command: Command, refusal: str) -> float:
        """Move the legs into another posture; `refusal` says why they can not now, empty when they can."""
        if not self._postures:
            raise InputError(f"robot {self._robot.name} has one posture only")
        if command.name not in self._postures:
            raise InputError(f"posture {command.name!r:.40} is unknown; known are {', '.join(self._postures)}")
        if refusal:
            raise InputError(refusal)
        self.posture = PostureOrder(name=command.name, serial=self.posture.serial + 1)
        return 0.0

    def _take(self, manual: Iterable[float]) -> None:
        x, y, z, roll, pitch, yaw = map(float, manual)
        self.posing = replace(self.posing, manual=(x, y, z, roll, pitch, yaw))

    def _axis(self, name: str) -> int:
        if name not in AXES:
            raise InputError(f"axis {name!r:.40} is unknown; known are {', '.join(AXES)}")
        return AXES.index(name)
