"""OpenSHC 0.5.11's walk controller, tick for tick: walk states, step states and feet (facts 3.3-3.8)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.body_pose import BodyPose, projected
from robot_agent.locomotion.openshc.configuration import Configuration, Gait
from robot_agent.locomotion.openshc.limits import SpeedLimits, walkspace
from robot_agent.locomotion.openshc.settings import Settings
from robot_agent.locomotion.openshc.step_cycle import StepCycle
from robot_agent.locomotion.openshc.step_path import UP, StepPath
from robot_agent.locomotion.openshc.steps import FORCE_STANCE, FORCE_STOP, MOVING, STARTING, STOPPED, STOPPING
from robot_agent.locomotion.openshc.velocity import BodyVelocity
from robot_agent.locomotion.openshc.workspace import Workspace
from weaver_shared.transforms import rotation_z

Array = NDArray[np.float64]

TIP_TOLERANCE = 0.01


class Walk:
    """All legs' steps. `tick` takes the command and moves the feet by one tick."""

    def __init__(self, description: Configuration, gait: Gait, settings: Settings) -> None:
        self._description, self._settings = description, settings
        aligned = description.gravity_aligned_tips and description.joints_per_leg > 3
        self.state = STOPPED
        self.paths = [StepPath(leg.place, settings, aligned=aligned) for leg in description.legs]
        self.velocity = BodyVelocity(description.velocity_input_mode, description.time_delta)
        self._plane, self._normal = np.zeros(3), UP
        self._attempted = False
        self.odometry = BodyPose()  # where the robot would be if it walked as told
        self._gait = gait
        self.cycle = self.cycle_of(settings.step_frequency)

    def learn(self, spaces: Sequence[Workspace]) -> None:
        """Where the feet can go, and with it how fast the robot may walk."""
        self._spaces = spaces
        places = np.array([path.default for path in self.paths])
        self._radii = walkspace(places, spaces, overlapping=self._description.overlapping_walkspaces)
        self.limits = self.limits_of(self.cycle)

    def cycle_of(self, step_frequency: float) -> StepCycle:
        return StepCycle.of(self._gait, step_frequency, self._description.time_delta, self._description.leg_id)

    def limits_of(self, cycle: StepCycle) -> SpeedLimits:
        """Finding limits also gives the legs their offsets, even before the cycle is taken (D28)."""
        for path, offset in zip(self.paths, cycle.offsets, strict=True):
            path.offset = offset
        return SpeedLimits.of(self._radii, cycle, self.paths[0].default[:2])

    def begin_gait(self, gait: Gait) -> None:
        self._gait = gait
        self.change_cycle(self.cycle_of(self._settings.step_frequency))

    def change_cycle(self, cycle: StepCycle) -> None:
        self.cycle = cycle
        if self.state == MOVING:
            for path in self.paths:
                path.keep_progress(cycle)
        self.limits = self.limits_of(cycle)

    def allow_speeds(self, limits: SpeedLimits) -> None:
        """Speeds alone; accelerations stay until the cycle is changed too."""
        self.limits = replace(self.limits, linear=limits.linear, angular=limits.angular)

    @property
    def tips(self) -> Array:
        """(legs, 3) m over the walk plane."""
        return np.array([path.tip for path in self.paths])

    def tick(
        self,
        linear: Array,
        angular: float,
        *,
        posing_complete: bool,
        walk_plane_pose: BodyPose,
        step_planes: Sequence[Array | None],
        tip_directions: Array,
    ) -> None:
        """`linear` (2,) and `angular` as the robot's input mode has it.

        `step_planes` leads from each tip to the ground felt under it; `tip_directions` (legs, 3) are the tips' x axes
        in body.
        """
        tips = self.tips
        halting = (np.zeros(2), 0.0)
        wanted = halting if self.state == STOPPING else self.velocity.wanted(self.limits, tips, linear, angular)
        self.velocity.approach(self.limits, tips, linear, angular, wanted)
        if self._change_state(bool(linear.any() or angular), posing_complete):
            return
        velocity = (self.velocity.linear, self.velocity.angular)
        for leg, path in enumerate(self.paths):
            self._change_step_state(path, walk_plane_pose, self._spaces[leg])
            plane = (self._plane, self._normal)
            path.move(velocity, plane, self.cycle, walk_plane_pose, self._spaces[leg], step_planes[leg])
            path.turn_tip(tip_directions[leg])
            path.advance_phase(self.cycle)
        self._fit_plane()
        dt = self._settings.dt
        moved = np.array([*self.velocity.linear, 0.0]) * dt
        self.odometry = self.odometry.added(BodyPose(moved, rotation_z(self.velocity.angular * dt)))

    def _change_state(self, commanded: bool, posing_complete: bool) -> bool:
        """Whether the walk begins: in that tick nothing moves."""
        if self.state == STOPPED and commanded:
            self.state = STARTING
            for path in self.paths:
                path.begin(self.cycle)
            return True
        if self.state == STARTING and all(path.in_phase and path.first_step_done for path in self.paths):
            self.state = MOVING
        elif self.state == MOVING and not commanded:
            self.state = STOPPING
        elif self.state == STOPPING and posing_complete and all(path.in_phase for path in self.paths):
            self.state = STOPPED
        return False

    def _change_step_state(self, path: StepPath, walk_plane_pose: BodyPose, space: Workspace) -> None:
        if self.state == STARTING:
            self._begin_leg(path)
        elif self.state == MOVING:
            path.in_phase = False
        elif self.state == STOPPING:
            self._end_leg(path, walk_plane_pose, space)
        else:
            path.step_state, path.phase = FORCE_STOP, 0

    def _begin_leg(self, path: StepPath) -> None:
        """Legs whose offset lies inside the swing stand until that swing is over; then each counts a first step."""
        cycle = self.cycle
        if path.phase == cycle.swing_end and all(other.in_phase for other in self.paths):
            path.first_step_done = True
        if path.in_phase:
            return
        if cycle.swing_start < path.offset < cycle.swing_end and path.phase != cycle.swing_end:
            path.step_state = FORCE_STANCE
        else:
            path.in_phase = True

    def _end_leg(self, path: StepPath, walk_plane_pose: BodyPose, space: Workspace) -> None:
        """A leg stops at the end of a swing without stride, near its target or where any leg has tried before it."""
        if path.in_phase or path.stride.any() or path.phase != self.cycle.swing_end:
            return
        error = path.tip - path.target
        near = float(np.linalg.norm(error - projected(error, path.normal))) < TIP_TOLERANCE
        if near or self._attempted:
            path.update_default(walk_plane_pose, space)
            path.step_state, path.in_phase = FORCE_STOP, True
        self._attempted = not (near or self._attempted)

    def _fit_plane(self) -> None:
        """z = a x + b y + c over the default tips, not over measured contacts (D29)."""
        defaults = np.array([path.default for path in self.paths])
        a = np.column_stack([defaults[:, :2], np.ones(len(defaults))])
        self._plane = np.linalg.inv(a.T @ a) @ a.T @ defaults[:, 2]
        normal = np.array([-self._plane[0], -self._plane[1], 1.0])
        self._normal = normal / np.linalg.norm(normal)

    @property
    def plane(self) -> Array:
        """a, b, c."""
        return self._plane
