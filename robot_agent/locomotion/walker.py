"""Locomotion from wanted velocity to servo targets: stand up, walk, stop, sit down (ICRA'17 III-C)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel, limit_joint_speed, solve_legs
from robot_agent.locomotion.body_velocity import clean_velocity
from robot_agent.locomotion.energy_margin import energy_margin
from robot_agent.locomotion.feet import REACH, STAND, SWING
from robot_agent.locomotion.gait_parameters import SteadyParameters
from robot_agent.locomotion.posing.order import NO_POSING
from robot_agent.locomotion.posing.poser import Poser
from robot_agent.locomotion.posing.unposed import UnposedSenses
from robot_agent.locomotion.rising import Glide
from robot_agent.locomotion.senses import LegSenses
from robot_agent.locomotion.servo_lead import lead_servos
from robot_agent.locomotion.stability import static_margin
from robot_agent.locomotion.stability_watch import StabilityWatch, is_static
from robot_agent.locomotion.stepper import Stepper
from robot_agent.locomotion.walk_tick import WalkInput, WalkOutput
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

LOADING = 0.15
"""Fraction of the way up, and of the way down, in which the feet take over the weight from the belly."""


class Walker:
    """One robot's legs. Deterministic: the same inputs give the same outputs; time comes in as `dt` s a tick."""

    def __init__(self, robot: RobotDescription, config: LocomotionConfig | None = None, dt: float = 0.01) -> None:
        self._robot = robot
        self._config = config = config or robot.locomotion
        self._dt = dt
        self._model = model = LegModel.of_robot(robot, speed_fraction=config.speed_fraction)
        legs, joints = model.leg_count, model.joints_per_leg
        self._senses = LegSenses(robot, model, config, dt)
        self._stepper = Stepper(robot, model, config, dt)
        self._parameters = SteadyParameters(config, dt)
        self._unposed = UnposedSenses(self._senses)
        self._poser = Poser(config, model, robot.stance_in_body, np.array(robot.body.centre_of_mass_in_body), dt)
        self._weight = robot.mass * GRAVITY
        self._sitting_height = float(robot.sitting_in_body[0, 2]) + config.sitting_lift
        self._lag = model.servo_lag + dt  # the bus brings a target one tick later
        self._angles = np.zeros((legs, joints))  # wanted, without the servos' lead
        self._previous = np.zeros((legs, joints))
        self._target = np.zeros((legs, joints))
        self._distance_left = np.zeros(legs)
        self._feet = np.zeros((legs, 3))
        self._load = np.zeros(legs)
        self._stability = StabilityWatch(config.stability, dt)
        self._margins = (0.0, 0.0)  # m, static and energy
        self._posture = "sitting"
        self._joint_glide: Glide | None = None
        self._foot_glide: Glide | None = None
        self.reset(np.zeros(legs * joints))

    def reset(self, joint_position: Array) -> None:
        """Begin from where the joints are: hold them, sitting, until told to stand."""
        angles = np.asarray(joint_position, dtype=np.float64).reshape(self._angles.shape)
        angles = np.where(np.isfinite(angles), angles, self._angles)
        np.clip(angles, self._model.limits[:, 0], self._model.limits[:, 1], out=self._angles)
        self._previous[:] = self._angles
        self._posture = "sitting"
        self._joint_glide = self._foot_glide = None
        self._poser.clear()

    def begin_standing(self) -> Array:
        """Be standing at once, feet on their stance; returns the joint angles (joints,) that this means."""
        stance = self._robot.stance_in_body
        self._feet[:] = stance
        self._solve(stance, np.array([0.0, 0.0, -1.0]))
        self._previous[:] = self._angles
        self._senses.stand(self._angles)
        self._stepper.begin(stance, np.ones(self._load.size), self._senses.up)
        self._posture = "standing"
        return self._angles.ravel().copy()

    def step(self, sensed: WalkInput) -> WalkOutput:
        """One control tick. Readings and orders that are not finite are replaced and named in `reasons`."""
        senses, dt = self._senses, self._dt
        senses.update(sensed)
        reasons = senses.complaints
        velocity, usable = clean_velocity(sensed.velocity)
        if not usable:
            reasons += ("the velocity order is not a number",)
        if not self._parameters.follow(sensed.parameters):
            reasons += ("a gait parameter is not a number",)
        reasons += self._judge_stability(sensed.gait)
        self._previous[:] = self._angles
        self._act(sensed, velocity * self._stability.factor)
        together = self._stepper.feet.mode == STAND
        factor = limit_joint_speed(self._previous, self._angles, self._model.speed_limit, together, dt)
        if factor < 1.0:
            self._stepper.slow_down(factor)
            reasons += ("a servo is at its largest speed",)
        self._lead()
        return self._answer(reasons + self._stepper.reasons + self._poser.reasons)

    def _judge_stability(self, gait: str) -> tuple[str, ...]:
        """Margins of the feet that carry; what they lead to while the robot is on its legs in a static gait."""
        senses, mode = self._senses, self._stepper.feet.mode
        carrying = (mode == STAND) | (self._posture not in ("standing", "walking"))
        feet, centre, up = senses.feet, senses.centre_of_mass, senses.up
        self._margins = (static_margin(feet, carrying, centre, up), energy_margin(feet, carrying, centre, up))
        if self._posture in ("standing", "walking") and is_static(self._robot.gait(gait)):
            self._stability.update(*self._margins)
        else:
            self._stability.clear()
        return self._stability.reasons

    def _act(self, sensed: WalkInput, velocity: Array) -> None:
        """Set the wanted joint angles of this tick according to the posture."""
        if self._posture == "sitting":
            self._load[:] = 0.0
            if sensed.stand:
                self._begin_rising()
        elif self._posture in ("rising", "lowering"):
            self._glide(sensed.stand)
        else:
            self._walk(sensed, velocity)

    def _walk(self, sensed: WalkInput, velocity: Array) -> None:
        stepper, poser = self._stepper, self._poser
        senses: LegSenses | UnposedSenses = self._senses
        if not poser.idle:
            self._unposed.update(poser.pose)
            senses = self._unposed
        stepper.step(senses, velocity if sensed.stand else np.zeros(3), self._parameters, self._robot.gait(sensed.gait))
        self._load[:] = stepper.load
        self._feet[:] = stepper.places(senses.up)
        self._pose(sensed)
        self._solve(self._feet, -self._senses.up)
        self._posture = "walking" if stepper.walking else "standing"
        if not sensed.stand and not stepper.walking and poser.idle:
            self._begin_lowering()

    def _pose(self, sensed: WalkInput) -> None:
        """Turn the wanted feet from the un-posed body into the body as it is to be posed."""
        stepper, poser, clock = self._stepper, self._poser, self._stepper.clock
        pose = poser.step(
            sensed.posing if sensed.stand else NO_POSING,
            self._senses.up,
            walking=stepper.walking,
            gait=clock.gait,
            leg_phase=clock.leg_phase,
            swing=clock.swing,
            frequency=self._parameters.frequency,
        )
        if not poser.idle:
            self._feet[:] = pose.inverse().transform(self._feet)

    def _begin_rising(self) -> None:
        """First fold the legs, feet under their stance, then push up."""
        stance = self._robot.stance_in_body
        feet = stance.copy()
        lowest = self._sitting_height
        feet[:, 2] = float(np.clip(np.median(self._senses.feet[:, 2]), stance[0, 2], lowest))
        start = self._angles.copy()
        self._solve(feet, -self._senses.up)
        self._joint_glide = Glide(start, self._angles, self._config.soft_start_speed)
        self._angles[:] = start
        self._foot_glide = Glide(feet, stance, self._config.rise_speed)
        self._stepper.feet.stand_at(feet)
        self._posture = "rising"

    def _begin_lowering(self) -> None:
        self._joint_glide = None
        goal = self._feet.copy()
        goal[:, 2] = self._sitting_height
        self._foot_glide = Glide(self._feet, goal, self._config.rise_speed)
        self._posture = "lowering"

    def _glide(self, stand: bool) -> None:
        if self._joint_glide is not None and not self._joint_glide.done:
            self._angles[:] = self._joint_glide.step(self._dt)
            self._load[:] = 0.0
            return
        if stand != (self._posture == "rising"):
            self._turn_back(stand)
        assert self._foot_glide is not None
        self._feet[:] = self._foot_glide.step(self._dt)
        self._solve(self._feet, -self._senses.up)
        progress = self._foot_glide.progress
        carried = min((progress if self._posture == "rising" else 1.0 - progress) / LOADING, 1.0)
        self._load[:] = carried * self._weight / self._load.size
        if self._foot_glide.done:
            self._arrive()

    def _turn_back(self, stand: bool) -> None:
        """Stand asked while sitting down, or the other way round: go back from here."""
        if stand:
            self._joint_glide = None
            self._foot_glide = Glide(self._feet, self._robot.stance_in_body, self._config.rise_speed)
            self._posture = "rising"
        else:
            self._begin_lowering()

    def _arrive(self) -> None:
        if self._posture == "rising":
            self._stepper.begin(self._feet, np.ones(self._load.size), self._senses.up)
            self._posture = "standing"
        else:
            self._posture = "sitting"

    def _solve(self, feet: Array, direction: Array) -> None:
        model = self._model
        solve_legs(
            model.dh,
            model.limits,
            model.yaw_roll_pitch,
            model.hips,
            model.hip_axes,
            feet,
            direction,
            self._previous,
            self._angles,
            self._distance_left,
        )

    def _lead(self) -> None:
        if not self._config.compensate_servos or self._posture == "sitting":
            self._target[:] = self._angles
            return
        model, senses = self._model, self._senses
        rate = (self._angles - self._previous) / self._dt
        lead_servos(
            self._angles,
            rate,
            senses.origins,
            senses.axes,
            model.link_mass,
            senses.up,
            self._load,
            model.servo_stiffness,
            self._lag,
            model.limits,
            self._target,
        )

    def _answer(self, reasons: tuple[str, ...]) -> WalkOutput:
        stepper, senses = self._stepper, self._senses
        upright = self._posture in ("standing", "walking")
        mode = stepper.feet.mode
        swing = ((mode == SWING) | (mode == REACH)) & upright
        return WalkOutput(
            joint_position=self._target.ravel().copy(),
            foot_in_body=self._feet.copy(),
            foot_force=senses.force.copy(),
            phase=stepper.clock.leg_phase,
            swing=swing,
            velocity=stepper.velocity.copy() if self._posture == "walking" else np.zeros(3),
            stability_margin=float(self._margins[0]),
            energy_margin=float(self._margins[1]),
            stability=self._stability.level,
            ground_plane=stepper.body.plane.copy(),
            ground_residual=float(stepper.body.residual),
            unposed_from_body=self._poser.pose,
            posture=self._posture,
            reasons=reasons,
        )
