"""Feet and body while standing and walking: gait, footholds, posture, load and impedance, in that order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel
from robot_agent.locomotion.body_motion import BodyMotion
from robot_agent.locomotion.body_velocity import approach, limit_velocity
from robot_agent.locomotion.feet import (
    HANG,
    REACH,
    STAND,
    SWING,
    Feet,
    carry,
    carry_standing,
    count_mode,
    lift,
    move_swinging,
    take_anchors,
    until_next_lift,
)
from robot_agent.locomotion.gait_clock import GaitClock
from robot_agent.locomotion.gait_parameters import SteadyParameters
from robot_agent.locomotion.gait_start import best_start, overrun
from robot_agent.locomotion.impedance import LegImpedance
from robot_agent.locomotion.load import ease_share, share_load, surplus_force
from robot_agent.locomotion.posing.unposed import UnposedSenses
from robot_agent.locomotion.senses import LegSenses
from robot_agent.locomotion.workspace import reachable_radius
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.gaits import Gait

Array = NDArray[np.float64]

PACE_TIME = 0.12
"""s in which the gait slows to a halt when a foot finds no ground, and takes up again."""
BRAKING_STRIDE = 0.05
"""Fraction of a stride before the next lift-off at which a waiting gait begins to slow."""
FREE_OVERRUN, LARGEST_OVERRUN = 1.2, 1.5
"""In half strides: where a foot left too far behind begins to slow the body, and where it stops it."""


class Stepper:
    """Everything between a wanted body velocity and wanted foot places in body."""

    def __init__(self, robot: RobotDescription, model: LegModel, config: LocomotionConfig, dt: float) -> None:
        legs = model.leg_count
        self._config = config
        self._dt = dt
        self._nominal = robot.stance_in_body
        self._weight = robot.mass * GRAVITY
        self._radius = reachable_radius(
            model, self._nominal, np.array([-0.04, 0.0, 0.04]), 0.5 * config.largest_stride + 0.02
        )
        self._down_limit = float(self._nominal[:, 2].min()) - 0.09
        self._up_limit = float(self._nominal[:, 2].max()) + 0.16
        self._waited = 0.0
        self._halted = False  # no foot lifts any more
        self._skipped = False  # a foot has missed its lift-off, so the walk has to end before it goes on
        self._limited = np.zeros(3)
        self._surplus = np.zeros(legs)
        self.clock = GaitClock(robot.gait(robot.gaits[0]))
        self.feet = Feet(legs)
        self.body = BodyMotion(config.posture, -float(self._nominal[:, 2].mean()), dt)
        self.impedance = LegImpedance(legs, config.admittance, dt)
        self.walking = False
        self.pace = 1.0
        self.commanded = np.zeros(3)  # velocity after limits and slewing
        self.velocity = np.zeros(3)  # the same at the gait's present pace
        self.share = np.zeros(legs)
        self.load = np.zeros(legs)
        self.reasons: tuple[str, ...] = ()

    def begin(self, places: Array, share: Array, up: Array) -> None:
        """Stand with the feet at `places` (legs, 3), each carrying its `share` (legs,) 0..1."""
        self.feet.stand_at(places)
        self.impedance.clear()
        self.share[:] = share
        self.body.begin(np.array([-up[0] / up[2], -up[1] / up[2], float(places[:, 2].mean())]))
        self.walking = False
        self.pace = 1.0
        self.commanded[:] = 0.0
        self.velocity[:] = 0.0

    @property
    def stance(self) -> Array:
        """Middle of every foot's stance, (legs, 3), shifted for the inclination."""
        result = self._nominal.copy()
        result[:, :2] += self.body.shift
        return result

    def slow_down(self, factor: float) -> None:
        """The joints could follow only `factor` of the last tick: the gait takes its time."""
        self.pace = min(self.pace, max(factor, 0.1))

    def places(self, up: Array) -> Array:
        """Wanted foot centres in body with the impedance's offsets, (legs, 3)."""
        result: Array = self.feet.place + self.impedance.offset[:, :1] * up
        return result

    def step(self, senses: LegSenses | UnposedSenses, wanted: Array, parameters: SteadyParameters, gait: Gait) -> None:
        """One tick towards `wanted` (vx, vy, turn)."""
        self.reasons = ()
        stance = self.stance
        self._accelerate(wanted, stance, parameters.frequency)
        self._start_or_stop(wanted, stance, parameters.frequency, gait)
        if self.walking:
            self._advance(parameters, stance, senses.up)
        self._move(senses, stance, parameters)
        self._carry_load(senses, parameters)

    def _accelerate(self, wanted: Array, stance: Array, frequency: float) -> None:
        config = self._config
        factor = limit_velocity(
            wanted,
            stance,
            self._radius,
            self.clock.duty,
            frequency,
            config.largest_stride,
            config.largest_speed,
            self._limited,
        )
        if factor < 0.999:
            self.reasons += ("the stride is at its limit",)
        approach(
            self.commanded,
            self._limited,
            config.largest_speed / config.start_time,
            config.largest_speed / config.stop_time,
            self._dt,
        )

    def _start_or_stop(self, wanted: Array, stance: Array, frequency: float, gait: Gait) -> None:
        moving = bool(wanted.any())
        self.clock.choose(gait)
        if moving and not self.walking:
            phase = best_start(self.feet.place, stance, wanted, gait.offsets, gait.duty, frequency)
            self.clock.restart(phase)
            self.feet.lifted[:] = self.clock.leg_phase < self.clock.swing
            self.feet.lifted[(self.clock.leg_phase < 1e-9) | (self.clock.leg_phase > 1.0 - 1e-9)] = False
            self.walking, self._skipped, self.pace, self._waited = True, False, 1.0, 0.0
            self._halted = False
        elif self.walking:
            in_air = count_mode(self.feet.mode, SWING) + count_mode(self.feet.mode, REACH) > 0
            self._halted = not moving or self._skipped
            if self._halted and not in_air and not self.commanded.any():
                self.walking = False
                self._skipped = False
        if self.walking and self._halted and self._skipped:
            approach(self.commanded, np.zeros(3), 1.0, self._config.largest_speed / self._config.stop_time, self._dt)

    def _advance(self, parameters: SteadyParameters, stance: Array, up: Array) -> None:
        """Run the clock and lift the feet whose swing begins, or hold it while a foot still reaches for the ground."""
        feet, clock = self.feet, self.clock
        strides = parameters.frequency * self._dt
        until_lift = until_next_lift(feet.mode, feet.lifted, clock.leg_phase, clock.swing)
        reaching = count_mode(feet.mode, REACH) > 0
        target = min(max(until_lift / BRAKING_STRIDE, 0.0), 1.0) if reaching else 1.0
        change = self._dt / PACE_TIME
        self.pace += min(max(target - self.pace, -change), change)
        strides *= self.pace
        if reaching and strides >= until_lift - 1e-4:
            strides = 0.0
            self._waited += self._dt
            self.reasons += ("waiting for a foot to find ground",)
            if self._waited > self._config.foothold.waiting_time:
                feet.mode[feet.mode == REACH] = HANG
        else:
            self._waited = 0.0
        clock.advance(strides)
        phase, swing = clock.leg_phase, clock.swing
        for leg in range(phase.size):
            if phase[leg] >= swing:
                feet.lifted[leg] = False
            elif not feet.lifted[leg] and feet.mode[leg] in (STAND, HANG):
                if self._halted:
                    self._skipped = True
                    continue
                lift(
                    leg, feet.mode, feet.place, feet.lift_off, self.impedance.offset, up, parameters.height,
                    feet.swing_height, feet.lifted, feet.reached,
                )  # fmt: skip

    def _move(self, senses: LegSenses | UnposedSenses, stance: Array, parameters: SteadyParameters) -> None:
        config, feet, body = self._config, self.feet, self.body
        np.multiply(self.commanded, self.pace, out=self.velocity)
        far = overrun(feet.mode, feet.place, stance, self.velocity, 0.5 * config.largest_stride)
        if far > FREE_OVERRUN:
            self.velocity *= max((LARGEST_OVERRUN - far) / (LARGEST_OVERRUN - FREE_OVERRUN), 0.0)
            self.reasons += ("a foot is left far behind",)
        body.update(feet.anchor, feet.mode, senses.up, senses.centre_of_mass, self.velocity)
        carry_standing(feet.mode, feet.place, body.whole_linear, body.whole_angular, self._dt)
        carry(feet.anchor, body.whole_linear, body.whole_angular, self._dt)
        carry(feet.lift_off, body.linear, body.angular, self._dt)
        move_swinging(
            feet.mode,
            feet.place,
            feet.lift_off,
            stance,
            body.plane,
            senses.up,
            self.commanded,
            self.pace,
            feet.swing_height,
            feet.reached,
            senses.contact,
            self.clock.leg_phase,
            self.clock.duty,
            parameters.frequency,
            config.foothold.touchdown_speed,
            config.foothold.reach_down,
            config.foothold.earliest_contact,
            config.feel_ground,
            self._dt,
            self._down_limit,
            self._up_limit,
        )
        take_anchors(feet.mode, senses.contact, senses.feet, feet.place, config.feel_ground, feet.anchor)

    def _carry_load(self, senses: LegSenses | UnposedSenses, parameters: SteadyParameters) -> None:
        """Share the weight among the standing feet, easing it on after touch-down and off before lift-off."""
        feet = self.feet
        lifting = self.walking and not self._halted
        stride_time, load_time = 1.0 / parameters.frequency, self._config.foothold.load_time
        ease_share(feet.mode, feet.lifted, self.clock.leg_phase, lifting, stride_time, load_time, self._dt, self.share)
        share_load(feet.place, senses.centre_of_mass, senses.up, self.share, self._weight, self.load)
        if self._config.feel_ground:
            surplus_force(feet.mode, senses.force, self.load, self._surplus)
            self.impedance.step(self._surplus, parameters.stiffness)
