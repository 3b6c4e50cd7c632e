"""Posing in step with the gait: cycles of two quartic Bezier curves, and legs that leave them out (facts 3.11)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.bezier import quartic
from robot_agent.locomotion.openshc import configuration
from robot_agent.locomotion.openshc.body_pose import BodyPose, smooth_step
from robot_agent.locomotion.openshc.step_cycle import even_up
from robot_agent.locomotion.openshc.steps import FORCE_STANCE, FORCE_STOP, MOVING, STARTING, STOPPED, STOPPING
from weaver_shared.errors import ConfigurationError
from weaver_shared.transforms import rotation_from_rpy

Array = NDArray[np.float64]

POSING, STOP_POSING, POSING_COMPLETE = range(3)


class AutoPosing:
    """All cycles of one gait. `pose` is the body's, `leg_poses` what each leg makes of it."""

    def __init__(self, description: configuration.Configuration, gait_name: str, step_frequency: float) -> None:
        pose, gait = _pose_of(description, gait_name), description.gaits[gait_name]
        self.state = POSING_COMPLETE
        self.pose = BodyPose()
        self.leg_poses = [BodyPose() for _ in description.leg_id]
        self._own_clock = pose.pose_frequency != -1.0
        parts = pose.pose_phase_length if self._own_clock else gait.stance_phase + gait.swing_phase
        share = 1.0 if self._own_clock else gait.swing_phase / parts
        frequency = pose.pose_frequency if self._own_clock else step_frequency
        self._part = even_up((1.0 / frequency) / description.time_delta / share / parts)
        self._length = self._part * parts
        self._phase = 0
        self._cycles = [
            _Cycle(pose, k, self._part, self._length, self._own_clock) for k in range(len(pose.pose_phase_starts))
        ]
        self._negations = [_Negation(pose, leg, self._part, self._length) for leg in description.leg_id]
        multipliers = [gait.offset_multiplier[leg] for leg in description.leg_id]
        self.reference = max(leg for leg, multiplier in enumerate(multipliers) if multiplier == 0)

    def update(self, walk_state: int, stands: bool, phase: int, step_states: list[int], gravity: Array) -> None:
        """A tick; `phase` and `stands` (no stride) are those of the reference leg, `gravity` (3,) a unit vector."""
        if walk_state in (STARTING, MOVING):
            self.state = POSING
        elif (stands and walk_state == STOPPING) or walk_state == STOPPED:
            self.state = STOP_POSING
        if self._own_clock:
            phase = self._phase
            self._phase = (self._phase + 1) % self._length
        self.pose = BodyPose()
        for cycle in self._cycles:
            self.pose = self.pose.added(cycle.pose(phase, self.state, gravity))
        if not any(cycle.active for cycle in self._cycles):
            self.state = POSING_COMPLETE
        self.leg_poses = [
            negation.applied(self.pose, phase, step_state)
            for negation, step_state in zip(self._negations, step_states, strict=True)
        ]


def _pose_of(description: configuration.Configuration, gait_name: str) -> configuration.AutoPose:
    name = f"{gait_name}_pose" if description.auto_pose_type == "auto" else description.auto_pose_type
    if name not in description.auto_poses:
        known = ", ".join(description.auto_poses) or "none"
        raise ConfigurationError(f"auto_posing: {name!r} is not described; described are {known}")
    return description.auto_poses[name]


class _Cycle:
    """One pose that comes and goes; it starts and ends on whole cycles only."""

    def __init__(self, pose: configuration.AutoPose, index: int, part: int, length: int, own_clock: bool) -> None:
        self.active = False
        self._started = False
        self._ending, self._ended = False, False
        self._start, self._end = pose.pose_phase_starts[index] * part, pose.pose_phase_ends[index] * part
        self._length, self._own_clock = length, own_clock
        self._turn = np.array([pose.roll_amplitudes[index], pose.pitch_amplitudes[index], pose.yaw_amplitudes[index]])
        self._shift = np.array([pose.x_amplitudes[index], pose.y_amplitudes[index], pose.z_amplitudes[index]])
        self._along_gravity = pose.gravity_amplitudes[index]

    def pose(self, phase: int, state: int, gravity: Array) -> BodyPose:
        start, end = self._start, self._end
        if start > end:
            end += self._length
            if phase < start:
                phase += self._length
        self._start_or_end(phase, start, end, state)
        if not (self.active and start <= phase < end):
            return BodyPose()
        tick, ticks = phase - start + 1, end - start
        rising = tick <= ticks // 2
        t = (tick - (0 if rising else ticks // 2)) / (ticks / 2.0)
        shift = gravity * self._along_gravity if self._along_gravity != 0.0 else self._shift
        roll, pitch, yaw = _hill(self._turn, t, rising=rising)
        return BodyPose(_hill(shift, t, rising=rising), rotation_from_rpy(roll, pitch, yaw))

    def _start_or_end(self, phase: int, start: int, end: int, state: int) -> None:
        self._started = self._own_clock or (not self._started and state == POSING and phase == start)
        self._ending = self._ending or (state == STOP_POSING and phase == start)
        self._ended = self._ended or (state == STOP_POSING and phase == end and self._ending)
        if not self.active and self._started:
            self.active = True
            self._ending, self._ended = False, False
        elif self.active and not self._own_clock and self._ending and self._ended:
            self.active, self._started = False, False


def _hill(top: Array, t: float, *, rising: bool) -> Array:
    """0, 0, 0, A, A up and A, A, 0, 0, 0 down."""
    nodes, point = np.zeros((5, 3)), np.empty(3)
    nodes[3:] = top if rising else 0.0
    nodes[:2] = 0.0 if rising else top
    quartic(nodes, t, point)
    return point


class _Negation:
    """The window in which a leg leaves the body's automatic pose out."""

    def __init__(self, pose: configuration.AutoPose, leg: str, part: int, length: int) -> None:
        self._start = pose.pose_negation_phase_starts[leg] * part or length
        self._end = pose.pose_negation_phase_ends[leg] * part or length
        self._ratio = pose.negation_transition_ratio.get(leg, 0.0)
        self._length = length
        self._on = False

    def applied(self, pose: BodyPose, phase: int, step_state: int) -> BodyPose:
        start, end = self._start, self._end
        if start > end:
            end += self._length
            if phase < start:
                phase += self._length
        if step_state not in (FORCE_STANCE, FORCE_STOP) and phase == start:
            self._on = True
        if phase < start or phase > end:
            self._on = False
        if not self._on:
            return pose
        tick, ticks = phase - start + 1, end - start
        share = 1.0
        if self._ratio > 0.0:
            left = tick if tick <= ticks // 2 else ticks - tick
            share = min(1.0, left / (ticks * self._ratio))
        return pose.removed(BodyPose().blended(smooth_step(share), pose))
