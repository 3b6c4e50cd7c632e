"""One leg's steps: its phase, and its foot on quartic Bezier curves integrated by their derivative (facts 3.7)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.bezier import quartic_derivative
from robot_agent.locomotion.openshc.body_pose import BodyPose, projected, smooth_step
from robot_agent.locomotion.openshc.settings import Settings
from robot_agent.locomotion.openshc.step_cycle import StepCycle
from robot_agent.locomotion.openshc.steps import FORCE_STANCE, FORCE_STOP, STANCE, SWING
from robot_agent.locomotion.openshc.workspace import Workspace

Array = NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])


class StepPath:
    """Foot of one leg over the walk plane, m; `identity` is where its description puts it."""

    def __init__(self, identity: Array, settings: Settings, *, aligned: bool) -> None:
        self._settings = settings
        self.identity = identity.copy()
        self.default = identity.copy()
        self.tip, self.velocity = identity.copy(), np.zeros(3)
        self.stride, self.target = np.zeros(3), identity.copy()
        self.plane, self.normal = np.zeros(3), UP
        self.phase, self.offset = 0, 0
        self.step_state = STANCE
        self.swing_progress, self.stance_progress = -1.0, -1.0
        self.first_step_done, self.in_phase = False, False
        self._target_direction = -UP if aligned else None
        self._direction_before = -UP
        self.direction = self._target_direction  # wanted x axis of the tip over the walk plane
        self._clearance = settings.swing_height * UP
        self._swing_origin, self._lift_off_velocity = identity.copy(), np.zeros(3)
        self._stance_origin = identity.copy()
        self._step_progress = 0.0

    def begin(self, cycle: StepCycle) -> None:
        """The phase of the first step."""
        self.in_phase, self.first_step_done = False, False
        self.step_state = STANCE
        self.phase = self.offset
        self.update_state(cycle)

    def update_state(self, cycle: StepCycle) -> None:
        swings = cycle.swing_start <= self.phase < cycle.swing_end
        if self.step_state == FORCE_STOP or (swings and self.step_state == FORCE_STANCE):
            return
        self.step_state = SWING if swings else STANCE

    def keep_progress(self, cycle: StepCycle) -> None:
        """The same share of a step in a new cycle, truncated to whole ticks."""
        self.phase = int(self._step_progress * cycle.period)
        self.update_state(cycle)

    def advance_phase(self, cycle: StepCycle) -> None:
        self.phase = (self.phase + 1) % cycle.period
        self.update_state(cycle)
        self._step_progress = self.phase / cycle.period
        if self.step_state == SWING:
            progress = (self.phase - cycle.swing_start + 1) / cycle.swing_period
            self.swing_progress, self.stance_progress = min(max(progress, 0.0), 1.0), -1.0
        elif self.step_state == STANCE:
            progress = ((self.phase - cycle.stance_start) % cycle.period + 1) / cycle.stance_period
            self.swing_progress, self.stance_progress = -1.0, min(max(progress, 0.0), 1.0)
        elif self.step_state == FORCE_STOP:
            self.swing_progress, self.stance_progress = -1.0, 0.0

    def update_default(self, walk_plane_pose: BodyPose, workspace: Workspace) -> None:
        """Identity with the stance span, brought to the ground where the last stance began."""
        placed = walk_plane_pose.out_of(self.identity + self._span_shift(workspace))
        self.default = placed + projected(self._stance_origin - placed, self.normal)

    def _span_shift(self, workspace: Workspace) -> Array:
        modifier = self._settings.stance_span_modifier
        if modifier == 0.0:
            return np.zeros(3)
        left = self.identity[1] > 0.0
        radius = workspace.radius(270 if left != (modifier > 0.0) else 90, float(self.default[2] - self.identity[2]))
        return np.array([0.0, radius * modifier * (1.0 if left else -1.0), 0.0])

    def move(
        self,
        velocity: tuple[Array, float],
        plane: tuple[Array, Array],
        cycle: StepCycle,
        walk_plane_pose: BodyPose,
        workspace: Workspace,
        step_plane: Array | None,
    ) -> None:
        """A tick at the present phase.

        `velocity` is the body's, (2,) m/s and rad/s; `plane` its coefficients and normal, (3,) each. `step_plane` (3,)
        leads from the tip to the ground felt under it, if any.
        """
        self.target = self.default + 0.5 * self.stride
        if self.step_state == SWING:
            self._update_stride(velocity, plane, cycle)
            self._swing(cycle, walk_plane_pose, workspace, step_plane)
        elif self.step_state in (STANCE, FORCE_STANCE):
            self._update_stride(velocity, plane, cycle)
            self._stand(cycle, walk_plane_pose, workspace)

    def _update_stride(self, velocity: tuple[Array, float], plane: tuple[Array, Array], cycle: StepCycle) -> None:
        """From where the tip is, every tick; the target lags a tick."""
        linear, angular = velocity
        self.plane, self.normal = plane
        along = np.array([linear[0] - angular * self.tip[1], linear[1] + angular * self.tip[0], 0.0])
        self.stride = along * (cycle.on_ground_ratio / cycle.frequency)
        self._clearance = self._settings.swing_height * self.normal

    def _swing(
        self, cycle: StepCycle, walk_plane_pose: BodyPose, workspace: Workspace, step_plane: Array | None
    ) -> None:
        tick, half = self.phase - cycle.swing_start + 1, cycle.swing_ticks // 2
        if tick == 1:
            self._swing_origin, self._lift_off_velocity = self.tip.copy(), self.velocity.copy()
            if self._settings.rough_terrain_mode:
                self.update_default(walk_plane_pose, workspace)
        if self._settings.rough_terrain_mode and self._settings.feels_ground:
            self._seek_ground(step_plane)
        step = 1.0 / half
        on_ground = step_plane is not None and self._settings.rough_terrain_mode
        first, second = self._nodes(step, cycle, follow_ground=tick > half and on_ground)
        if self._settings.force_normal_touchdown and not on_ground:
            self._come_down_straight(first, second, step, cycle)
        if tick <= half:
            self._advance(first, step, step * tick)
        else:
            self._advance(second, step, step * (tick - half))

    def _seek_ground(self, step_plane: Array | None) -> None:
        """The target on the ground felt, or as far below the plane as is to be searched."""
        if step_plane is None:
            self.target = self.target - self._settings.step_depth * UP
        else:
            self.target = self.target + projected(self.tip + step_plane - self.target, self.normal)

    def _stand(self, cycle: StepCycle, walk_plane_pose: BodyPose, workspace: Workspace) -> None:
        first_tick = cycle.stance_start if self.first_step_done else self.offset
        tick = (self.phase - first_tick) % cycle.period + 1
        if tick == 1:
            self._stance_origin = self.tip.copy()
            if self._settings.rough_terrain_mode:
                self.update_default(walk_plane_pose, workspace)
        length = (cycle.stance_end - first_tick) % cycle.period or cycle.period
        step = 1.0 / cycle.ticks_of(length)
        nodes = self._stance_origin - 0.25 * (length / cycle.stance_period) * np.arange(5)[:, None] * self.stride
        self._advance(nodes, step, tick * step)

    def _nodes(self, step: float, cycle: StepCycle, *, follow_ground: bool) -> tuple[Array, Array]:
        apex = 0.5 * (self._swing_origin + self.target)
        apex[2] = max(self._swing_origin[2], self.target[2])
        apex = apex + self._clearance
        apex[1] += self._settings.swing_width * (1.0 if self.identity[1] > 0.0 else -1.0)
        leaving = 0.25 * self._lift_off_velocity * (cycle.dt / step)
        arriving = self._arriving(step, cycle)
        first = np.array([self._swing_origin + i * leaving for i in range(3)] + [apex, apex])
        first[3] = 0.5 * (apex + first[2])
        first[3, 2] = apex[2]
        if follow_ground:
            return first, self.tip + np.arange(5)[:, None] * arriving
        return first, np.array([apex, 2.0 * apex - first[3], *(self.target - i * arriving for i in (2, 1, 0))])

    def _arriving(self, step: float, cycle: StepCycle) -> Array:
        stance_step = 1.0 / cycle.ticks_of(cycle.stance_period)
        arriving: Array = 0.25 * (-self.stride * stance_step / cycle.dt) * (cycle.dt / step)
        return arriving

    def _come_down_straight(self, first: Array, second: Array, step: float, cycle: StepCycle) -> None:
        """Let the second half end along the normal, as seen from the ground."""
        arriving = self._arriving(step, cycle)
        apex = self.target - 4.0 * arriving
        apex[2] = max(self._swing_origin[2], self.target[2])
        apex = apex + self._clearance
        second[2] = self.target - 2.0 * arriving
        half = 0.5 * (second[2] - apex)
        first[4], second[0] = apex, apex
        first[3], second[1] = apex - half, apex + half

    def _advance(self, nodes: Array, step: float, t: float) -> None:
        slope = np.empty(3)
        quartic_derivative(nodes, t, slope)
        change = step * slope
        self.tip = self.tip + change
        self.velocity = change / self._settings.dt

    def turn_tip(self, tip_direction: Array) -> None:
        """Bring the tip's x axis upright in the swing's second half, where legs are to be aligned with gravity.

        `tip_direction` (3,) is where it points now, in body.
        """
        if self._target_direction is None:
            return
        if not (self.stance_progress >= 0.0 or self.swing_progress >= 0.5):
            self._direction_before, self.direction = tip_direction, None
            return
        self.direction = self._target_direction
        if self.swing_progress >= 0.5:
            share = smooth_step(min(1.0, 2.0 * (self.swing_progress - 0.5)))
            blend = (1.0 - share) * self._direction_before + share * self._target_direction
            self.direction = blend / np.linalg.norm(blend)
