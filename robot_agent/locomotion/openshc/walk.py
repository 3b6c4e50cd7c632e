"""OpenSHC 0.5.11's walk controller, tick for tick: velocity, walk states, step states and tips (facts 3.3-3.7)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.leg import Leg
from robot_agent.locomotion.openshc.limits import SpeedLimits, limit_towards, walkspace, workspace
from robot_agent.locomotion.openshc.robots import Robot
from robot_agent.locomotion.openshc.start_states import START_STATES
from robot_agent.locomotion.openshc.step_cycle import StepCycle
from robot_agent.locomotion.openshc.tip_path import FORCE_STANCE, FORCE_STOP, STANCE, SWING, TipPath

Array = NDArray[np.float64]

STARTING, MOVING, STOPPING, STOPPED = range(4)
TIP_TOLERANCE = 0.01


class Walk:
    """A whole robot. `tick` takes the throttle command and moves everything by one tick."""

    def __init__(self, robot: Robot, gait: str) -> None:
        self.robot = robot
        self.cycle = StepCycle.of(gait, robot.step_frequency, robot.dt)
        self.state = STOPPED
        self.linear, self.angular = np.zeros(2), 0.0
        defaults = np.column_stack([robot.stance, np.zeros(len(robot.stance))])
        self.paths = [TipPath(default, robot.swing_height, robot.dt) for default in defaults]
        self.legs, radii = started(robot)
        self.limits = SpeedLimits.of(radii, self.cycle, robot.stance, robot.dt)
        count = len(self.legs)
        self.phase = [1] * count
        self.step_state = [FORCE_STOP] * count
        self.progress = [(-1.0, 0.0)] * count  # of swing and stance, -1 outside
        self._begun = False
        self._in_phase, self._first_step, self._tried, self._stopped = (
            [False] * count,
            [False] * count,
            [False] * count,
            [True] * count,
        )

    def tick(self, linear: Array, angular: float) -> None:
        """`linear` (2,) and `angular` are fractions of the largest velocity."""
        moving = bool(np.any(np.asarray(linear)) or angular)
        self._slew(np.asarray(linear, dtype=np.float64), float(angular))
        self._change_state(moving)
        if self.state == STARTING and not self._begun:
            self._begun = True
        elif self.state != STOPPED:
            for leg, path in enumerate(self.paths):
                self._step(leg, path)
        for chain, path in zip(self.legs, self.paths, strict=True):
            chain.step_to(path.tip - np.array([0.0, 0.0, self.robot.clearance]))

    def _change_state(self, moving: bool) -> None:
        count = len(self.legs)
        if self.state == STOPPED and moving:
            self.state, self._begun = STARTING, False
            self.phase = list(self.cycle.offsets)
            self.step_state = [self._timed(leg) for leg in range(count)]
            self._in_phase, self._first_step = [False] * count, [False] * count
        elif self.state == STARTING and all(self._first_step):
            self.state = MOVING
        elif self.state == MOVING and not moving:
            self.state = STOPPING
            self._tried, self._stopped = [False] * count, [False] * count
        elif self.state == STOPPING and all(self._stopped):
            self.state = STOPPED
            self.phase = [1] * count

    def _slew(self, linear: Array, angular: float) -> None:
        """Throttle to velocity, then at most the largest acceleration."""
        tips, dt = np.array([path.tip for path in self.paths]), self.robot.dt
        size = float(np.linalg.norm(linear))
        linear = linear / size if size > 1.0 else linear
        angular = min(max(angular, -1.0), 1.0)
        args = (tips, linear, angular)
        wanted = linear * limit_towards(self.limits.linear, *args) * (1.0 - abs(angular))
        turn = angular * limit_towards(self.limits.angular, *args)
        if self.state == STOPPING:
            wanted, turn = np.zeros(2), 0.0
        change, turn_change = wanted - self.linear, turn - self.angular
        largest = limit_towards(self.limits.linear_acceleration, *args) * dt
        norm = float(np.linalg.norm(change))
        self.linear = self.linear + (change if norm < largest else change / norm * largest)
        largest = limit_towards(self.limits.angular_acceleration, *args) * dt
        self.angular += turn_change if abs(turn_change) < largest else np.sign(turn_change) * largest

    def _timed(self, leg: int) -> int:
        return SWING if self.cycle.swing_start <= self.phase[leg] < self.cycle.swing_end else STANCE

    def _step(self, leg: int, path: TipPath) -> None:
        """The leg's state is decided and its tip moved in the phase of the tick before; then the phase runs on."""
        if self.state == STARTING:
            self._begin_leg(leg)
        elif self.state == STOPPING:
            self._end_leg(leg, path)
        self._move(leg, path)
        self.phase[leg] = (self.phase[leg] + 1) % self.cycle.period
        timed = self._timed(leg)
        if self.step_state[leg] != FORCE_STOP and not (self.step_state[leg] == FORCE_STANCE and timed == SWING):
            self.step_state[leg] = timed
        self.progress[leg] = self._progress(leg)

    def _progress(self, leg: int) -> tuple[float, float]:
        cycle, phase = self.cycle, self.phase[leg]
        if self.step_state[leg] == SWING:
            return min((phase - cycle.swing_start + 1) / cycle.swing_period, 1.0), -1.0
        if self.step_state[leg] == STANCE:
            return -1.0, min(((phase - cycle.stance_start) % cycle.period + 1) / cycle.stance_period, 1.0)
        return -1.0, 0.0

    def _begin_leg(self, leg: int) -> None:
        """Legs whose offset lies inside the swing stand until that swing is over; then each counts a first step."""
        cycle = self.cycle
        if all(self._in_phase) and self.phase[leg] == cycle.swing_end:
            self._first_step[leg] = True
        if self._in_phase[leg]:
            return
        if cycle.swing_start < cycle.offsets[leg] < cycle.swing_end and self.phase[leg] != cycle.swing_end:
            self.step_state[leg] = FORCE_STANCE
        else:
            self._in_phase[leg] = True

    def _end_leg(self, leg: int, path: TipPath) -> None:
        """A leg stops at the end of a swing without stride, once near its target or on the second attempt."""
        if self._stopped[leg] or path.stride.any() or self.phase[leg] != self.cycle.swing_end:
            return
        near = float(np.linalg.norm((path.tip - path.target)[:2])) < TIP_TOLERANCE
        if near or self._tried[leg]:
            self._stopped[leg] = True
            self.step_state[leg] = FORCE_STOP
        self._tried[leg] = True

    def _move(self, leg: int, path: TipPath) -> None:
        cycle, phase = self.cycle, self.phase[leg]
        path.aim(self.linear, self.angular, cycle)
        if self.step_state[leg] == SWING:
            path.swing(phase - cycle.swing_start + 1, cycle)
        elif self.step_state[leg] in (STANCE, FORCE_STANCE):
            first = cycle.offsets[leg] if self.state == STARTING and not self._first_step[leg] else cycle.stance_start
            path.stand((phase - first) % cycle.period + 1, first, cycle)


def started(robot: Robot) -> tuple[list[Leg], dict[int, float]]:
    """Legs after the start-up, and the walkspace found there."""
    places = np.column_stack([robot.stance, np.full(len(robot.stance), -robot.clearance)])
    state = START_STATES.get(robot.name)
    legs = []
    for leg in range(len(places)):
        start = robot.unpacked[leg] if state is None else state.position[leg]
        legs.append(Leg(robot.dh[leg], robot.limits[leg], robot.max_rate, robot.clamp_rate, robot.dt, start))
    if state is None:
        radii = walkspace(
            robot.stance, [workspace(_settled(leg, place), place) for leg, place in zip(legs, places, strict=True)]
        )
        return legs, radii
    for chain, rate in zip(legs, state.rate, strict=True):
        chain.rate = rate.copy()
    return legs, {bearing: state.walkspace[bearing // 45 % 4] for bearing in range(0, 361, 45)}


def _settled(leg: Leg, place: Array) -> Leg:
    """The leg brought to its stance as OpenSHC's direct start-up does: the tip in equal steps over the time given."""
    begin = leg.tip()
    for step in range(1, 301):
        leg.step_to(begin + (place - begin) * step / 300)
    return leg
