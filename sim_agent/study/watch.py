"""What is noted at every tick of a walk: margins, tilt, height, touches, and whether the robot has fallen."""

from __future__ import annotations

import numpy as np

from sim_agent.study.rig import Rig

FALLEN_TILT = 0.45  # rad beyond the ground's own slope
FALLEN_HEIGHT = 0.4
"""Of the clearance."""
SLOPE_BASE = 0.3  # m before and behind the body between which the ground's slope is taken


class Watch:
    """Grows by one `look` a tick."""

    def __init__(self) -> None:
        self.static_margin = self.energy_margin = np.inf
        self.tilt = 0.0
        self.touches = 0
        self.fell = False
        self._slope = 0.0

    def look(self, rig: Rig) -> bool:
        """Note this tick; returns whether the robot is still up."""
        pose, out = rig.truth(), rig.out
        x, y, z = (float(value) for value in pose.position)
        ahead, here, behind = rig.world.elevation([x + SLOPE_BASE, x, x - SLOPE_BASE], [y, y, y])
        self._slope = max(self._slope, float(np.arctan(abs(ahead - behind) / (2.0 * SLOPE_BASE))))
        tilt = rig.tilt()
        self.tilt = max(self.tilt, tilt)
        self.static_margin = min(self.static_margin, out.stability_margin)
        self.energy_margin = min(self.energy_margin, out.energy_margin)
        _, rest = rig.body.contact_forces()
        self.touches += bool(np.abs(rest).max() > 0.0)
        self.fell |= tilt > FALLEN_TILT + self._slope or z - float(here) < FALLEN_HEIGHT * rig.robot.clearance
        return not self.fell
