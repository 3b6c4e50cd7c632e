"""Plans the body's pose against its un-posed place, from what the operator wants (OpenSHC'20 IV-B).

The walk is planned in the un-posed frame; feet are turned into the body just before the inverse kinematics, and what
is measured in the body is turned back before the walk sees it. So posing neither drags a foot nor fights posture.
What changes with an order is worked out here; what changes every tick, in `pose_tick`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel
from robot_agent.locomotion.posing.automatic import leg_amplitudes, steepest_slope
from robot_agent.locomotion.posing.levelling import clear_levelling, tune_levelling
from robot_agent.locomotion.posing.order import PosingOrder, bounded
from robot_agent.locomotion.posing.pose_tick import FADE, LEVEL, MANUAL, MEANS, VALUE
from robot_agent.locomotion.posing.reach import PoseReach
from robot_agent.locomotion.walk_state import WalkState
from weaver_shared.config.locomotion import AutomaticPose, LocomotionConfig
from weaver_shared.robots.gaits import Gait
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]


class Poser:
    """Writes what is wanted of the pose into the walker's memory; `slews` is what `pose_tick` remembers."""

    def __init__(
        self,
        config: LocomotionConfig,
        model: LegModel,
        nominal: Array,
        centre_of_mass: Array,
        state: WalkState,
        dt: float,
    ) -> None:
        self._config = posing = config.posing
        self._nominal = nominal
        self._room = 0.5 * config.largest_stride
        self._reach = PoseReach(model, nominal, centre_of_mass, config.stability.lift_static)
        self._record, self._orders = state.record["posing"], state.record["orders"]
        self._manual = self._record["manual"]
        rows = [max(round(time / dt), 1) for time in posing.smoothing]
        self.slews = np.zeros((3, MEANS + sum(rows), 6))
        rates = np.array([posing.position_rate, posing.rotation_rate])
        self._record["first"] = rows[0]
        self._record["steps"][[MANUAL, LEVEL]] = rates * dt
        self._record["steps"][FADE] = dt / posing.fade_time, dt
        self._record["rates"] = np.repeat(rates, 3)
        tune_levelling(self._record, posing.levelling, dt)
        self._gait: Gait | None = None  # whose automatic pose is under way
        self.clear()

    def clear(self) -> None:
        """Be un-posed at once: for a robot that does not carry itself."""
        self.slews[:] = 0.0
        self._record["still"] = self.slews.shape[1] + 1
        clear_levelling(self._record)
        self._record["idle"], self._record["fade"] = True, 0.0
        self._orders["posing_rotation"] = self._orders["still_rotation"] = np.eye(3)
        self._orders["posing_position"] = self._orders["still_position"] = 0.0
        self._planned: tuple[PosingOrder, bool] | None = None
        self.idle = True  # un-posed, and stays so
        self.reasons: tuple[str, ...] = ()

    @property
    def pose(self) -> Pose:
        """unposed_from_body."""
        return Pose(
            rotation=self._orders["posing_rotation"].copy(), position=self._orders["posing_position"].copy()
        )  # fmt: skip

    def plan(self, order: PosingOrder, gait: Gait, *, walking: bool) -> None:
        """Before a tick that is not `idle` or shall not stay so."""
        self.idle = False
        chosen = gait is self._gait or not order.automatic
        if chosen and self._reach.settled and self._planned == (order, walking):
            return
        self._planned = order, walking
        self._manual[:] = self._reach.fit(bounded(order.manual, self._config), self._room if walking else 0.0)
        self.reasons = ("the legs reach no further for the pose",) if self._reach.shortened else ()
        if order.automatic and walking and gait is not self._gait and self.slews[FADE, VALUE, 0] == 0.0:
            self._choose(gait)
        self._record["automatic"] = order.automatic and gait is self._gait
        self._record["levelling"], self._record["wanted"] = order.levelling, not order.idle

    def leans(self, gait: Gait) -> bool:
        """Whether the body moves with this gait unasked."""
        pose = self._config.automatic.get(gait.name)
        return pose is not None and pose.always

    def rest(self) -> None:
        """After a tick: whether the pose has come to rest."""
        self.idle = bool(self._record["idle"])
        if self.idle:
            self._planned, self.reasons = None, ()

    def _choose(self, gait: Gait) -> None:
        """At a change of gait its own pose fades out before that of the new one fades in."""
        self._gait = gait
        pose = self._config.automatic.get(gait.name, AutomaticPose())
        amplitude = leg_amplitudes(self._nominal, pose)
        self._record["amplitude"][: len(amplitude)] = amplitude
        self._record["ahead"] = pose.ahead
        self._record["slope"] = steepest_slope(gait.offsets, gait.swing, pose.ahead, amplitude)
