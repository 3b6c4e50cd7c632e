"""The body's pose against its un-posed place: levelling, then the operator's, then the gait's own (OpenSHC'20 IV-B).

    unposed_from_body = levelling @ manual @ automatic

The walk is planned in the un-posed frame; feet are turned into the body just before the inverse kinematics, and what
is measured in the body is turned back before the walk sees it. So posing neither drags a foot nor fights posture.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel
from robot_agent.locomotion.posing.automatic import automatic_pose, leg_amplitudes, steepest_slope
from robot_agent.locomotion.posing.levelling import Levelling, tilt_error
from robot_agent.locomotion.posing.order import PosingOrder, bounded
from robot_agent.locomotion.posing.reach import PoseReach, pose_of
from robot_agent.locomotion.posing.slew import Slew
from weaver_shared.config.locomotion import AutomaticPose, LocomotionConfig
from weaver_shared.robots.gaits import Gait
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]


class Poser:
    """Gives `pose`, unposed_from_body, once a tick."""

    def __init__(
        self, config: LocomotionConfig, model: LegModel, nominal: Array, centre_of_mass: Array, dt: float
    ) -> None:
        self._config = posing = config.posing
        self._nominal = nominal
        self._room = 0.5 * config.largest_stride
        rates = (posing.position_rate, posing.rotation_rate)
        self._rates = np.repeat(rates, 3)
        self._manual = Slew(rates, posing.smoothing, dt)
        self._level = Slew(rates, posing.smoothing, dt)
        self._fade = Slew((1.0 / posing.fade_time, 1.0), posing.smoothing, dt)
        self._reach = PoseReach(model, nominal, centre_of_mass, config.stability.lift_static)
        self._levelling = Levelling(posing.levelling, dt)
        self._gait: Gait | None = None  # whose automatic pose is under way
        self._amplitude = np.zeros((len(nominal), 6))
        self._slope = np.zeros(6)
        self.clear()

    def clear(self) -> None:
        for slew in (self._manual, self._level, self._fade):
            slew.clear()
        self._levelling.clear()
        self.pose = Pose.identity()
        self.idle = True  # the pose is the identity and stays so
        self.reasons: tuple[str, ...] = ()

    @property
    def values(self) -> Array:
        """Manual part and levelling, (6,) m and rad, for telling people."""
        return self._manual.value + self._level.value

    def step(
        self, order: PosingOrder, up_in_body: Array, *, walking: bool, gait: Gait, leg_phase: Array, swing: float,
        frequency: float,
    ) -> Pose:  # fmt: skip
        """One tick; `leg_phase` (legs,), `swing` and `frequency` Hz are the gait's."""
        if self.idle and order.idle:
            return self.pose
        wanted = self._reach.fit(bounded(order.manual, self._config), self._room if walking else 0.0)
        manual = pose_of(self._manual.step(wanted))
        automatic = self._with_the_gait(order.automatic and walking, gait, leg_phase, swing, frequency)
        level = pose_of(self._level.step(self._level_turn(order, (manual @ automatic).rotation @ up_in_body)))
        self.pose = level @ manual @ automatic
        self.idle = order.idle and all(slew.at_rest for slew in (self._manual, self._level, self._fade))
        if self.idle:
            self.pose = Pose.identity()
        self.reasons = ("the legs reach no further for the pose",) if self._reach.shortened else ()
        return self.pose

    def _with_the_gait(self, on: bool, gait: Gait, leg_phase: Array, swing: float, frequency: float) -> Pose:
        """The gait's own pose; at a change of gait it fades out before that of the new one fades in."""
        wanted = np.zeros(6)
        wanted[0] = 1.0 if on and gait is self._gait else 0.0
        fade = float(self._fade.step(wanted)[0])
        if fade == 0.0:
            if on and gait is not self._gait:
                self._choose(gait)
            return Pose.identity()
        swaying = automatic_pose(leg_phase, swing, self._amplitude, self._slope, self._rates, frequency)
        return pose_of(fade * swaying)

    def _choose(self, gait: Gait) -> None:
        self._gait = gait
        self._amplitude = leg_amplitudes(self._nominal, self._config.automatic.get(gait.name, AutomaticPose()))
        self._slope = steepest_slope(gait.offsets, gait.swing, self._amplitude)

    def _level_turn(self, order: PosingOrder, up_in_level: Array) -> Array:
        """Where levelling wants to be, (6,): roll and pitch alone."""
        wanted = np.zeros(6)
        if order.levelling:
            wanted[3:5] = self._levelling.step(tilt_error(up_in_level))
        else:
            self._levelling.clear()
        return wanted
