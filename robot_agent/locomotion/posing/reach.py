"""How much of a wanted pose the legs can carry: all of it, or the largest part found by halving."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel, solve_legs
from robot_agent.locomotion.stability import static_margin
from weaver_shared.transforms import Pose, rotation_from_rpy

Array = NDArray[np.float64]

LIMIT_MARGIN = 0.03
"""rad kept from every joint limit."""
HALVINGS = 7
CLOSE_ENOUGH = 1e-4  # m


def pose_of(values: Array) -> Pose:
    """unposed_from_body of x, y, z (m), roll, pitch, yaw (rad), (6,)."""
    return Pose(rotation=rotation_from_rpy(*values[3:]), position=values[:3].copy())


class PoseReach:
    """One trial a tick, so that a robot without closed-form legs does not miss its tick."""

    def __init__(self, model: LegModel, nominal: Array, centre_of_mass: Array, least_margin: float) -> None:
        self._model = model
        self._limits = model.limits_less(LIMIT_MARGIN)
        self._nominal = nominal
        self._centre = centre_of_mass
        self._least_margin = least_margin
        self._all = np.ones(model.leg_count, dtype=np.bool_)
        self._middle = np.tile(model.standing, (model.leg_count, 1))
        self._angles = np.zeros_like(self._middle)
        self._left = np.zeros(model.leg_count)
        self._wanted = np.zeros(6)
        self._room = 0.0
        self._low, self._high, self._trials = 1.0, 1.0, HALVINGS

    @property
    def settled(self) -> bool:
        """Whether no trial is left to do for what was asked."""
        return self._low >= self._high or self._trials >= HALVINGS

    @property
    def shortened(self) -> bool:
        """Whether less than what was asked can be done."""
        return self._trials > 0 and self._low < 1.0

    def fit(self, wanted: Array, room: float) -> Array:
        """The part of `wanted` (6,) that is known to be within reach with `room` m about every foot for its stride."""
        if (wanted != self._wanted).any() or room != self._room:
            self._wanted, self._room = wanted.copy(), room
            self._low, self._high, self._trials = 0.0, 1.0, 0
        if not self.settled:
            trial = 1.0 if self._trials == 0 else 0.5 * (self._low + self._high)
            if self.within(trial * wanted, room):
                self._low = trial
            else:
                self._high = trial
            self._trials += 1
        return self._low * wanted

    def within(self, values: Array, room: float) -> bool:
        """Whether every foot is reached from the pose `values` (6,), and the mass stays over the feet."""
        pose = pose_of(values)
        places = pose.inverse().transform(self._nominal)
        up = pose.rotation.T @ np.array([0.0, 0.0, 1.0])
        if static_margin(places, self._all, self._centre, up) < self._least_margin:
            return False
        corners = room * np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
        return all(self._reached(places + corner, -up) for corner in (corners if room > 0.0 else np.zeros((1, 3))))

    def _reached(self, feet_in_body: Array, direction: Array) -> bool:
        model = self._model
        solve_legs(
            model.dh,
            self._limits,
            model.closed_form,
            model.hips,
            model.hip_axes,
            feet_in_body,
            direction,
            self._middle,
            self._angles,
            self._left,
        )
        return bool((self._left < CLOSE_ENOUGH).all())
