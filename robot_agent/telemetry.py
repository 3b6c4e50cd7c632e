"""Turns control ticks into messages at their rates. Nothing here waits for anyone."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from robot_agent.commands import CommandDesk
from robot_agent.modes import way_out
from robot_agent.pipeline import WalkTick
from robot_agent.walking_pace import WalkingPace, expected_speed
from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import (
    GaitState,
    Health,
    Heartbeat,
    LocomotionState,
    LoopTiming,
    MissionOutlook,
    ModeState,
    NavigationGoal,
    OdometryEstimate,
    PowerState,
    Presence,
    Proprioception,
    RobotState,
    ServoStates,
    Severity,
)
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.topics import Topic
from weaver_shared.transforms import rpy_from_rotation

BATTERY_EMPTY, BATTERY_FULL = 21.0, 29.4
"""Volts of a 7-cell pack at 3.0 and 4.2 V a cell."""


class PowerLedger:
    """Energy since start and cost of transport over the last seconds (ICRA'17 eq. 12, whole supply)."""

    def __init__(self, robot: RobotDescription, *, window: float = 5.0) -> None:
        self._weight = robot.mass * GRAVITY
        self._window_ns = round(window * 1e9)
        self._samples: deque[tuple[int, float, float, float]] = deque()  # stamp, energy, x, y
        self._energy = 0.0
        self._last_ns: int | None = None

    def add(self, sensed: Proprioception, position_in_world: np.ndarray) -> None:
        power = sensed.battery_voltage * sensed.supply_current
        if self._last_ns is not None and np.isfinite(power):
            self._energy += power * (sensed.stamp_ns - self._last_ns) * 1e-9
        self._last_ns = sensed.stamp_ns
        self._samples.append((sensed.stamp_ns, self._energy, float(position_in_world[0]), float(position_in_world[1])))
        while self._samples[0][0] < sensed.stamp_ns - self._window_ns:
            self._samples.popleft()

    def state(self, sensed: Proprioception) -> PowerState:
        first, last = self._samples[0], self._samples[-1]
        distance = float(np.hypot(last[2] - first[2], last[3] - first[3]))
        voltage = sensed.battery_voltage
        return PowerState(
            stamp_ns=sensed.stamp_ns,
            battery_voltage=voltage,
            battery_fraction=float(np.clip((voltage - BATTERY_EMPTY) / (BATTERY_FULL - BATTERY_EMPTY), 0.0, 1.0)),
            supply_power=voltage * sensed.supply_current,
            motor_power=sensed.motor_power,
            energy=self._energy,
            cost_of_transport=(last[1] - first[1]) / (self._weight * distance) if distance > 0.02 else float("nan"),
        )


class Telemetry:
    """Publishes one robot's walk loop; rates are the table's in `topics`."""

    def __init__(self, *, bus: Bus, robot_id: str, robot: RobotDescription, presence: Presence, rate: float) -> None:
        self._bus = bus
        self._robot_id = robot_id
        self._robot = robot
        self._presence = presence
        self._rate = rate
        self._count = 0
        self._ledger = PowerLedger(robot)
        self._pace = WalkingPace(robot.locomotion.largest_speed)
        self._mode = ""
        self._perception = ""
        self._goal: NavigationGoal | None = None

    def publish(
        self,
        tick: WalkTick,
        sensed: Proprioception,
        desk: CommandDesk,
        joint_faults: Callable[[], Sequence[str]] = tuple,
    ) -> None:
        """Send what is due in this tick; `joint_faults` is asked when it is."""
        self._measure(tick, sensed)
        self._publish(topics.PROPRIOCEPTION, sensed)
        if self._due(topics.HEARTBEAT):
            beat = Heartbeat(stamp_ns=tick.stamp_ns, sequence=self._count, session=self._presence.session)
            self._publish(topics.HEARTBEAT, beat)
        if self._due(topics.STATE):
            self._publish(topics.STATE, _robot_state(self._robot, tick, sensed))
        if self._due(topics.GAIT):
            self._publish(topics.GAIT, _gait_state(tick, desk.orders().gait))
        if self._due(topics.LOCOMOTION):
            self._publish(topics.LOCOMOTION, _locomotion_state(tick))
        if self._due(topics.ADAPTATION):
            self._publish(topics.ADAPTATION, tick.report)
        if self._due(topics.SERVOS):
            self._publish(
                topics.SERVOS,
                ServoStates(
                    stamp_ns=sensed.stamp_ns, temperature=sensed.joint_temperature, faults=tuple(joint_faults())
                ),
            )
        if self._due(topics.POWER):
            self._publish(topics.POWER, self._ledger.state(sensed))
        if self._due(topics.PRESENCE):
            self._publish(topics.PRESENCE, self._presence)
        if self._due(topics.MODE) or tick.permission.mode != self._mode:
            self._publish(topics.MODE, _mode_state(tick, desk))
            self._note_mode(tick, desk)
        if self._due(topics.LEASE):
            self._publish(topics.LEASE, desk.lease())
        if self._due(topics.MOTION):
            self._publish(topics.MOTION, desk.motion())
        self._publish_mission(tick, desk)
        for event in desk.take_events():
            self._publish(topics.EVENT, event)
        self._count += 1

    def _measure(self, tick: WalkTick, sensed: Proprioception) -> None:
        position = tick.state.world_from_body.position
        self._ledger.add(sensed, position)
        power = sensed.battery_voltage * sensed.supply_current
        place = float(position[0]), float(position[1])
        self._pace.add(tick.stamp_ns, place, power, walking=tick.follower is not None)

    def _publish_mission(self, tick: WalkTick, desk: CommandDesk) -> None:
        if self._due(topics.MISSION):
            self._publish(topics.MISSION, desk.mission(tick.stamp_ns))
        if self._due(topics.AREAS):
            self._publish(topics.AREAS, desk.areas(tick.stamp_ns))
        if self._due(topics.OUTLOOK):
            self._publish(topics.OUTLOOK, self._outlook(tick, desk))
        self._publish_goal(tick)
        perception = desk.perception(tick.stamp_ns)
        if self._due(topics.PERCEPTION) or perception.mode != self._perception:
            self._perception = perception.mode
            self._publish(topics.PERCEPTION, perception)

    def _outlook(self, tick: WalkTick, desk: CommandDesk) -> MissionOutlook:
        pace, home = self._pace, desk.home()
        measured = pace.measured_over > 0.0
        expected = expected_speed(self._robot, desk.orders().gait, tick.report.applied.stride_frequency)
        return MissionOutlook(
            stamp_ns=tick.stamp_ns,
            start_in_world=np.array([home.x, home.y]),
            speed=pace.speed if measured else expected,
            speed_basis="measured" if measured else "gait",
            measured_over=pace.measured_over,
            energy_per_metre=pace.energy_per_metre,
            cost_of_transport=pace.energy_per_metre / (self._robot.mass * GRAVITY),
        )

    def publish_health(
        self, timing: LoopTiming, sensed: Proprioception, odometry: OdometryEstimate | None, odometry_age: float
    ) -> None:
        health = Health(
            stamp_ns=sensed.stamp_ns,
            timings=(timing,),
            odometry_quality=odometry.quality.value if odometry else "none",
            odometry_reason=odometry.reason if odometry else "no picture has been used yet",
            odometry_age=odometry_age,
            tracked_features=odometry.tracked_features if odometry else 0,
            max_temperature=float(np.max(sensed.joint_temperature)),
        )
        self._bus.publish(self._robot_id, topics.HEALTH, health, process="walk")

    def _publish_goal(self, tick: WalkTick) -> None:
        """The goal of a mission that finds its own way, at its rate and when it changes; once more when it ends."""
        goal = tick.route.goal if tick.route is not None else None
        if goal is None and self._goal is not None:
            self._publish(topics.GOAL, replace(self._goal, stamp_ns=tick.stamp_ns, active=False))
        elif goal is not None and (
            self._due(topics.GOAL) or self._goal is None or (goal.serial, goal.place) != (
                self._goal.serial, self._goal.place
            )
        ):  # fmt: skip
            self._publish(topics.GOAL, goal)
        self._goal = goal

    def _note_mode(self, tick: WalkTick, desk: CommandDesk) -> None:
        mode = tick.permission.mode
        if mode == self._mode:
            return
        self._mode = mode
        why = f": {'; '.join(tick.verdict.reasons)}" if tick.verdict.reasons else ""
        severity = Severity.WARNING if mode in ("HOLD", "FAULT", "ESTOP") else Severity.INFO
        desk.note(severity, f"{mode}{why}")

    def _due(self, topic: Topic) -> bool:
        return self._count % max(1, round(self._rate / topic.rate)) == 0

    def _publish(self, topic: Topic, message: object) -> None:
        self._bus.publish(self._robot_id, topic, message)


def _robot_state(robot: RobotDescription, tick: WalkTick, sensed: Proprioception) -> RobotState:
    pose = tick.state.world_from_body
    roll, pitch, _ = rpy_from_rotation(pose.rotation)
    return RobotState(
        stamp_ns=tick.stamp_ns,
        position_in_world=pose.position,
        wxyz=pose.wxyz,
        velocity_command=tick.velocity_command,
        velocity_in_body=pose.rotation.T @ tick.state.velocity_in_world,
        joint_position=sensed.joint_position,
        joint_torque=sensed.joint_torque,
        foot_in_body=feet_in_body(robot, sensed.joint_position),
        foot_contact=sensed.foot_contact,
        foot_force=tick.walk.foot_force,
        stability_margin=float(tick.walk.stability_margin),
        roll=float(roll),
        pitch=float(pitch),
    )


def _gait_state(tick: WalkTick, gait: str) -> GaitState:
    applied = tick.report.applied
    return GaitState(
        stamp_ns=tick.stamp_ns,
        gait=gait,
        phase=tick.walk.phase,
        swing=tick.walk.swing,
        parameters_frequency=applied.stride_frequency,
        parameters_height=applied.stride_height,
        parameters_stiffness=applied.virtual_stiffness,
    )


def _locomotion_state(tick: WalkTick) -> LocomotionState:
    walk = tick.walk
    return LocomotionState(
        stamp_ns=tick.stamp_ns,
        posture=walk.posture,
        stability=walk.stability,
        stability_margin=walk.stability_margin,
        energy_margin=walk.energy_margin,
        ground_plane=walk.ground_plane,
        ground_residual=walk.ground_residual,
        pose_position=walk.unposed_from_body.position,
        pose_rpy=rpy_from_rotation(walk.unposed_from_body.rotation),
        slipping=walk.slipping,
        leg_stages=walk.leg_stages,
        lift_margins=np.array(walk.lift_margins),
        leg_posture=walk.leg_posture,
    )


def _mode_state(tick: WalkTick, desk: CommandDesk) -> ModeState:
    orders = desk.orders()
    waits = _waiting(tick) + way_out(tick.permission, tick.verdict)
    return ModeState(
        stamp_ns=tick.stamp_ns,
        mode=tick.permission.mode,
        action=tick.verdict.action,
        reasons=tick.verdict.reasons + tick.verdict.warnings + tuple(tick.walk.reasons) + waits,
        stopped=bool(orders.stop_level),
        stop_level=orders.stop_level,
        allowed=desk.allowed(),
    )


def _waiting(tick: WalkTick) -> tuple[str, ...]:
    return (tick.route.waiting,) if tick.route is not None and tick.route.waiting else ()
