"""Legs lifted off the ground and moved by hand, two at most (facts 3.15)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.admittance import Admittance
from robot_agent.locomotion.openshc.body_pose import BodyPose
from robot_agent.locomotion.openshc.leg import TOLERANCE, Leg
from robot_agent.locomotion.openshc.posing import PoseReset, Posing
from robot_agent.locomotion.openshc.settings import Settings
from robot_agent.locomotion.openshc.step_path import StepPath
from robot_agent.locomotion.openshc.steps import MANUAL, MANUAL_TO_WALKING, WALKING, WALKING_TO_MANUAL
from robot_agent.locomotion.openshc.transitions import COMPLETE, TipMove

Array = NDArray[np.float64]

MOST_MANUAL_LEGS = 2


class Manipulation:
    """`states` has one of WALKING, MANUAL and the ways between for every leg."""

    def __init__(self, settings: Settings, legs: Sequence[Leg], posing: Posing, admittance: Admittance) -> None:
        self._settings, self._legs, self._posing, self._admittance = settings, legs, posing, admittance
        self.states = [WALKING] * len(legs)
        self.toggled: int | None = None
        self.tip_velocity = {leg: np.zeros(3) for leg in range(len(legs))}
        self._moves: list[TipMove | None] = [None] * len(legs)

    def toggle(self, paths: Sequence[StepPath]) -> None:
        """One tick of the change asked for by `toggled`, the robot standing."""
        leg = self.toggled
        if leg is None:
            return
        state = self.states[leg]
        if state == WALKING:
            if self.states.count(MANUAL) >= MOST_MANUAL_LEGS:
                self.toggled = None
                return
            self.states[leg] = WALKING_TO_MANUAL
            paths[leg].swing_progress = paths[leg].stance_progress = -1.0
        elif state == MANUAL:
            self.states[leg] = MANUAL_TO_WALKING
        else:
            self._change(leg, paths)

    def _change(self, leg: int, paths: Sequence[StepPath]) -> None:
        lifting = self.states[leg] == WALKING_TO_MANUAL
        self._posing.reset = PoseReset.IMMEDIATE_ALL
        progress = self._pose(paths)
        if self._settings.description.dynamic_stiffness:
            share = progress / COMPLETE
            self._admittance.report_transition(leg, share if lifting else abs(share - 1.0), self.states)
        if progress == COMPLETE:
            self.states[leg] = MANUAL if lifting else WALKING
            self.toggled = None
            self._posing.reset = PoseReset.NO_RESET

    def _pose(self, paths: Sequence[StepPath]) -> int:
        """All legs step to where they are wanted; least progress in per cent."""
        least = COMPLETE
        height = self._settings.swing_height
        for k, (leg, path) in enumerate(zip(self._legs, paths, strict=True)):
            lift, pose = height, self._posing.pose
            if self.states[k] == WALKING_TO_MANUAL:
                lift = 0.0
                target = BodyPose(pose.position - np.array([0.0, 0.0, height]), pose.rotation).into(path.default)
                path.tip = target
            else:
                target = BodyPose(pose.position - self._posing.manual.position, pose.rotation).into(path.default)
                if self.states[k] == MANUAL_TO_WALKING:
                    path.tip = path.default.copy()
            least = min(least, self._step(k, leg, target, lift))
        return least

    def _step(self, k: int, leg: Leg, target: Array, lift: float) -> int:
        move = self._moves[k]
        if move is None:
            frame = leg.tip_frame()
            seconds = 1.0 / self._settings.step_frequency
            move = self._moves[k] = TipMove(
                frame[:3, 3].copy(),
                frame[:3, 0].copy(),
                target,
                pose=BodyPose(),
                lift=lift,
                seconds=seconds,
                dt=self._settings.dt,
            )
        progress = move.tick()
        if progress == COMPLETE:
            self._moves[k] = None
        else:
            leg.step_to(move.tip)
        return progress

    def move_tips(self, paths: Sequence[StepPath], wanted: Sequence[Array | None]) -> None:
        """Manual legs by `tip_velocity` (-1..1 each axis); pushed back where the solver does not follow."""
        description, dt = self._settings.description, self._settings.dt
        for k, leg in enumerate(self._legs):
            velocity, ordered = self.tip_velocity[k], wanted[k]
            if self.states[k] != MANUAL or not velocity.any():
                continue
            if description.leg_manipulation_mode == "joint_control":
                self._move_joints(leg, paths[k], velocity)
                continue
            change = velocity * description.max_translation_velocity * dt
            error = np.zeros(3) if ordered is None else ordered - leg.tip()
            if float(np.linalg.norm(error)) >= TOLERANCE:
                change = -np.linalg.norm(change) * error / np.linalg.norm(error)
            paths[k].tip = paths[k].tip + change

    def _move_joints(self, leg: Leg, path: StepPath, velocity: Array) -> None:
        """Hip and knee of three-joint legs; others have no joint control."""
        if leg.position.size == 3:
            turn = self._settings.description.max_rotation_velocity * self._settings.dt
            leg.position[0] += velocity[1] * turn
            leg.position[2] += velocity[0] * turn
            path.tip = leg.tip()
