"""What moves with the robot besides its links: support polygon, foot forces, look-ahead, trail, covariance."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.balance_figure import BalanceFigure
from weaver_console.scene.layers import TRANSPORT
from weaver_console.scene.lines import NONE, Lines, chained
from weaver_console.scene.posture import Posture
from weaver_shared.messages import MissionState, OdometryEstimate, RobotState

Array = NDArray[np.float64]

FORCE_SCALE = 0.004
"""Metres of line per newton."""

TRAIL_STEP = 0.04
LONGEST_TRAIL = 1500
SIGMAS = 3.0

_SUPPORT = (52, 199, 129)
_UNSTABLE = (239, 83, 80)
_FORCE = (120, 200, 255)
_LOOKAHEAD = (64, 156, 255)
_TRAIL = (170, 180, 196)
_COVARIANCE = (190, 140, 255)


class MotionFigure:
    def __init__(self, scene: Any, name: str) -> None:
        self._support = Lines(scene, f"{name}/support", _SUPPORT)
        self._forces = Lines(scene, f"{name}/forces", _FORCE)
        self._lookahead = Lines(scene, f"{name}/lookahead", _LOOKAHEAD)
        self._trail_line = Lines(scene, f"{name}/trail", _TRAIL)
        self._covariance = Lines(scene, f"{name}/covariance", _COVARIANCE)
        self._balance = BalanceFigure(scene, f"{name}/balance")
        self._trail: list[Array] = []
        self._costs: list[float] = []
        self._trail_shown = True
        self._stable: bool | None = None

    def update(self, posture: Posture) -> None:
        state, feet = posture.state, posture.feet_in_world
        self._support.chain(posture.support)
        self._balance.update(posture.mass, posture.support, state.stability_margin)
        self._colour_support(state.stability_margin > 0.0)
        force = np.clip(state.foot_force, 0.0, 200.0)[:, None] * np.array([0.0, 0.0, FORCE_SCALE])
        self._forces.show(np.stack([feet, feet + force], axis=1)[state.foot_contact & (state.foot_force > 1.0)])

    def lookahead(self, state: RobotState, mission: MissionState | None) -> None:
        if mission is None or not np.isfinite(mission.lookahead_in_world).all():
            self._lookahead.show(NONE)
            return
        begin = state.position_in_world
        self._lookahead.chain(np.array([begin, [*mission.lookahead_in_world, begin[2]]]))

    def covariance(self, odometry: OdometryEstimate) -> None:
        """Three-sigma ellipse of the horizontal position."""
        matrix = odometry.covariance[3:5, 3:5]
        if not np.isfinite(matrix).all():
            self._covariance.show(NONE)
            return
        values, vectors = np.linalg.eigh(matrix)
        radii = SIGMAS * np.sqrt(np.clip(values, 0.0, 4.0))
        angles = np.linspace(0.0, 2.0 * np.pi, 33)
        ellipse = (vectors * radii) @ np.stack([np.cos(angles), np.sin(angles)])
        self._covariance.chain(np.column_stack([ellipse.T, np.zeros(33)]) + odometry.position_in_world)

    def show_trail(self, wanted: bool) -> None:
        self._trail_shown = wanted
        segments = chained(np.array(self._trail)) if wanted and self._trail else NONE
        colours = TRANSPORT.colours(np.array(self._costs[1:]))
        colours[~np.isfinite(self._costs[1:])] = _TRAIL
        self._trail_line.show_in(segments, colours[: len(segments)])

    def leave_trail(self, state: RobotState, cost_of_transport: float) -> None:
        """Coloured by what the last seconds of way cost; grey where that is not known."""
        position = state.position_in_world
        if self._trail and float(np.linalg.norm(position - self._trail[-1])) < TRAIL_STEP:
            return
        self._trail = [*self._trail[-LONGEST_TRAIL:], np.array(position)]
        self._costs = [*self._costs[-LONGEST_TRAIL:], cost_of_transport]
        if self._trail_shown:
            self.show_trail(True)

    def _colour_support(self, stable: bool) -> None:
        if stable is not self._stable:
            self._stable = stable
            self._support.colour(_SUPPORT if stable else _UNSTABLE)
