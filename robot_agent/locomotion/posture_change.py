"""A standing robot moves itself into its other posture, one leg after the other (OpenSHC'20 VI-B).

The body goes to the height of the plan; each leg gives off its load, is lifted over its stance, turns in the air and is
put down in its new place, by feeling where it can. The other legs hold their angles meanwhile. Told to sit, the robot
first puts down the leg in the air; told to stand again, it goes on where it was.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel
from robot_agent.locomotion.manipulation import refusal
from robot_agent.locomotion.posture_plan import PosturePlan
from robot_agent.locomotion.posture_tick import change_tick, reach_foot
from robot_agent.locomotion.rising import Glide
from robot_agent.locomotion.stability import static_margin
from robot_agent.locomotion.walk_state import WalkState
from weaver_shared.config.locomotion import LocomotionConfig

Array = NDArray[np.float64]

LOADING = 0.15
"""Fraction of the way up, and of the way down, in which the feet take over the weight from the belly."""
RELIEVED = 1e-6
TURN_SPEED = 1.0
"""rad/s, mean, of a leg in the air."""
TILT_SPEED = 0.5
"""1/s, of the last links' direction, while the feet stand."""


class PostureChange:
    """Works on the walker's memory, whose joint limits must be the machine's own meanwhile; `step` is one tick.

    `angles` (legs, n) is what the joints are told; `done` once every foot stands in its new place.
    """

    def __init__(
        self,
        state: WalkState,
        here: LegModel,
        there: LegModel,
        plan: PosturePlan,
        config: LocomotionConfig,
        dt: float,
    ) -> None:
        self._memory = state.memory
        self._limits = (here.limits, there.limits)
        self._plan = plan
        self._config = config
        self._dt = dt
        self._contact = state.cut("senses", "contact")
        self._share = state.cut("load", "share")
        self._measured = state.cut("senses", "origins")[:, -1]
        self._centre, self._up = state.cut("senses", "centre_of_mass"), state.cut("senses", "up")
        self._wanted = state.cut("joint", "wanted")
        self.angles: Array = self._wanted.copy()
        self._feet = state.cut("joint", "foot")  # m in body, wanted
        self._links = np.tile(-self._up, (here.leg_count, 1))  # where the last links are wanted, as when walking
        self._changed = np.zeros(here.leg_count, dtype=np.bool_)
        self._relieved, self._in_air, self._carried = -1, False, 1.0
        self._stand = True
        self._steps = self._run()
        self.posture = "changing"
        self.reasons: tuple[str, ...] = ()
        self.done = False

    def step(self, stand: bool) -> None:
        """One tick; `stand` False asks the robot to sit down as soon as all its feet are on the ground."""
        self._stand = stand
        next(self._steps, None)
        change_tick(self._memory, self.angles, self._relieved, self._in_air, self._carried)
        self.angles[:] = self._wanted  # what the joints' speed allowed

    def _run(self) -> Iterator[None]:
        yield from self._move_body(self._plan.height)
        for leg in self._plan.order:
            yield from self._wait_for_balance(leg)
            yield from self._relieve(leg)
            yield from self._lift(leg)
            yield from self._turn(leg)
            yield from self._put_down(leg)
        yield from self._sit_if_asked()
        self.done = True

    def _sit_if_asked(self) -> Iterator[None]:
        """Down on the belly and, when told to stand, up again."""
        while not self._stand:
            heights = self._feet[:, 2].copy()
            self.posture = "lowering"
            yield from self._glide_feet(np.full(heights.size, self._sitting_height), lowering=True)
            self.posture, self._carried = "sitting", 0.0
            while not self._stand:
                yield
            self.posture = "rising"
            yield from self._glide_feet(heights, lowering=False)
            self.posture = "changing"

    @property
    def _sitting_height(self) -> float:
        return self._plan.sitting_height + self._config.sitting_lift

    def _glide_feet(self, heights: Array, *, lowering: bool) -> Iterator[None]:
        glide = Glide(self._feet[:, 2].copy(), heights, self._config.rise_speed)
        while not glide.done:
            self._feet[:, 2] = glide.step(self._dt)
            done = 1.0 - glide.progress if lowering else glide.progress
            self._carried = min(done / LOADING, 1.0)
            self._reach_all()
            yield

    def _move_body(self, height: float) -> Iterator[None]:
        """Up or down, so that the feet are on the mean at `height` in body, last links as when they are lifted."""
        goal = self._feet[:, 2] + height - float(self._feet[:, 2].mean())
        glide = Glide(self._feet[:, 2].copy(), goal, self._config.rise_speed)
        tilting = Glide(self._links, self._plan.lifted_links, TILT_SPEED)
        while not (glide.done and tilting.done):
            self._feet[:, 2], self._links[:] = glide.step(self._dt), tilting.step(self._dt)
            self._reach_all()
            yield

    def _wait_for_balance(self, leg: int) -> Iterator[None]:
        """Until the others carry the robot safely; meanwhile it may be told to sit."""
        needed = self._config.stability.lift_static
        yield from self._sit_if_asked()
        while (margin := self._margin_without(leg)) < needed:
            self.reasons = (f"the posture is not changed further: {refusal(margin, needed)}",)
            yield
            yield from self._sit_if_asked()
        self.reasons = ()

    def _margin_without(self, leg: int) -> float:
        carrying = np.arange(len(self._feet)) != leg
        return float(static_margin(self._measured, carrying, self._centre, self._up))

    def _relieve(self, leg: int) -> Iterator[None]:
        self._relieved = leg
        while self._share[leg] > RELIEVED:
            yield

    def _lift(self, leg: int) -> Iterator[None]:
        """Straight up, then over the place from which the leg turns."""
        self._in_air = True
        up = self._feet[leg] + (0.0, 0.0, self._plan.lift)
        over = np.array([*self._plan.stance[leg], self._plan.height + self._plan.lift])
        for goal in (up, over):
            glide = Glide(self._feet[leg].copy(), goal, self._config.manipulation.tip_speed)
            while not glide.done:
                self._place(leg, glide.step(self._dt))
                yield

    def _turn(self, leg: int) -> Iterator[None]:
        """Round in the air, first to where the plan has the leg over its stance."""
        for goal in (self._plan.lifted[leg], self._plan.turned[leg]):
            glide = Glide(self.angles[leg].copy(), goal, TURN_SPEED)
            while not glide.done:
                self.angles[leg] = glide.step(self._dt)
                yield
        self._changed[leg], self._links[leg] = True, self._plan.turned_links[leg]
        self._feet[leg] = (*self._plan.goal[leg], self._plan.height + self._plan.lift)

    def _put_down(self, leg: int) -> Iterator[None]:
        """Down to the ground, as far below its expected height as a step may reach."""
        foothold, feels = self._config.foothold, self._config.feel_ground
        lowest = self._plan.height - (foothold.reach_down if feels else 0.0)
        while self._feet[leg, 2] > lowest and not (feels and self._contact[leg]):
            self._place(leg, self._feet[leg] - (0.0, 0.0, foothold.touchdown_speed * self._dt))
            yield
        self._relieved, self._in_air = -1, False
        while self._share[leg] < 1.0 - RELIEVED:
            yield

    def _place(self, leg: int, foot: Array) -> None:
        self._feet[leg] = foot
        limits = self._limits[int(self._changed[leg])]
        reach_foot(self._memory, limits, leg, self._feet[leg], self._links[leg], self.angles[leg])

    def _reach_all(self) -> None:
        for leg in range(len(self._feet)):
            self._place(leg, self._feet[leg])
