"""Legs in the operator's hands while the robot stands on the others (OpenSHC'20 IV-B, manual legs).

At most two at a time, and only while the mass stays well over the feet that are left.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.feet import STAND
from robot_agent.locomotion.held_leg import HeldLeg
from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.stability import static_margin
from robot_agent.locomotion.walk_state import WalkState
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]


class Manipulation:
    """Places the feet of held legs, and sets the joints of those turned directly, once a tick."""

    def __init__(self, names: tuple[str, ...], state: WalkState, config: LocomotionConfig, dt: float) -> None:
        self._names = names
        self._all_supporting = ("supporting",) * len(self._names)
        self._state = state
        self._config = config
        self._dt = dt
        self._mode = state.cut("feet", "mode")
        self._feet = state.cut("senses", "origins")[:, -1]
        self._centre, self._up = state.cut("senses", "centre_of_mass"), state.cut("senses", "up")
        self._told = state.cut("answer", "joint_position")  # of the last tick
        self._target_step = state.cut("model", "target_step")
        self._unposed_up = state.cut("senses", "unposed_up")
        self._legs: dict[int, HeldLeg] = {}
        self._all_supporting = ("supporting",) * len(names)
        self.reasons: tuple[str, ...] = ()

    @property
    def idle(self) -> bool:
        return not self._legs

    def clear(self) -> None:
        self._legs.clear()
        self.reasons = ()

    @property
    def stages(self) -> tuple[str, ...]:
        """What each leg is doing: supporting, lifting, held or lowering."""
        if not self._legs:
            return self._all_supporting
        return tuple(self._legs[leg].stage if leg in self._legs else "supporting" for leg in range(len(self._names)))

    def margin_without(self, leg: int) -> float:
        """Static margin, m, on the feet that carry now but this one."""
        carrying = self._mode == STAND
        carrying[leg] = False
        return float(static_margin(self._feet, carrying, self._centre, self._up))

    def step(self, orders: Sequence[LegOrder], pose: Pose) -> None:
        """Before the feet are placed: begin, move and end what is ordered; `pose` is unposed_from_body."""
        wanted = {order.leg: order for order in orders if 0 <= order.leg < len(self._names)}
        self.reasons = ()
        for leg, order in wanted.items():
            if leg not in self._legs and not self._begin(leg, pose):
                continue
            held = self._legs[leg]
            if held.stage == "lowering":
                held = self._legs[leg] = HeldLeg(leg, self._state, pose, self._config, self._dt)
            held.hold(order, pose, self._up)
            if held.short_of_reach:
                self.reasons += (f"leg {self._names[leg]} reaches no further",)
        for leg in [leg for leg in self._legs if leg not in wanted]:
            if self._legs[leg].lower(pose, self._up, self._unposed_up):
                del self._legs[leg]

    def _begin(self, leg: int, pose: Pose) -> bool:
        margin, needed = self.margin_without(leg), self._config.stability.lift_static
        if len(self._legs) >= self._config.manipulation.most_legs or margin < needed:
            self.reasons += (f"leg {self._names[leg]} is not lifted: {refusal(margin, needed)}",)
            return False
        self._legs[leg] = HeldLeg(leg, self._state, pose, self._config, self._dt)
        return True

    def turn_joints(self, wanted: Array, target: Array) -> None:
        """After the feet are followed: overwrite angles (legs, n) of legs whose joints are turned directly.

        Servos that were led have to come back to those angles no faster than they can.
        """
        for leg, held in self._legs.items():
            if held.angles is not None:
                wanted[leg] = held.angles
                last, step = self._told.reshape(wanted.shape)[leg], self._target_step
                target[leg] = np.clip(held.angles, last - step, last + step)


def refusal(margin: float, needed: float) -> str:
    """Why a leg may not be lifted with `margin` m left on the others."""
    return f"{100 * margin:.1f} cm of stability would be left on the others, {100 * needed:.1f} cm are needed"
