"""Locomotion from wanted velocity to servo targets: stand up, walk, stop, sit down (ICRA'17 III-C)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel
from robot_agent.locomotion.folding import Folding
from robot_agent.locomotion.footholds import Footholds
from robot_agent.locomotion.footing import Footing
from robot_agent.locomotion.leg_reach import LegReach
from robot_agent.locomotion.legs_tick import (
    believe,
    foot_tick,
    hold_tick,
    joint_tick,
    sense_tick,
    solve_feet,
    walk_tick,
)
from robot_agent.locomotion.manipulation import Manipulation
from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from robot_agent.locomotion.posing.poser import Poser
from robot_agent.locomotion.posture_change import LOADING, PostureChange
from robot_agent.locomotion.posture_plan import PosturePlan
from robot_agent.locomotion.rising import Glide
from robot_agent.locomotion.stability_watch import StabilityWatch, is_static
from robot_agent.locomotion.stepper import stand
from robot_agent.locomotion.walk_tick import WalkInput, WalkOutput
from robot_agent.locomotion.walker_memory import walker_memory
from robot_agent.locomotion.whole_tick import UNSTABLE, answer_tick, posed_tick, posed_walk_tick, usual_tick
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

UPRIGHT = ("standing", "walking")
NO_MARGINS = (-np.inf, -np.inf)
MARCH = 2e-4
"""m/s: to step in place is to walk at hardly any speed."""
LONGEST_MARCH = 4.0
"""Strides."""
LEVEL = 0.1
"""Slope of the ground, and roughness over the leg's length, on which legs are turned into another posture."""


class Walker:
    """One robot's legs. Deterministic: the same inputs give the same outputs; time comes in as `dt` s a tick."""

    def __init__(self, robot: RobotDescription, config: LocomotionConfig | None = None, dt: float = 0.01) -> None:
        self._robot = robot
        self._config = config = config or robot.locomotion
        self._dt = dt
        self._model = model = LegModel.of_robot(robot, speed_fraction=config.speed_fraction)
        self._state = state = walker_memory(robot, model, config, dt)
        self._memory = state.memory
        self._velocity, self._parameters = state.cut("orders", "velocity"), state.cut("orders", "parameters")
        self._position, self._torque = state.cut("readings", "joint_position"), state.cut("readings", "joint_torque")
        self._contact, self._gravity = state.cut("readings", "contact"), state.cut("readings", "gravity")
        self._measured_feet = state.cut("senses", "origins")[:, -1]  # m in body
        self._in_air = state.cut("feet", "in_air").view(np.bool_)
        self._places, self._stances = state.cut("feet", "place"), state.cut("feet", "stance")
        self._phase = state.cut("gait", "leg_phase")
        self._walked = state.cut("gait", "velocity")
        self._feet = state.cut("joint", "foot")
        self._angles = state.cut("joint", "wanted")
        self._target = state.cut("joint", "target")
        self._load = state.cut("load", "load")
        self._sitting_height = float(robot.sitting_in_body[0, 2]) + config.sitting_lift
        self._told = state.answer
        self._feels_ground = config.feel_ground
        self._unhindered = False  # on its legs, stable, with none in hand and without a pose
        self._poser = Poser(config, model, robot.stance_in_body, np.array(robot.body.centre_of_mass_in_body), state, dt)
        self._manipulation = Manipulation(robot.leg_names, state, config, dt)
        self._footholds = Footholds(model.leg_count, state)
        self._footing = Footing(robot.leg_names, state, config.footing, dt)
        self._stability = StabilityWatch(config.stability, dt)
        self._posture = "sitting"
        self._folding: Folding | None = None
        self._change: PostureChange | None = None
        self._carries = False  # the feet carry the whole weight while they glide
        self._packed = robot.packed_joints
        self._marched = 0.0  # strides stepped in place since the last order to stand or sit
        self._foot_glide: Glide | None = None
        self._choose_gait(robot.gaits[0])
        self._phase[:] = state.cut("orders", "offset")
        self.reset(np.zeros(self._angles.size))

    @property
    def leg_reach(self) -> LegReach:
        """Where the legs may put their feet; its arrays are the walker's own."""
        model = self._state.record["model"]
        return LegReach(
            stance_in_body=self._stances,
            radius=self._state.cut("model", "radius"),
            moved=self._state.cut("space", "moved"),
            lowest=float(model["down_limit"]),
            highest=float(model["up_limit"]),
        )

    def reset(self, joint_position: Array) -> None:
        """Begin from where the joints are: hold them, sitting, until told to stand. Bad readings change nothing."""
        kept = self._angles.ravel()
        read = np.asarray(joint_position, dtype=np.float64).ravel()
        angles = np.where(np.isfinite(read), read, kept) if read.size == kept.size else kept
        angles = angles.reshape(self._angles.shape)
        lower, upper = self._robot.joint_limits.T  # in whichever posture the legs are
        np.clip(angles, lower, upper, out=self._angles)
        self._target[:] = self._angles.ravel()
        self._posture, self._unhindered = "sitting", False
        self._folding = self._foot_glide = None
        self._end_change()
        self._poser.clear()
        self._manipulation.clear()
        self._footholds.clear()
        self._in_air[:], self._walked[:] = False, 0.0

    def begin_standing(self) -> Array:
        """Be standing at once, feet on their stance; returns the joint angles (joints,) that this means."""
        stance = self._robot.stance_in_body
        self._angles[:] = self._robot.standing_search
        hold_tick(self._memory)
        solve_feet(self._memory, stance)
        believe(self._memory)
        stand(self._memory, stance, 1.0)
        self._posture, self._unhindered = "standing", False
        return self._angles.flatten()

    def carrying_torque(self) -> Array:
        """Joint torques (joints,) N m with which the legs, as last measured, carry just what they are expected to."""
        senses, joints = self._state.record["senses"], self._model.joints_per_leg
        lever = np.einsum("lkj,k->lj", senses["jacobian"], senses["up"])[: self._load.size]
        torque: Array = senses["own_torque"][: self._load.size] - lever * self._load[:, None]
        return torque[:, :joints].ravel()

    @property
    def change_refusal(self) -> str:
        """Why the robot can not begin to change its posture now; empty when it can."""
        if self._posture != "standing":
            return "the posture is changed only while the robot stands still"
        if not (self._poser.idle and self._manipulation.idle):
            return "the posture is changed only while the body is not posed and no leg is lifted"
        slope = float(np.hypot(*self._state.cut("body", "plane")[:2]))
        residual = float(self._state.record["answer"]["residual"])
        if slope > LEVEL or residual > LEVEL * self._model.reach:
            return f"the ground is not level enough: slope {slope:.2f}, {100 * residual:.1f} cm rough"
        return ""

    def begin_change(self, there: LegModel, plan: PosturePlan) -> None:
        """Leave this posture for that of `there`; joints may turn as far as they can until the change is over."""
        self._state.cut("model", "limits")[:] = self._robot.joint_limits
        self._change = PostureChange(self._state, self._model, there, plan, self._config, self._dt)
        self._posture, self._unhindered = self._change.posture, False

    @property
    def changed(self) -> bool:
        """Whether a change of posture has come to its end, so that the other posture's walker takes over."""
        return self._change is not None and self._change.done

    def take_over(self, before: Walker) -> None:
        """Go on for the walker that has changed into this posture: rise to its own height on the feet as they stand."""
        self.reset(before._angles.ravel())
        believe(self._memory)
        self._target[:] = before._target
        feet = self._measured_feet.copy()
        stand(self._memory, feet, 1.0)
        goal = feet.copy()
        goal[:, 2] += float(self._robot.stance_in_body[0, 2] - feet[:, 2].mean())
        self._feet[:] = feet
        self._foot_glide, self._carries = Glide(feet, goal, self._config.rise_speed), True
        self._posture = "rising"
        before.reset(before._angles.ravel())

    def _end_change(self) -> None:
        self._change, self._carries = None, False
        self._state.cut("model", "limits")[:] = self._model.limits

    def step(self, sensed: WalkInput) -> WalkOutput:
        """One control tick. Readings and orders that are not finite are replaced and named in `reasons`."""
        reasons = self._take(sensed)
        if sensed.footholds or not self._footholds.idle:
            self._footholds.step(sensed.footholds, self._poser.pose)
        upright = self._posture in UPRIGHT
        if self._unhindered and sensed.stand and not sensed.legs:
            done = self._whole_tick(self._posing_of(sensed))
            if done != UNSTABLE:
                self._posture, self._marched = UPRIGHT[done], 0.0
                return self._answer(
                    reasons + self._poser.reasons, self._footing.step() if self._feels_ground else ()
                )  # fmt: skip
        else:
            sense_tick(self._memory, upright or self._change is not None)
        reasons += self._judge_stability(upright)
        if not sensed.stand:
            self._velocity[:] = 0.0
        self._act(sensed)
        events: tuple[str, ...] = ()
        if upright and self._feels_ground:
            events = self._footing.step()
        else:
            self._footing.clear()
        answer_tick(self._memory)
        self._unhindered = self._manipulation.idle and self._stability.idle and self._posture in UPRIGHT
        reasons += self._poser.reasons + self._manipulation.reasons
        return self._answer(reasons + (self._change.reasons if self._change is not None else ()), events)

    def _whole_tick(self, posing: PosingOrder) -> int:
        """All of an unhindered robot's tick at once, if it is stable."""
        poser = self._poser
        if poser.idle and (posing is NO_POSING or posing.idle):
            return usual_tick(self._memory, *self._calm_margins)
        poser.plan(posing, self._gait, walking=self._posture == "walking")
        done = posed_tick(self._memory, *self._calm_margins, poser.slews)
        if done != UNSTABLE:
            poser.rest()
        return done

    def _take(self, sensed: WalkInput) -> tuple[str, ...]:
        """Write a tick's readings and orders into the memory; what has the wrong size or kind counts as missing."""
        parameters, ordered = sensed.parameters, self._parameters
        try:
            self._position[...] = sensed.joint_position
            self._torque[...] = sensed.joint_torque
            self._gravity[...] = sensed.gravity_in_body
            self._contact[...] = sensed.foot_contact
            self._velocity[...] = sensed.velocity
            ordered[0] = parameters.stride_frequency
            ordered[1] = parameters.stride_height
            ordered[2] = parameters.virtual_stiffness
        except (ValueError, TypeError):
            self._miss_all()
        return () if sensed.gait == self._gait_name else self._choose_gait(sensed.gait)

    def _miss_all(self) -> None:
        for array in (self._position, self._torque, self._gravity, self._velocity, self._parameters):
            array[:] = np.nan
        self._contact[:] = 0

    def _choose_gait(self, name: str) -> tuple[str, ...]:
        """An unknown gait leaves the one in use."""
        gait = self._robot.gait_table.get(name)
        if gait is None:
            return (f"gait {name!r} is unknown",)
        stability = self._config.stability
        self._gait, self._gait_name, self._gait_is_static = gait, name, is_static(gait)
        self._state.record["posing"]["always"] = self._leans = self._poser.leans(gait)
        self._calm_margins = (stability.warn_static, stability.warn_energy) if self._gait_is_static else NO_MARGINS
        self._state.record["orders"]["duty"] = gait.duty
        self._state.cut("orders", "offset")[:] = gait.offsets
        return ()

    def _judge_stability(self, upright: bool) -> tuple[str, ...]:
        """Slow down, by the margins of the feet that carry, while the robot is on its legs in a static gait."""
        watch = self._stability
        if not (upright and self._gait_is_static):
            watch.clear()
            return ()
        margins = self._state.record["answer"]
        resting = self._posture == "standing" and not self._in_air.any()
        watch.update(float(margins["static_margin"]), float(margins["energy_margin"]), resting=resting)
        if watch.calm:
            return ()
        self._velocity *= watch.factor
        return watch.reasons

    def _act(self, sensed: WalkInput) -> None:
        """Set this tick's servo targets according to the posture."""
        if self._change is not None:
            self._change.step(sensed.stand)
            self._posture = self._change.posture
        elif self._posture == "sitting":
            self._load[:] = 0.0
            joint_tick(self._memory, self._angles.copy(), False)
            if sensed.stand:
                self._begin_rising(sensed.in_sequence)
        elif self._posture in ("rising", "lowering"):
            self._glide(sensed)
        else:
            marching = sensed.in_sequence and not sensed.stand and self._manipulation.idle and self._must_march()
            if marching:
                self._velocity[:] = (MARCH, 0.0, 0.0)
                self._marched += self._dt * float(self._state.record["gait"]["frequency"])
            self._hold_legs(sensed)
            self._walk(self._posing_of(sensed))
            if not self._manipulation.idle:
                self._manipulation.turn_joints(self._angles, self._target.reshape(self._angles.shape))
            if sensed.stand:
                self._marched = 0.0
            elif self._posture == "standing" and self._poser.idle and self._manipulation.idle and not marching:
                self._begin_lowering()

    def _hold_legs(self, sensed: WalkInput) -> None:
        """Legs are held while the robot stands safely; until all are down again it does not walk."""
        manipulation, standing = self._manipulation, self._posture == "standing"
        if manipulation.idle and not (sensed.legs and standing and not self._velocity.any()):
            return
        orders = sensed.legs if sensed.stand and self._stability.factor > 0.0 else ()
        manipulation.step(orders, self._poser.pose)
        self._velocity[:] = 0.0

    def _must_march(self) -> bool:
        """Whether a foot stands too far from where it belongs to be lowered upon."""
        away = np.hypot(*(self._places - self._stances)[:, :2].T)
        return bool(away.max() > self._config.march_reach) and self._marched < LONGEST_MARCH

    def _posing_of(self, sensed: WalkInput) -> PosingOrder:
        """What is ordered of a robot that stands, and what the gait can not be walked without."""
        ordered = sensed.posing if sensed.stand else NO_POSING
        leans = self._leans and (self._posture == "walking" or bool(self._velocity.any()))
        return replace(ordered, automatic=True) if leans and not ordered.automatic else ordered

    def _walk(self, posing: PosingOrder) -> None:
        if self._poser.idle and posing.idle:
            walking = walk_tick(self._memory)
        else:
            self._poser.plan(posing, self._gait, walking=self._posture == "walking")
            walking = posed_walk_tick(self._memory, self._poser.slews)
            self._poser.rest()
        self._posture = "walking" if walking else "standing"

    def _begin_rising(self, in_sequence: bool) -> None:
        """First bring the feet under their stance, over the air where the legs are folded away, then push up."""
        stance = self._robot.stance_in_body
        feet = self._robot.sitting_in_body.copy()
        feet[:, 2] = float(np.clip(np.median(self._measured_feet[:, 2]), stance[0, 2], self._sitting_height))
        start = self._angles.copy()
        postures = [self._angles_at(feet)]
        if self._measured_feet[:, 2].min() > self._sitting_height + 0.5 * self._config.folding_lift:
            postures.insert(0, self._angles_at(self._lifted_feet()))
        self._folding = Folding(start, postures, self._config.soft_start_speed, in_groups=in_sequence)
        self._angles[:] = start
        self._foot_glide = Glide(feet, stance, self._config.rise_speed)
        stand(self._memory, feet, 0.0)
        self._posture = "rising"

    def _angles_at(self, feet: Array) -> Array:
        """Joint angles (legs, n) for feet (legs, 3) in body."""
        solve_feet(self._memory, feet)
        return self._angles.copy()

    def _lifted_feet(self) -> Array:
        feet = self._robot.sitting_in_body.copy()
        feet[:, 2] = self._sitting_height + self._config.folding_lift
        return feet

    def _begin_lowering(self) -> None:
        self._folding = None
        goal = self._feet + self._robot.sitting_in_body - self._robot.stance_in_body
        goal[:, 2] = self._sitting_height
        self._foot_glide = Glide(self._feet, goal, self._config.rise_speed)
        self._posture = "lowering"

    def _begin_packing(self, packed: Array, in_sequence: bool) -> None:
        start = self._angles.copy()
        postures = [self._angles_at(self._lifted_feet()), packed]
        self._folding = Folding(start, postures, self._config.soft_start_speed, in_groups=in_sequence)
        self._angles[:] = start
        self._foot_glide = None

    def _glide(self, sensed: WalkInput) -> None:
        if self._folding is not None:
            self._fold()
            return
        if sensed.stand != (self._posture == "rising"):
            self._turn_back(sensed.stand)
        glide = self._foot_glide
        assert glide is not None
        self._feet[:] = glide.step(self._dt)
        up = self._posture == "rising"
        carried = 1.0 if up and self._carries else min((glide.progress if up else 1.0 - glide.progress) / LOADING, 1.0)
        self._load[:] = carried * float(self._state.record["model"]["weight"]) / self._load.size
        foot_tick(self._memory)
        if glide.done:
            self._arrive(sensed)

    def _fold(self) -> None:
        """Move unloaded legs; when they have arrived the feet push up, or the robot sits packed."""
        assert self._folding is not None
        self._load[:] = 0.0
        joint_tick(self._memory, self._folding.step(self._dt), True)
        if self._folding.done:
            self._folding = None
            if self._foot_glide is None:
                self._posture = "sitting"

    def _turn_back(self, wants_to_stand: bool) -> None:
        """Stand asked while sitting down, or the other way round: go back from here."""
        if wants_to_stand:
            self._folding = None
            self._foot_glide = Glide(self._feet, self._robot.stance_in_body, self._config.rise_speed)
            self._posture = "rising"
        else:
            self._begin_lowering()

    def _arrive(self, sensed: WalkInput) -> None:
        if self._posture == "rising":
            stand(self._memory, self._feet.copy(), 1.0)
            self._posture, self._carries = "standing", False
        elif sensed.pack and self._packed is not None:
            self._begin_packing(self._packed, sensed.in_sequence)
        else:
            self._posture = "sitting"

    def _answer(self, reasons: tuple[str, ...], events: tuple[str, ...]) -> WalkOutput:
        return WalkOutput(
            self._told.tobytes(),
            self._model.leg_count,
            self._target.size,
            self._posture,
            self._stability.level,
            self._manipulation.stages,
            events,
            reasons,
        )
