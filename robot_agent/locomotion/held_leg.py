"""One leg lifted off the ground for handling things with, by its tip or by its joints.

It goes back the way it came: to where it was lifted to, over the place where it stood, and down until it touches.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.feet import HELD, STAND
from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.posing.slew import Slew
from robot_agent.locomotion.rising import Glide
from robot_agent.locomotion.walk_state import WalkState
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

ARRIVED = 1e-3  # m
REACHED = 1e-4  # m that inverse kinematics may leave


class HeldLeg:
    """One leg from lift-off to touch-down; `angles` (n,) is set while its joints are turned directly."""

    def __init__(self, leg: int, state: WalkState, pose: Pose, config: LocomotionConfig, dt: float) -> None:
        self.leg = leg
        self.stage = "lifting"
        self._config = hand = config.manipulation
        self._touchdown_speed, self._reach_down = config.foothold.touchdown_speed, config.foothold.reach_down
        self._feels = config.feel_ground
        self._dt = dt
        self._limits = state.cut("model", "limits")
        self._place = state.cut("feet", "place")[leg]
        self._anchor = state.cut("feet", "anchor")[leg]
        self._mode = state.cut("feet", "mode")
        self._plane = state.cut("body", "plane")
        self._contact = state.cut("senses", "contact")
        self._wanted = state.cut("joint", "wanted")[leg]
        self._left = state.cut("joint", "distance_left")
        self._slew = Slew((hand.tip_speed, 1.0), config.posing.smoothing, dt)
        self._tip = (0.0, 0.0, 0.0)
        self._reached = np.zeros(6)
        self._end: Array | None = None
        self._begun = pose.inverse().transform(self._place)  # m in body
        self._home: Array | None = None  # angles from which the joints were taken
        self._return: Glide | None = None
        self.angles: Array | None = None
        self.short_of_reach = False
        self._mode[leg] = HELD

    def hold(self, order: LegOrder, pose: Pose, up_in_body: Array) -> None:
        """One tick towards an order; `pose` is unposed_from_body."""
        joints = order.joints is not None and len(order.joints) == self._wanted.size and self.stage == "held"
        if joints:
            self._turn_joints(order)
        elif self._home is None or self._return_joints():
            self._move_tip(order.tip, pose, up_in_body)

    def lower(self, pose: Pose, up_in_body: Array, unposed_up: Array) -> bool:
        """One tick back to the ground; True when the foot stands again."""
        if self._home is not None and not self._return_joints():
            return False
        self.stage = "lowering"
        above = self._anchor + self._config.lift_height * unposed_up
        away = above - self._place
        across = away - (away @ unposed_up) * unposed_up
        if np.linalg.norm(across) > ARRIVED:
            step = self._config.tip_speed * self._dt
            self._place += away * min(1.0, step / float(np.linalg.norm(away)))
            return False
        self._place += across - self._touchdown_speed * self._dt * unposed_up
        below = float((self._anchor - self._place) @ unposed_up)
        if (self._feels and self._contact[self.leg]) or below > (self._reach_down if self._feels else 0.0):
            self._mode[self.leg] = STAND
            return True
        return False

    def _move_tip(self, tip: tuple[float, float, float], pose: Pose, up_in_body: Array) -> None:
        wanted = np.zeros(6)
        wanted[:3] = self._config.lift_height * up_in_body
        if self.stage == "held":
            wanted[:3] += np.clip(np.nan_to_num(tip), -self._config.largest_tip, self._config.largest_tip)
        if tip != self._tip:
            self._tip, self._end = tip, None
        if self._left[self.leg] <= REACHED:
            self._reached = self._slew.value.copy()
        elif self._end is None:
            self._end = self._reached  # back to where it was within reach, until another place is asked for
        self.short_of_reach = self._end is not None
        if self._end is not None:
            wanted = self._end
        offset = self._slew.step(wanted)[:3]
        if self.stage == "lifting" and float(np.abs(offset - wanted[:3]).max()) < ARRIVED:
            self.stage = "held"
        self._place[:] = pose.transform(self._begun + offset)
        a, b, c = self._plane
        lowest = a * self._place[0] + b * self._place[1] + c + self._config.ground_clearance
        if self.stage == "held":
            self._place[2] = max(self._place[2], lowest)

    def _turn_joints(self, order: LegOrder) -> None:
        assert order.joints is not None
        if self.angles is None:
            self.angles = self._wanted.copy()
            self._home = self._wanted.copy()
        self._return = None
        wanted = np.array([w if np.isfinite(w) else a for w, a in zip(order.joints, self.angles, strict=True)])
        wanted = np.clip(wanted, self._limits[:, 0], self._limits[:, 1])
        step = self._config.joint_speed * self._dt
        self.angles = self.angles + np.clip(wanted - self.angles, -step, step)

    def _return_joints(self) -> bool:
        """Turn the joints back to where they were taken; True when there."""
        assert self._home is not None
        assert self.angles is not None
        if self._return is None:
            self._return = Glide(self.angles, self._home, self._config.joint_speed)
        self.angles = self._return.step(self._dt)
        if self._return.done:
            self.angles = self._home = self._return = None
            return True
        return False
