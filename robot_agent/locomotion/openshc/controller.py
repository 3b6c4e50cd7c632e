"""OpenSHC 0.5.11 as a whole: robot states, and the order of one tick (facts 3.1, 3.2)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.admittance import Admittance
from robot_agent.locomotion.openshc.configuration import Configuration, Gait
from robot_agent.locomotion.openshc.leg import Leg
from robot_agent.locomotion.openshc.manipulation import Manipulation
from robot_agent.locomotion.openshc.posing import Posing
from robot_agent.locomotion.openshc.sequence import StepSequence
from robot_agent.locomotion.openshc.settings import Settings
from robot_agent.locomotion.openshc.start_up import DirectStartUp
from robot_agent.locomotion.openshc.steps import (
    MANUAL,
    PACKED,
    READY,
    RUNNING,
    STOPPED,
    UNKNOWN,
    WALKING,
    WALKING_TO_MANUAL,
)
from robot_agent.locomotion.openshc.transitions import COMPLETE, JointMove
from robot_agent.locomotion.openshc.walk import Walk
from robot_agent.locomotion.openshc.workspace import workspace
from weaver_shared.errors import ConfigurationError

Array = NDArray[np.float64]

PACK_TIME = 2.0
JOINT_TOLERANCE = 0.01


class Controller:
    """A robot that is told things by its attributes and `tick`s."""

    def __init__(self, description: Configuration) -> None:
        self.description = description
        self.settings = Settings(description)
        self.gait_name = description.gait_type
        self.legs = [
            Leg(
                leg,
                description.time_delta,
                clamp_rate=description.clamp_joint_velocities,
                clamp_position=description.clamp_joint_positions,
            )
            for leg in description.legs
        ]
        self.walk = Walk(description, self.gait, self.settings)
        self.posing = Posing(description)
        self.posing.begin_gait(self.gait_name, self.settings.step_frequency)
        self.admittance = Admittance(self.settings, len(self.legs))
        self.manipulation = Manipulation(self.settings, self.legs, self.posing, self.admittance)
        self.robot_state = UNKNOWN
        self.asked_state = UNKNOWN
        self.asked_gait: str | None = None
        self.asked_parameters: dict[str, float] = {}
        self.linear, self.angular = np.zeros(2), 0.0
        self.tip_forces = np.zeros((len(self.legs), 3))
        self.wanted_tips: list[Array | None] = [None] * len(self.legs)
        self._step_planes: list[Array | None] = [None] * len(self.legs)
        self._start_up: DirectStartUp | None = None
        self._packing: list[JointMove] | None = None
        self._pack_step = 0
        self._sequence: StepSequence | None = None

    @property
    def gait(self) -> Gait:
        return self.description.gaits[self.gait_name]

    def command(self, linear: Array, angular: float) -> None:
        scale = self.description.body_velocity_scaler
        self.linear, self.angular = np.asarray(linear, dtype=np.float64) * scale, float(angular) * scale

    def feel(self, forces: Array) -> None:
        """A message with the feet's forces (legs, 3) N; ground under a foot is found where it first carries."""
        self.tip_forces = np.array(forces, dtype=np.float64)
        self.settings.feels_ground = True
        for leg, force in enumerate(np.linalg.norm(self.tip_forces, axis=1)):
            if force > self.description.touchdown_threshold and self._step_planes[leg] is None:
                self._step_planes[leg] = self.legs[leg].tip()
            elif force < self.description.liftoff_threshold:
                self._step_planes[leg] = None

    def tick(self) -> None:
        if self.robot_state != UNKNOWN:
            running = self.robot_state == RUNNING
            self.posing.update(self.walk.state, self.walk.paths, self.gait, running=running)
            if self.description.admittance_control:
                self._give_way()
        if self.asked_state != self.robot_state or self.robot_state == UNKNOWN:
            self._change_robot_state()
        if self.robot_state == RUNNING:
            self._run()

    def _give_way(self) -> None:
        if self.walk.state != STOPPED and self.description.dynamic_stiffness:
            self.admittance.report_stiffness(self.walk.paths)
        forces = np.zeros_like(self.tip_forces) if self.description.use_joint_effort else self.tip_forces
        self.admittance.update(forces, self._tip_directions())

    def _tip_directions(self) -> Array:
        return np.array([leg.tip_frame()[:3, 0] for leg in self.legs])

    def _run(self) -> None:
        """A tick of the running robot; anything but walking waits until it stands."""
        moving = True
        if self.asked_state != self.robot_state:
            self._change_robot_state()  # for the second time in this tick (D8)
            moving = False
        elif self.asked_gait is not None:
            self._change_gait(self.asked_gait)
            moving = False
        elif self.manipulation.toggled is not None:
            if self.walk.state == STOPPED:
                self.manipulation.toggle(self.walk.paths)
            else:
                self._halt()
            moving = False
        self._adjust_parameters()
        if moving or self.walk.state != STOPPED:
            self._walk()

    def _walk(self) -> None:
        states = self.manipulation.states
        if all(state == WALKING for state in states):
            planes = [
                None if plane is None else plane - leg.tip()
                for plane, leg in zip(self._step_planes, self.legs, strict=True)
            ]
            self.walk.tick(
                self.linear,
                self.angular,
                posing_complete=self.posing.complete,
                walk_plane_pose=self.posing.walk_plane,
                step_planes=planes,
                tip_directions=self._tip_directions(),
            )
        self.manipulation.move_tips(self.walk.paths, self.wanted_tips)
        for k, (leg, path) in enumerate(zip(self.legs, self.walk.paths, strict=True)):
            if states[k] in (MANUAL, WALKING_TO_MANUAL):
                self.wanted_tips[k] = path.tip.copy()
                leg.step_to(path.tip)
                continue
            pose = self.posing.of_leg(k)
            tip = pose.into(path.tip)
            self.wanted_tips[k] = tip
            direction = None if path.direction is None else pose.rotation.T @ path.direction
            leg.step_to(tip + self.admittance.offsets[k], direction)

    def _halt(self) -> None:
        self.linear, self.angular = np.zeros(2), 0.0

    def _change_gait(self, name: str) -> None:
        if self.walk.state != STOPPED:
            self._halt()
            return
        self.gait_name = name
        self.walk.begin_gait(self.gait)
        self.posing.begin_gait(name, self.settings.step_frequency)
        self.asked_gait = None

    def _adjust_parameters(self) -> None:
        for name, value in list(self.asked_parameters.items()):
            setattr(self.settings, name, value)
            if name != "step_frequency" or self._fits(value):
                del self.asked_parameters[name]

    def _fits(self, step_frequency: float) -> bool:
        """A new frequency is taken once the robot is slow enough for it, by a signed comparison (D10)."""
        cycle = self.walk.cycle_of(step_frequency)
        limits, velocity = self.walk.limits_of(cycle), self.walk.velocity
        self.walk.allow_speeds(limits)
        linear, angular = velocity.wanted(limits, self.walk.tips, self.linear, self.angular)
        slow = bool(np.all(velocity.linear <= linear)) and abs(velocity.angular) <= abs(angular)
        if slow:
            self.walk.change_cycle(cycle)
        return slow

    def _change_robot_state(self) -> None:
        """One tick of the way to the state asked for, one state after the other."""
        state, asked = self.robot_state, self.asked_state
        if state == UNKNOWN:
            self._recognise()
        elif not self.description.start_up_sequence:
            if state == PACKED and asked > PACKED:
                self._start_directly()
            elif state == READY and asked == RUNNING:
                self.robot_state = RUNNING
            else:
                self.asked_state = state
        elif state == RUNNING:
            self._step_down()
        elif asked > state:
            self._step_up() if state == READY else self._pack(unpack=True)
        else:
            self._pack(unpack=False)

    def _recognise(self) -> None:
        """Joints at rest that stand unpacked are READY; anything else counts as packed."""
        unpacked = [[joint.unpacked for joint in leg.joints] for leg in self.description.legs]
        near = all(
            np.all(np.abs(leg.position - there) < JOINT_TOLERANCE)
            for leg, there in zip(self.legs, unpacked, strict=True)
        )
        ready = near and self.description.start_up_sequence
        self.robot_state = READY if ready else PACKED
        self.asked_state = max(self.asked_state, self.robot_state)

    def _start_directly(self) -> None:
        if self._start_up is None:
            self._start_up = DirectStartUp(self.description, self.legs, self.posing.pose)
        if self._start_up.tick() == COMPLETE:
            self._start_up = None
            self.robot_state = READY
            self._learn_workspaces()

    def _learn_workspaces(self) -> None:
        layered = self.description.rough_terrain_mode
        pose = self.posing.pose
        self.walk.learn([workspace(leg, pose.into(leg.description.place), layered=layered) for leg in self.legs])

    def _pack(self, *, unpack: bool) -> None:
        """Joints through the packing postures, the last of which is the smallest."""
        most = len(self.description.legs[0].joints[0].packed) - 1
        if self._packing is None:
            seconds = PACK_TIME / self.settings.step_frequency
            self._packing = [
                JointMove(leg, self._posture(leg, unpack=unpack), seconds, self.description.time_delta)
                for leg in self.legs
            ]
        if [move.tick() for move in self._packing][-1] != COMPLETE:
            return
        self._packing = None
        if unpack and self._pack_step > 0:
            self._pack_step -= 1
        elif not unpack and self._pack_step < most:
            self._pack_step += 1
        else:
            self.robot_state = READY if unpack else PACKED

    def _posture(self, leg: Leg, *, unpack: bool) -> Array:
        joints, step = leg.description.joints, self._pack_step
        if not unpack:
            return np.array([joint.packed[step] for joint in joints])
        return np.array([joint.packed[step - 1] if step > 0 else joint.unpacked for joint in joints])

    def _step_up(self) -> None:
        if self._sequence is None:
            self._sequence = StepSequence(self.settings, self.legs)
        if self._sequence.tick(up=True, stance=self._stance(), offsets=self.admittance.offsets):
            self.walk = Walk(self.description, self.gait, self.settings)
            self._learn_workspaces()
            self.robot_state = RUNNING

    def _step_down(self) -> None:
        if self.walk.state != STOPPED:
            self._halt()
        elif MANUAL in self.manipulation.states:
            self.manipulation.toggled = self.manipulation.states.index(MANUAL)
        elif self._sequence is None:
            raise ConfigurationError("shutting down needs start_up_sequence")
        elif self._sequence.tick(up=False, stance=self._stance(), offsets=self.admittance.offsets):
            self.robot_state = READY

    def _stance(self) -> list[Array]:
        return [self.posing.pose.into(path.default) for path in self.walk.paths]
