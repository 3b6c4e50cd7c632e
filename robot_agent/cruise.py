"""Cruise control: a velocity held for a time or until it is ended, without anyone's hand on the stick."""

from __future__ import annotations

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.command import CommandLimits
from weaver_shared.errors import InputError
from weaver_shared.messages import Command

AXES = ("forward", "left", "turn")
STICK = "stick"


class Cruise:
    """Times are the robot's clock, so a slow simulation cruises as far as a fast one."""

    def __init__(self, limits: CommandLimits) -> None:
        self._largest = np.array([limits.teleop_forward, limits.teleop_left, limits.teleop_turn])
        self._longest = limits.cruise_seconds
        self._velocity = np.zeros(3)
        self._until_ns = 0

    def start(self, command: Command, stick: NDArray[np.float64] | None, now_ns: int) -> float:
        """Hold one axis (forward and left in m/s, turn in rad/s) at a value, or all as the stick is now.

        Returns the value applied after clamping. Raises InputError with what is valid.
        """
        seconds = command.seconds or self._longest
        if not (isfinite(seconds) and 0.0 < seconds <= self._longest):
            raise InputError(f"a cruise lasts above 0 and up to {self._longest:.0f} s")
        velocity = self._velocity.copy() if self.velocity(now_ns) is not None else np.zeros(3)
        if command.name == STICK:
            if stick is None:
                raise InputError("the stick is not held: there is no velocity to keep")
            velocity, applied = stick.copy(), float(np.hypot(stick[0], stick[1]))
        elif command.name in AXES:
            if not isfinite(command.value):
                raise InputError(f"{command.name} {command.value:g} is not a number")
            axis = AXES.index(command.name)
            velocity[axis] = np.clip(command.value, -self._largest[axis], self._largest[axis])
            applied = float(velocity[axis])
        else:
            raise InputError(f"cruise {command.name!r:.40} is unknown; known are {', '.join((*AXES, STICK))}")
        self._velocity, self._until_ns = velocity, now_ns + round(seconds * 1e9)
        return applied

    def stop(self) -> None:
        self._until_ns = 0

    def velocity(self, now_ns: int) -> NDArray[np.float64] | None:
        """The velocity (3,) to hold at the robot's time `now_ns`, None when there is none."""
        return self._velocity.copy() if now_ns < self._until_ns else None

    def seconds_left(self, now_ns: int) -> float:
        """s until the cruise ends by itself, 0 without one."""
        return max(0.0, (self._until_ns - now_ns) * 1e-9)
