"""The command desk: answers every command with what is applied or why not, and keeps what the operator wants.

Commands arrive from the bus on other threads; the walk loop reads `orders()` once a tick. Times here are wall-clock
nanoseconds, because they concern people and networks.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import isfinite

import numpy as np

from robot_agent.adaptation import ParameterOverrides
from robot_agent.area_keeper import AreaKeeper
from robot_agent.authority import Authority
from robot_agent.cruise import Cruise
from robot_agent.foothold_desk import FootholdDesk
from robot_agent.forbidden_areas import areas_of
from robot_agent.ground_memory import GroundMemory
from robot_agent.leg_desk import LegDesk
from robot_agent.locomotion.leg_reach import LegReach
from robot_agent.mission import Mission
from robot_agent.motion_desk import MotionDesk
from robot_agent.navigation.keep_out import Area, hit
from robot_agent.orders import Orders
from robot_agent.way_survey import NOTHING_ASKED, Survey, WaySurvey
from weaver_shared.config.command import CommandLimits
from weaver_shared.config.perception import PLANE_MODES, PerceptionConfig
from weaver_shared.errors import InputError, WeaverError
from weaver_shared.messages import (
    Answer,
    Command,
    CommandName,
    Event,
    ForbiddenAreas,
    LeaseState,
    MissionState,
    MotionOrders,
    PerceptionOrder,
    Severity,
    TeleopFrame,
    Waypoint,
)
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class Situation:
    """What the desk must know of the robot to judge a command."""

    stamp_ns: int  # robot clock
    robot_xy: tuple[float, float]
    mode: str
    settled: bool  # seated or without torque
    stand_blockers: tuple[str, ...]  # what keeps the robot from standing up
    lift_margins: tuple[float, ...] = ()  # m of stability without each leg, while the robot stands still
    change_refusal: str = "starting"  # why the posture of the legs can not be changed now
    leg_reach: LegReach | None = None
    world_from_body: Pose | None = None  # as estimated


class CommandDesk:
    def __init__(
        self,
        *,
        robot: RobotDescription,
        overrides: ParameterOverrides,
        wall_clock_ns: Callable[[], int],
        limits: CommandLimits | None = None,
    ) -> None:
        self._robot = robot
        self._overrides = overrides
        self._now_ns = wall_clock_ns
        self._limits = limits or CommandLimits()
        self._lock = threading.RLock()
        self._authority = Authority()
        self._mission = Mission(self._limits)
        self.ground = GroundMemory()  # to be filled with the map's tiles
        self._surveyor = WaySurvey(robot, self.ground)
        self._areas: tuple[Area, ...] = ()
        self._keeper = AreaKeeper(robot)
        self._survey = NOTHING_ASKED  # of the command being answered
        self._motion = MotionDesk(robot)
        self._cruise = Cruise(self._limits)
        self._legs = LegDesk(robot, robot.locomotion)
        self._footholds = FootholdDesk(robot)
        self._situation = Situation(
            stamp_ns=0, robot_xy=(0.0, 0.0), mode="OFF", settled=True, stand_blockers=("starting",)
        )
        self._events: deque[Event] = deque(maxlen=1000)
        self._stop_level = ""
        self._stand = False
        self._gait: str = robot.gaits[0]
        self._perception: str = PerceptionConfig().mode
        self._teleop: TeleopFrame | None = None
        self._teleop_heard_ns = 0
        self._teleop_sequence = -1
        self._handlers: dict[CommandName, Callable[[Command], Answer]] = {
            CommandName.RELEASE_CONTROL: self._release_control,
            CommandName.RETAIN_CONTROL: lambda _: self._accept(),
            CommandName.STAND: self._stand_up,
            CommandName.SIT: self._sit_down,
            CommandName.RELEASE_STOP: self._release_stop,
            CommandName.SET_MISSION: self._set_mission,
            CommandName.START_MISSION: self._start_mission,
            CommandName.PAUSE_MISSION: self._pause_mission,
            CommandName.CLEAR_MISSION: self._clear_mission,
            CommandName.SET_AREAS: self._set_areas,
            CommandName.SKIP_WAYPOINT: self._skip_waypoint,
            CommandName.RETURN_TO_START: self._return_to_start,
            CommandName.SET_OVERRIDE: self._set_override,
            CommandName.CLEAR_OVERRIDE: self._clear_override,
            CommandName.SET_PRESET: self._set_preset,
            CommandName.SET_PERCEPTION: self._set_perception,
            CommandName.SET_GAIT: self._set_gait,
            CommandName.START_CRUISE: self._moving(self._start_cruise),
            CommandName.STOP_CRUISE: self._stop_cruise,
            CommandName.SET_START_UP: self._moving(self._motion.set_start_up),
            CommandName.CHANGE_POSTURE: self._moving(self._change_posture),
            CommandName.SET_POSE: self._moving(self._motion.set_pose),
            CommandName.CLEAR_POSE: self._moving(self._motion.clear_pose),
            CommandName.LIFT_LEG: self._moving(self._legs.lift),
            CommandName.LOWER_LEG: self._moving(self._legs.lower),
            CommandName.MOVE_TIP: self._moving(self._legs.move_tip),
            CommandName.MOVE_JOINT: self._moving(self._legs.move_joint),
            CommandName.PLACE_FOOT: self._moving(self._place_foot),
            CommandName.SET_POSING: self._moving(self._motion.set_posing),
            CommandName.LOOK_CLOSELY: self._not_here,
            CommandName.START_RECORDING: self._not_here,
            CommandName.STOP_RECORDING: self._not_here,
            CommandName.START_REPLAY: self._not_here,
            CommandName.PLAY_REPLAY: self._not_here,
            CommandName.JUMP_REPLAY: self._not_here,
            CommandName.END_REPLAY: self._not_here,
            CommandName.START_CALIBRATION: self._not_here,
            CommandName.SOLVE_CALIBRATION: self._not_here,
            CommandName.END_CALIBRATION: self._not_here,
        }

    def answer(self, command: Command) -> Answer:
        """Carry out or refuse one command; never raises."""
        survey = self._look_at_the_way(command)
        with self._lock:
            self._survey = survey
            now = self._now_ns()
            if command.command is CommandName.STOP:
                reply = self._stop(command.name)
            elif command.command is CommandName.TAKE_CONTROL:
                reply = self._take_control(command, now)
            elif refusal := self._authority.refusal(command, now):
                reply = Answer(accepted=False, reason=refusal, lease_epoch=self._authority.epoch)
            else:
                reply = self._handlers[command.command](command)
            if command.command is not CommandName.RETAIN_CONTROL:
                self._log(command, reply)
            return reply

    def teleoperate(self, frame: TeleopFrame) -> None:
        """Take a stick position of the holder; anything stale, foreign or not finite is ignored."""
        values = (frame.forward, frame.left, frame.turn)
        with self._lock:
            fresh = frame.sequence > self._teleop_sequence or frame.lease_epoch != self._authority.epoch
            theirs = frame.operator == self._authority.holder and frame.lease_epoch == self._authority.epoch
            if theirs and fresh and all(isfinite(value) for value in values):
                self._teleop = frame
                if frame.dead_man:
                    self._cruise.stop()  # a hand on the stick takes over
                self._teleop_sequence = frame.sequence
                self._teleop_heard_ns = self._now_ns()

    def stand_unattended(self) -> None:
        """Stand up without an operator: for a simulated robot that is to be found standing."""
        with self._lock:
            self._stand = True

    def observe(self, situation: Situation) -> None:
        with self._lock:
            self._situation = situation
            self._legs.lift_margins = situation.lift_margins
            self._footholds.reach = situation.leg_reach
            self._footholds.world_from_body = situation.world_from_body

    def orders(self) -> Orders:
        with self._lock:
            now = self._now_ns()
            silence = self._authority.silence(now)
            if not isfinite(silence):
                self._mission.pause()
                self._cruise.stop()
            steered = self._steered(now)
            return Orders(
                stop_level=self._stop_level,
                stand=self._stand,
                operator_silence=silence,
                attended=self._authority.epoch > 0,
                gait=self._gait,
                mission_active=self._mission.phase == "active",
                waypoints=self._mission.walked,
                mission_serial=self._mission.serial,
                teleop_velocity=steered,
                posing=self._motion.posing,
                legs=self._legs.orders,
                footholds=self._footholds.orders(self._situation.stamp_ns),
                in_sequence=self._motion.in_sequence,
                pack=self._motion.pack,
                posture=self._motion.posture,
                areas=self._areas,
                find_way=self._mission.find_way,
            )

    def _steered(self, now_ns: int) -> np.ndarray | None:
        """What stick or cruise ask for, (3,), as far as no forbidden area lies in the way."""
        by_hand = self._teleop_velocity(now_ns)
        asked = by_hand if by_hand is not None else self._cruise.velocity(self._situation.stamp_ns)
        kept = self._keeper.keep_out(self._areas, asked, self._situation.robot_xy, self._situation.world_from_body)
        if kept.news:
            self.note(Severity.WARNING, kept.news)
        if kept.halted and by_hand is None:
            self._cruise.stop()
            return None
        return kept.velocity

    def mission_progress(
        self,
        *,
        serial: int,
        index: int,
        cross_track_error: float,
        distance_left: float,
        lookahead: np.ndarray,
        done: bool,
    ) -> None:
        """Take how far the follower is on the mission of this serial number; it may have been replaced meanwhile."""
        with self._lock:
            if self._mission.phase != "active" or serial != self._mission.serial:
                return
            self._mission.progress(
                index=index, cross_track_error=cross_track_error, distance_left=distance_left, lookahead=lookahead
            )
            if done:
                self._mission.finish()
                self.note(Severity.INFO, "the mission is done")

    def give_up_mission(self, reason: str) -> None:
        """Pause a mission that can not go on, and say why."""
        with self._lock:
            if self._mission.phase == "active":
                self._mission.pause()
                self.note(Severity.ERROR, f"the mission is paused: {reason}")

    def note(self, severity: Severity, text: str, source: str = "robot") -> None:
        with self._lock:
            self._events.append(Event(stamp_ns=self._situation.stamp_ns, severity=severity, source=source, text=text))

    def take_events(self) -> list[Event]:
        with self._lock:
            events = list(self._events)
            self._events.clear()
            return events

    def withdraw_stand(self) -> None:
        """Safety makes the robot sit: standing up again needs a new command."""
        with self._lock:
            self._stand = False
            self._cruise.stop()
            self._legs.clear()
            self._footholds.clear()
            self._mission.pause()

    def stop_by_itself(self) -> None:
        """Latch the stop that cuts: the body has no torque any more, and is not to have it again unasked."""
        with self._lock:
            if self._stop_level != "cut":
                self._stop("cut")

    def lease(self) -> LeaseState:
        with self._lock:
            left = self._authority.seconds_left(self._now_ns())
            return LeaseState(holder=self._authority.holder, epoch=self._authority.epoch, seconds_left=left)

    def mission(self, stamp_ns: int) -> MissionState:
        with self._lock:
            return self._mission.state(stamp_ns)

    def areas(self, stamp_ns: int) -> ForbiddenAreas:
        with self._lock:
            return ForbiddenAreas(stamp_ns=stamp_ns, areas=self._areas)

    def perception(self, stamp_ns: int) -> PerceptionOrder:
        with self._lock:
            return PerceptionOrder(stamp_ns=stamp_ns, mode=self._perception)

    def home(self) -> Waypoint:
        """Where the mission began, to which it returns."""
        with self._lock:
            return self._mission.home

    def motion(self) -> MotionOrders:
        """What is asked of body and legs beyond walking."""
        with self._lock:
            now, posing, legs = self._situation.stamp_ns, self._motion.posing, self._legs.orders
            velocity = self._cruise.velocity(now)
            return MotionOrders(
                stamp_ns=now,
                pose=np.array(posing.manual),
                automatic_posing=posing.automatic,
                levelling=posing.levelling,
                in_sequence=self._motion.in_sequence,
                cruise_velocity=velocity if velocity is not None else np.zeros(3),
                cruise_seconds_left=self._cruise.seconds_left(now),
                held_legs=tuple(self._robot.leg_names[order.leg] for order in legs),
                held_tips=np.array([order.tip for order in legs]).reshape(-1, 3),
            )

    def allowed(self) -> tuple[str, ...]:
        """Commands that would be accepted from the holder now."""
        with self._lock:
            mode = self._situation.mode
            names = {CommandName.STOP, CommandName.TAKE_CONTROL, CommandName.RELEASE_CONTROL, CommandName.SET_GAIT}
            names |= {
                CommandName.SET_MISSION,
                CommandName.SET_AREAS,
                CommandName.SET_OVERRIDE,
                CommandName.CLEAR_OVERRIDE,
                CommandName.SET_PRESET,
            }
            if self._robot.has_camera:
                names.add(CommandName.SET_PERCEPTION)
            names |= {CommandName.SET_START_UP, CommandName.SET_POSE, CommandName.CLEAR_POSE, CommandName.SET_POSING}
            if self._stop_level:
                if self._situation.settled:
                    names.add(CommandName.RELEASE_STOP)
            elif mode in ("OFF", "READY", "SIT") and not self._situation.stand_blockers:
                names.add(CommandName.STAND)
            if mode in ("STAND", "WALK", "HOLD", "FAULT"):  # which ends only when the order to stand is withdrawn
                names.add(CommandName.SIT)
            if self._situation.lift_margins:
                names.add(CommandName.LIFT_LEG)
            if self._robot.posture is not None and mode == "STAND" and not self._situation.change_refusal:
                names.add(CommandName.CHANGE_POSTURE)
            if self._legs.orders:
                names |= {CommandName.LOWER_LEG, CommandName.MOVE_TIP, CommandName.MOVE_JOINT}
            if mode in ("STAND", "WALK"):
                names.add(CommandName.PLACE_FOOT)
            if self._mission.phase != "active" and mode in ("STAND", "WALK"):
                names |= {CommandName.START_CRUISE, CommandName.STOP_CRUISE}
            return tuple(sorted(names | self._allowed_of_mission(mode)))

    def _allowed_of_mission(self, mode: str) -> set[CommandName]:
        phase, names = self._mission.phase, set[CommandName]()
        if mode in ("STAND", "WALK"):
            names.add(CommandName.RETURN_TO_START)
            if phase in ("ready", "paused"):
                names.add(CommandName.START_MISSION)
        if phase == "active":
            names.add(CommandName.PAUSE_MISSION)
        if phase in ("active", "paused"):
            names.add(CommandName.SKIP_WAYPOINT)
        if phase != "empty":
            names.add(CommandName.CLEAR_MISSION)
        return names

    def _take_control(self, command: Command, now_ns: int) -> Answer:
        if not command.operator.strip():
            return self._refuse("an operator needs a name")
        return self._authority.take(command, now_ns)

    def _release_control(self, _: Command) -> Answer:
        self._authority.release()
        self._teleop = None
        self._footholds.clear()
        self._cruise.stop()
        self._mission.pause()
        return self._accept()

    def _stop(self, level: str) -> Answer:
        cut = level == "cut" or self._stop_level == "cut"
        self._stop_level = "cut" if cut else "settle"
        self._stand = False
        self._teleop = None
        self._cruise.stop()
        self._legs.clear()
        self._footholds.clear()
        self._mission.pause()
        return self._accept()

    def _release_stop(self, _: Command) -> Answer:
        if not self._stop_level:
            return self._refuse("the robot is not stopped")
        if not self._situation.settled:
            return self._refuse("the robot is still settling; release the stop when it sits")
        self._stop_level = ""
        return self._accept()

    def _stand_up(self, _: Command) -> Answer:
        if self._stop_level:
            return self._refuse("the robot is stopped; release the stop first")
        if self._situation.stand_blockers:
            return self._refuse("; ".join(self._situation.stand_blockers))
        self._stand = True
        return self._accept()

    def _sit_down(self, command: Command) -> Answer:
        try:
            self._motion.choose_sitting(command)
        except WeaverError as error:
            return self._refuse(str(error))
        self._mission.pause()
        self._cruise.stop()
        self._legs.clear()
        self._footholds.clear()
        self._stand = False
        return self._accept()

    def _set_mission(self, command: Command) -> Answer:
        refusal = self._survey.refusal or self._mission.replace(
            command.waypoints, self._situation.robot_xy, command.name
        )
        return self._refuse(refusal) if refusal else self._accept(float(len(command.waypoints)))

    def _start_mission(self, _: Command) -> Answer:
        refusal = (
            self._walk_refusal()
            or self._survey.refusal
            or self._forbidden_goal()
            or self._mission.start(self._situation.robot_xy)
        )
        if refusal:
            return self._refuse(refusal)
        self._cruise.stop()
        return replace(self._accept(), reason=self._survey.remark)

    def _skip_waypoint(self, _: Command) -> Answer:
        """The applied value is the number of the waypoint gone to next, 0 when there was no other."""
        refusal = self._survey.refusal or self._mission.skip()
        if refusal:
            return self._refuse(refusal)
        if self._mission.phase == "done":
            self.note(Severity.INFO, "the mission is done: its last waypoint was skipped")
        total, left = len(self._mission.waypoints), len(self._mission.ahead)
        return self._accept(float(total - left + 1) if left else 0.0)

    def _return_to_start(self, _: Command) -> Answer:
        """The applied value is the number of waypoints on the way back."""
        refusal = self._walk_refusal() or self._survey.refusal or self._mission.turn_back(self._situation.robot_xy)
        if refusal:
            return self._refuse(refusal)
        self._cruise.stop()
        return replace(self._accept(float(len(self._mission.waypoints))), reason=self._survey.remark)

    def _set_areas(self, command: Command) -> Answer:
        """A mission under way that would come into one of them is paused; the applied value is their number."""
        try:
            self._areas = areas_of(command)
        except InputError as error:
            return self._refuse(str(error))
        refusal = self._survey.refusal or self._forbidden_goal()
        if self._mission.phase == "active" and refusal:
            self.give_up_mission(refusal)
            reason = f"the mission is paused: {refusal}"
            return replace(self._accept(float(len(self._areas))), reason=reason)
        return self._accept(float(len(self._areas)))

    def _forbidden_goal(self) -> str:
        """Why a mission that finds its own ways can not come to a goal of its; their ways themselves lead around."""
        if not self._mission.find_way:
            return ""
        total, ahead = len(self._mission.waypoints), self._mission.ahead
        for number, goal in enumerate(ahead, start=total - len(ahead) + 1):
            place = (goal.x, goal.y)
            if (area := hit(self._areas, place, place, self._robot.half_width)) is not None:
                return f"waypoint {number} is in forbidden area {area}, or too near for the feet"
        return ""

    def _look_at_the_way(self, command: Command) -> Survey:
        """Before the desk is locked: the walk loop does not wait for a long way to be looked at."""
        with self._lock:
            way, begin = self._mission.straight_way(command), self._situation.robot_xy
            total = max(len(way), len(self._mission.waypoints))
            if command.command is CommandName.SET_MISSION:
                total = len(command.waypoints)
            areas = self._areas
            known = len(way) <= self._limits.waypoint_count and self._situation.mode in ("STAND", "WALK", "HOLD")
        places = all(isfinite(place.x) and isfinite(place.y) for place in way)
        if not (way and known and places):
            return NOTHING_ASKED
        if command.command is CommandName.RETURN_TO_START:
            total = len(way)
        elif command.command is CommandName.SET_AREAS:
            try:
                areas = areas_of(command)
            except InputError:
                return NOTHING_ASKED
        return self._surveyor.survey(begin, way, total - len(way) + 1, areas)

    def _walk_refusal(self) -> str:
        """Why no mission can be walked now, whatever its waypoints."""
        if self._stop_level:
            return "the robot is stopped; release the stop first"
        if self._situation.mode not in ("STAND", "WALK", "HOLD"):
            return f"the robot must stand before it walks; it is in {self._situation.mode}"
        return "legs are lifted; lower them before walking" if self._legs.orders else ""

    def _pause_mission(self, _: Command) -> Answer:
        self._mission.pause()
        return self._accept()

    def _clear_mission(self, _: Command) -> Answer:
        self._mission.replace((), self._situation.robot_xy)
        return self._accept()

    def _set_override(self, command: Command) -> Answer:
        seconds = command.seconds or self._limits.override_seconds
        if not (isfinite(seconds) and 0.0 < seconds <= self._limits.override_seconds):
            return self._refuse(f"an override lasts above 0 and up to {self._limits.override_seconds:.0f} s")
        try:
            self._overrides.set(command.name, command.value, self._situation.stamp_ns + round(seconds * 1e9))
        except WeaverError as error:
            return self._refuse(str(error))
        return self._accept(command.value)

    def _clear_override(self, command: Command) -> Answer:
        try:
            self._overrides.clear(command.name)
        except WeaverError as error:
            return self._refuse(str(error))
        return self._accept()

    def _set_preset(self, command: Command) -> Answer:
        try:
            self._overrides.choose(command.name)
        except WeaverError as error:
            return self._refuse(str(error))
        return self._accept()

    def _set_perception(self, command: Command) -> Answer:
        """At any time: the ground is judged anew from the next picture on, and the gait follows at its own rates."""
        if not self._robot.has_camera:
            return self._refuse("this robot has no cameras; its feet alone judge the ground")
        if command.name not in PLANE_MODES:
            known = ", ".join(PLANE_MODES)
            return self._refuse(f"perception mode {command.name!r:.40} is unknown; known are {known}")
        self._perception = command.name
        return self._accept()

    def _set_gait(self, command: Command) -> Answer:
        if command.name not in self._robot.gaits:
            return self._refuse(f"gait {command.name!r:.40} is unknown; known are {', '.join(self._robot.gaits)}")
        self._gait = command.name
        return self._accept()

    def _moving(self, apply: Callable[[Command], float]) -> Callable[[Command], Answer]:
        """A motion desk's method as a handler."""

        def handle(command: Command) -> Answer:
            try:
                return self._accept(apply(command))
            except WeaverError as error:
                return self._refuse(str(error))

        return handle

    def _start_cruise(self, command: Command) -> float:
        if self._situation.mode not in ("STAND", "WALK"):
            raise InputError(f"the robot must stand before it walks; it is in {self._situation.mode}")
        if self._mission.phase == "active":
            raise InputError("a mission is being walked; pause it first")
        if self._legs.orders:
            raise InputError("legs are lifted; lower them before walking")
        applied = self._cruise.start(command, self._teleop_velocity(self._now_ns()), self._situation.stamp_ns)
        if refusal := self._keeper.refusal(
            self._areas,
            self._cruise.velocity(self._situation.stamp_ns),
            self._situation.robot_xy,
            self._situation.world_from_body,
        ):
            self._cruise.stop()
            raise InputError(refusal)
        return applied

    def _change_posture(self, command: Command) -> float:
        if self._situation.mode != "STAND":
            raise InputError(f"the posture is changed only while the robot stands; it is in {self._situation.mode}")
        return self._motion.change_posture(command, self._situation.change_refusal)

    def _place_foot(self, command: Command) -> float:
        if self._situation.mode not in ("STAND", "WALK"):
            raise InputError(f"the robot must stand before a foot is placed; it is in {self._situation.mode}")
        return self._footholds.place(command, self._situation.stamp_ns)

    def _not_here(self, command: Command) -> Answer:
        return self._refuse(f"{command.command.value} is for another process of the robot")

    def _stop_cruise(self, _: Command) -> Answer:
        self._cruise.stop()
        return self._accept()

    def _teleop_velocity(self, now_ns: int) -> np.ndarray | None:
        frame = self._teleop
        if frame is None or now_ns - self._teleop_heard_ns > self._limits.teleop_silence * 1e9 or not frame.dead_man:
            return None
        stick = np.clip([frame.forward, frame.left, frame.turn], -1.0, 1.0)
        return stick * [self._limits.teleop_forward, self._limits.teleop_left, self._limits.teleop_turn]

    def _accept(self, applied: float = 0.0) -> Answer:
        return Answer(accepted=True, reason="", lease_epoch=self._authority.epoch, applied_value=applied)

    def _refuse(self, reason: str) -> Answer:
        return Answer(accepted=False, reason=reason, lease_epoch=self._authority.epoch)

    def _log(self, command: Command, reply: Answer) -> None:
        what = command.command.value.replace("_", " ")
        detail = " ".join(part for part in (command.name, f"{command.value:g}" if command.value else "") if part)
        outcome = f": {'' if reply.accepted else 'refused, '}{reply.reason}" if reply.reason else ""
        severity = Severity.INFO if reply.accepted else Severity.WARNING
        self.note(severity, " ".join(filter(None, (what, detail))) + outcome, source=command.operator)
