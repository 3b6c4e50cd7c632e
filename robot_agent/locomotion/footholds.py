"""Footholds that somebody else has chosen for the next swings of single legs (OpenSHC'20, external targets)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.feet import REACH, SWING
from robot_agent.locomotion.walk_state import WalkState
from weaver_shared.transforms import Pose

Array = NDArray[Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class FootholdOrder:
    """Where the next swing of a leg is to end: the foot's centre, m, in body or in world."""

    leg: int
    serial: int  # another one for every order, so that each is carried out once
    place: tuple[float, float, float]
    in_world: bool = False


def orders_in_body(orders: Sequence[FootholdOrder], world_from_body: Pose) -> tuple[FootholdOrder, ...]:
    """The orders as the body sees them now; places in the world stay where they are while it moves."""
    body_from_world = world_from_body.inverse()
    return tuple(_in_body(order, body_from_world) if order.in_world else order for order in orders)


def _in_body(order: FootholdOrder, body_from_world: Pose) -> FootholdOrder:
    x, y, z = body_from_world.transform(np.array(order.place)).tolist()
    return replace(order, place=(x, y, z), in_world=False)


class Footholds:
    """Writes into the walker's memory which swings are to end where, once a tick."""

    def __init__(self, legs: int, state: WalkState) -> None:
        self._targeted, self._target = state.cut("orders", "targeted"), state.cut("orders", "target")
        self._aimed, self._mode = state.cut("feet", "aimed"), state.cut("feet", "mode")
        self._done = [-1] * legs  # serial of the last order each leg has carried out
        self._under_way = [-1] * legs
        self.idle = True

    def clear(self) -> None:
        self._targeted[:] = self._aimed[:] = 0
        self._under_way = [-1] * len(self._done)
        self.idle = True

    def step(self, orders: Sequence[FootholdOrder], unposed_from_body: Pose) -> None:
        """Take this tick's orders, in body. A swing that has begun keeps its target even when the order is gone."""
        wanted = {order.leg: order for order in orders if 0 <= order.leg < len(self._done)}
        for leg in range(len(self._done)):
            aiming = bool(self._aimed[leg]) and self._mode[leg] in (SWING, REACH)
            if self._aimed[leg] and not aiming:
                self._done[leg], self._aimed[leg] = self._under_way[leg], 0
            order = wanted.get(leg)
            fresh = order is not None and order.serial != self._done[leg] and bool(np.isfinite(order.place).all())
            if order is not None and fresh and not (aiming and order.serial != self._under_way[leg]):
                self._target[leg] = unposed_from_body.transform(np.array(order.place))
                self._under_way[leg] = order.serial
            self._targeted[leg] = fresh
        self.idle = not wanted and not self._aimed.any()
