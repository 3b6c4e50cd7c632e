"""Which footholds the operator, or a planner, has asked for, and until when."""

from __future__ import annotations

from math import isfinite

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.footholds import FootholdOrder
from robot_agent.locomotion.leg_reach import LegReach
from weaver_shared.errors import InputError
from weaver_shared.messages import Command
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

FRAMES = ("world", "body")
LONGEST = 30.0
"""s an order may wait for its swing."""
USUAL = 5.0


class FootholdDesk:
    """Methods take a command and return the value applied; they raise InputError with what is valid instead."""

    def __init__(self, robot: RobotDescription) -> None:
        self._names = robot.leg_names
        self._stride = robot.locomotion.largest_stride
        self._serial = 0
        self._orders: dict[int, tuple[FootholdOrder, int]] = {}  # and the instant it expires, robot clock, ns
        self.reach: LegReach | None = None
        self.world_from_body: Pose | None = None

    def orders(self, stamp_ns: int) -> tuple[FootholdOrder, ...]:
        """Those that have not expired."""
        for leg in [leg for leg, (_, end) in self._orders.items() if stamp_ns > end]:
            del self._orders[leg]
        return tuple(order for order, _ in self._orders.values())

    def clear(self) -> None:
        self._orders.clear()

    def place(self, command: Command, stamp_ns: int) -> float:
        """Name LEG.world or LEG.body, one waypoint for x and y, value for z (m): where its next swing is to end.

        Returns how far, m, that is from the foot's stance.
        """
        name, _, frame = command.name.partition(".")
        if name not in self._names:
            raise InputError(f"leg {name!r:.40} is unknown; known are {', '.join(self._names)}")
        if frame not in FRAMES:
            raise InputError(f"frame {frame!r:.40} of a foothold is unknown; known are {', '.join(FRAMES)}")
        if len(command.waypoints) != 1:
            raise InputError(
                f"a foothold is one waypoint for x and y, and a value for z; {len(command.waypoints)} came"
            )
        place = (command.waypoints[0].x, command.waypoints[0].y, command.value)
        seconds = command.seconds or USUAL
        if not (all(isfinite(part) for part in place) and isfinite(seconds)):
            raise InputError(f"the foothold {place} for {seconds} s is not all numbers")
        if not 0.0 < seconds <= LONGEST:
            raise InputError(f"a foothold waits for its swing above 0 and up to {LONGEST:.0f} s, not {seconds:g} s")
        further = self._stride if frame == "world" else 0.0
        away = self._refuse_unreachable(name, self._in_body(np.array(place), frame), further)
        self._serial += 1
        leg = self._names.index(name)
        order = FootholdOrder(leg=leg, serial=self._serial, place=place, in_world=frame == "world")
        self._orders[leg] = (order, stamp_ns + round(seconds * 1e9))
        return away

    def _in_body(self, place: NDArray[np.float64], frame: str) -> NDArray[np.float64] | None:
        """None where the robot does not know yet where it is."""
        if frame == "body":
            return place
        return None if self.world_from_body is None else self.world_from_body.inverse().transform(place)

    def _refuse_unreachable(self, name: str, place_in_body: NDArray[np.float64] | None, further: float) -> float:
        """Distance from the stance; `further` m is what the body may walk until the swing."""
        if place_in_body is None or self.reach is None:
            raise InputError("the robot does not know yet where it stands")
        away, edge = self.reach.beyond(self._names.index(name), place_in_body)
        if away > edge + further:
            raise InputError(
                f"the foothold lies {100 * away:.1f} cm from the stance of leg {name}, which walks up to "
                f"{100 * edge:.1f} cm from it in that direction"
            )
        z, low, high = place_in_body[2], self.reach.lowest, self.reach.highest
        if not low <= z <= high:
            raise InputError(f"the foothold lies at {z:.2f} m in body; {low:.2f} to {high:.2f} m are within reach")
        return away
