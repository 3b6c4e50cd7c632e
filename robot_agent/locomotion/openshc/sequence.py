"""Start-up by steps: alternately sideways and up, explored once and then replayed either way (facts 3.14)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.body_pose import BodyPose
from robot_agent.locomotion.openshc.leg import Leg
from robot_agent.locomotion.openshc.settings import Settings
from robot_agent.locomotion.openshc.transitions import COMPLETE, TipMove
from weaver_shared.errors import ConfigurationError

Array = NDArray[np.float64]

SAFETY = 0.15
HALF_BODY_DEPTH = 0.05
HORIZONTAL_TIME, VERTICAL_TIME = 1.0, 3.0
MOST_STEPS = 20


class StepSequence:
    """Transition postures of all legs; odd steps of a start-up are vertical."""

    def __init__(self, settings: Settings, legs: Sequence[Leg]) -> None:
        self._settings, self._legs = settings, legs
        self._poses = [[leg.tip()] for leg in legs]
        self._exploring = True
        self._step = self._steps = 0
        self._group = 0
        self._moves: list[TipMove | None] = [None] * len(legs)
        self._targets: list[Array] = []
        self._done = [False] * len(legs)
        self._alert = False
        self._straight = [False, False]  # horizontal and vertical transitions that came through

    def tick(self, *, up: bool, stance: Sequence[Array], offsets: Array) -> bool:
        """Whether the sequence is complete. `stance` has the feet's places in body, `offsets` the admittance's."""
        if not up and self._step == 0:
            return True
        following = self._step + (1 if up else -1)
        last = any(self._straight) if self._exploring else following == (self._steps if up else 0)
        safety = SAFETY / (self._step + 1) if self._exploring else 0.0
        horizontal = (self._step % 2 == 0) == up
        if not self._targets:
            self._aim(following, stance, horizontal=horizontal)
        extra = offsets if up and last else np.zeros_like(offsets)
        complete = False
        if horizontal:
            complete = self._sideways(following, safety, extra) and last
        else:
            complete = self._upwards(following, safety, extra) and last
        if self._exploring:
            self._steps = self._step
        if self._step > MOST_STEPS:
            raise ConfigurationError(f"start_up_sequence: no stance was found within {MOST_STEPS} transitions")
        if complete:
            self._straight, self._exploring = [False, False], False
        return complete

    def _aim(self, following: int, stance: Sequence[Array], *, horizontal: bool) -> None:
        self._done = [False] * len(self._legs)
        for leg, place, poses in zip(self._legs, stance, self._poses, strict=True):
            target = (poses[following] if following < len(poses) else place).copy()
            kept = leg.tip()
            target[2 if horizontal else slice(0, 2)] = kept[2 if horizontal else slice(0, 2)]
            self._targets.append(target)

    def _sideways(self, following: int, safety: float, offsets: Array) -> bool:
        """All legs at once while none bears load, else one group after the other."""
        unloaded = -float(np.mean([leg.tip()[2] for leg in self._legs])) <= HALF_BODY_DEPTH
        lift = 0.0 if unloaded else self._settings.swing_height
        for k in range(len(self._legs)):
            if self._done[k]:
                continue
            if not (unloaded or k % 2 == self._group):
                self._done[k] = True
                continue
            progress, nearest, tip = self._follow(k, HORIZONTAL_TIME, lift, offsets[k])
            if self._exploring and nearest < safety:
                self._targets[k], progress, self._alert = tip, COMPLETE, True
            if progress == COMPLETE:
                self._done[k], self._moves[k] = True, None
                if self._exploring:
                    self._poses[k].append(self._targets[k])
        if not all(self._done):
            return False
        self._targets = []
        if not (self._group == 1 or unloaded):
            self._group = 1
            return False
        self._group, self._step = 0, following
        self._straight[0], self._alert = not self._alert, False
        return True

    def _upwards(self, following: int, safety: float, offsets: Array) -> bool:
        within, progress, tips = True, 0, []
        for k in range(len(self._legs)):
            progress, nearest, tip = self._follow(k, VERTICAL_TIME, 0.0, offsets[k])
            within = within and not nearest < safety
            tips.append(tip)
        if not ((self._exploring and not within) or progress == COMPLETE):
            return False
        for k in range(len(self._legs)):
            self._moves[k] = None
            if self._exploring:
                self._poses[k].append(self._targets[k] if within else tips[k])
        self._targets = []
        self._straight[1], self._step = within, following
        return True

    def _follow(self, k: int, seconds: float, lift: float, offset: Array) -> tuple[int, float, Array]:
        """Progress, how near a joint limit is, and where the tip was sent."""
        leg, move = self._legs[k], self._moves[k]
        if move is None:
            frame = leg.tip_frame()
            seconds *= (2.0 if self._exploring else 1.0) / self._settings.step_frequency
            move = self._moves[k] = TipMove(
                frame[:3, 3].copy(),
                frame[:3, 0].copy(),
                self._targets[k],
                pose=BodyPose(),
                lift=lift,
                seconds=seconds,
                dt=self._settings.dt,
            )
        progress = move.tick(offset)
        if progress == COMPLETE:
            self._moves[k] = None
        return progress, leg.step_to(move.tip), move.tip
