"""A robot at the wire for the console's tests: real messages on a real bus, with just enough behaviour to answer."""

from __future__ import annotations

import threading
import time

import numpy as np

from weaver_shared import topics
from weaver_shared.bus import Bus
from weaver_shared.messages import (
    AdaptationReport,
    Answer,
    Command,
    CommandName,
    Event,
    GaitParameters,
    GaitState,
    Heartbeat,
    LeaseState,
    MapTile,
    MissionState,
    ModeState,
    PowerState,
    Presence,
    RobotState,
    SafetyAction,
    Severity,
    TruthState,
    Waypoint,
)
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.transforms import Pose, rotation_z

STANDING = np.tile([0.0, 0.0, -0.5, 1.3, 0.75], 6)
LEASE_S = 2.0
SPEED = 0.3


def ground_height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Gentle waves with a box 10 cm high at (1.2..1.6, -0.8..-0.4)."""
    waves = 0.03 * np.sin(2.0 * x) * np.cos(3.0 * y)
    box = (x > 1.2) & (x < 1.6) & (y > -0.8) & (y < -0.4)
    return np.where(box, 0.10, waves)


def ground_tile(i: int, j: int, *, size: int = 32, cell: float = 0.02, stamp_ns: int = 1) -> MapTile:
    """A completely known tile of `ground_height`."""
    x = (i * size + np.arange(size) + 0.5)[:, None] * cell
    y = (j * size + np.arange(size) + 0.5)[None, :] * cell
    height = ground_height(x + 0 * y, y + 0 * x)
    slope = np.abs(np.gradient(height, cell)[0])
    index = np.clip(slope * 400, 0, 200).astype(np.uint8)
    return MapTile(
        stamp_ns=stamp_ns,
        i=i,
        j=j,
        size=size,
        cell=cell,
        elevation_mm=np.rint(height * 1000).astype(np.int16),
        sigma_mm=np.full((size, size), 6, dtype=np.uint8),
        roughness=index,
        step_height=np.where(height > 0.09, 150, index // 2).astype(np.uint8),
        age_s=np.zeros((size, size), dtype=np.uint8),
    )


class WireRobot:
    """Publishes on `step`, or by itself at 50 Hz between `start` and `stop`; keeps a lease and walks to waypoints."""

    def __init__(self, bus: Bus, robot_id: str = "weaver", *, session: str = "first", kind: str = "SIM") -> None:
        self.bus = bus
        self.robot_id = robot_id
        self.session = session
        self.kind = kind
        self.description = load_robot("weaver")
        self.commands: list[Command] = []
        self.holder, self.epoch, self.lease_until = "", 0, 0.0
        self.mode, self.stopped = "SIT", False
        self.waypoints: tuple[Waypoint, ...] = ()
        self.phase, self.next_waypoint = "empty", 0
        self.overrides: dict[str, float] = {}
        self.perception = "robust"
        self.place = np.zeros(2)
        self.velocity = np.zeros(3)
        self.speed = SPEED
        self.tick = 0
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._stopping = threading.Event()
        bus.serve(robot_id, self.answer)
        bus.announce(robot_id, "walk")

    def start(self) -> None:
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()

    def _run(self) -> None:
        self.publish_map()
        while not self._stopping.wait(0.02):
            self.step()

    def publish_map(self, reach: int = 4) -> None:
        for i in range(-reach, reach):
            for j in range(-reach, reach):
                self.bus.publish(self.robot_id, topics.MAP_TILE, ground_tile(i, j), i=i, j=j)

    def answer(self, command: Command) -> Answer:
        with self._lock:
            self.commands.append(command)
            answer = self._decide(command)
        text = f"{command.command.value}: {'accepted' if answer.accepted else answer.reason}"
        if command.command is not CommandName.RETAIN_CONTROL:
            self._publish(
                topics.EVENT, Event(stamp_ns=self.tick, severity=Severity.INFO, source=command.operator, text=text)
            )
        return answer

    def _decide(self, command: Command) -> Answer:
        now = time.monotonic()
        held = bool(self.holder) and now < self.lease_until
        name = command.command
        if name is CommandName.STOP:
            self.stopped, self.mode, self.velocity = True, "ESTOP", np.zeros(3)
            return Answer(accepted=True, reason="")
        if name is CommandName.TAKE_CONTROL:
            if held and self.holder != command.operator and not command.reason:
                return Answer(accepted=False, reason=f"{self.holder} controls this robot")
            self.holder, self.epoch, self.lease_until = command.operator, self.epoch + 1, now + LEASE_S
            return Answer(accepted=True, reason="", lease_epoch=self.epoch)
        if not held or self.holder != command.operator or command.lease_epoch != self.epoch:
            owner = f"{self.holder} controls this robot" if held else "nobody controls this robot; take control first"
            return Answer(accepted=False, reason=owner)
        return self._obey(command, now)

    def _obey(self, command: Command, now: float) -> Answer:
        name, applied = command.command, 0.0
        if name is CommandName.RETAIN_CONTROL:
            self.lease_until = now + LEASE_S
        elif name is CommandName.RELEASE_CONTROL:
            self.holder = ""
        elif name is CommandName.RELEASE_STOP:
            self.stopped, self.mode = False, "SIT"
        elif self.stopped:
            return Answer(accepted=False, reason="the robot is stopped; release the stop first")
        elif name in (CommandName.STAND, CommandName.SIT):
            self.mode = "STAND" if name is CommandName.STAND else "SIT"
        elif name is CommandName.SET_MISSION:
            self.waypoints, self.phase, self.next_waypoint = command.waypoints, "ready", 0
        elif name is CommandName.START_MISSION:
            if self.mode != "STAND":
                return Answer(accepted=False, reason="the robot must stand first")
            self.phase, self.mode = "active", "WALK"
        elif name is CommandName.PAUSE_MISSION:
            self.phase, self.mode = "paused", "STAND"
        elif name is CommandName.CLEAR_MISSION:
            self.waypoints, self.phase = (), "empty"
        elif name is CommandName.SET_OVERRIDE:
            applied = self.overrides[command.name] = command.value
        elif name is CommandName.CLEAR_OVERRIDE:
            self.overrides.pop(command.name, None)
        return Answer(accepted=True, reason="", lease_epoch=self.epoch, applied_value=applied)

    def step(self, dt: float = 0.02) -> None:
        """One 50 Hz tick: walk, then publish."""
        with self._lock:
            self._walk(dt)
            self.tick += 1
        stamp_ns = self.tick * 20_000_000
        self._publish(topics.HEARTBEAT, Heartbeat(stamp_ns=stamp_ns, sequence=self.tick, session=self.session))
        self._publish(topics.STATE, self.state(stamp_ns))
        if self.tick % 5 == 1:
            self._publish_slow(stamp_ns)

    def _walk(self, dt: float) -> None:
        self.velocity = np.zeros(3)
        if self.mode != "WALK":
            return
        if self.next_waypoint >= len(self.waypoints):
            self.phase, self.mode = "done", "STAND"
            return
        goal = self.waypoints[self.next_waypoint]
        away = np.array([goal.x, goal.y]) - self.place
        distance = float(np.linalg.norm(away))
        if distance < self.speed * dt:
            self.next_waypoint += 1
        else:
            self.velocity[:2] = self.speed * away / distance
            self.place = self.place + self.velocity[:2] * dt

    def state(self, stamp_ns: int) -> RobotState:
        robot = self.description
        height = float(ground_height(self.place[:1], self.place[1:])[0]) + robot.clearance
        joints = STANDING + (0.15 * np.sin(0.2 * self.tick + np.arange(30)) if self.mode == "WALK" else 0.0)
        pose = Pose(rotation=rotation_z(0.0), position=np.array([*self.place, height]))
        contact = np.ones(6, dtype=bool)
        if self.mode == "WALK":
            contact[(self.tick // 25) % 2 :: 2] = False
        return RobotState(
            stamp_ns=stamp_ns,
            position_in_world=pose.position,
            wxyz=pose.wxyz,
            velocity_command=self.velocity,
            velocity_in_body=self.velocity,
            joint_position=joints,
            joint_torque=np.linspace(-1.0, 1.0, 30),
            foot_in_body=feet_in_body(robot, joints),
            foot_contact=contact,
            foot_force=np.where(contact, 100.0 / contact.sum(), 0.0),
            stability_margin=0.08,
            roll=0.0,
            pitch=0.0,
        )

    def _publish_slow(self, stamp_ns: int) -> None:
        presence = Presence(
            robot_id=self.robot_id, session=self.session, kind=self.kind, robot="weaver", world="flat", schema=1
        )
        left = max(0.0, self.lease_until - time.monotonic()) if self.holder else 0.0
        self.holder = self.holder if left > 0.0 else ""
        mode = ModeState(
            stamp_ns=stamp_ns,
            mode=self.mode,
            action=SafetyAction.ALLOW,
            reasons=(),
            stopped=self.stopped,
            stop_level="settle" if self.stopped else "",
            allowed=tuple(name.value for name in CommandName),
        )
        mission = MissionState(
            stamp_ns=stamp_ns,
            phase=self.phase,
            waypoints=self.waypoints,
            next_waypoint=self.next_waypoint,
            cross_track_error=0.01,
            distance_left=1.0,
            lookahead_in_world=np.full(2, np.nan),
        )
        self._publish(topics.PRESENCE, presence)
        self._publish(topics.LEASE, LeaseState(holder=self.holder, epoch=self.epoch, seconds_left=left))
        self._publish(topics.MODE, mode)
        self._publish(topics.MISSION, mission)
        self._publish(topics.ADAPTATION, self._adaptation(stamp_ns))
        self._publish(topics.GAIT, self._gait(stamp_ns))
        self._publish(topics.POWER, _power(stamp_ns))
        truth = np.array([*self.place, self.description.clearance])
        upright = np.array([1.0, 0.0, 0.0, 0.0])
        self._publish(
            topics.TRUTH,
            TruthState(stamp_ns=stamp_ns, position_in_world=truth, wxyz=upright, velocity_in_world=self.velocity),
        )

    def _adaptation(self, stamp_ns: int) -> AdaptationReport:
        desired = GaitParameters(
            stamp_ns=stamp_ns, virtual_stiffness=2200.0, stride_frequency=0.9, stride_height=0.06, confidence=0.9
        )
        applied = GaitParameters(
            stamp_ns=stamp_ns,
            virtual_stiffness=self.overrides.get("virtual_stiffness", 2200.0),
            stride_frequency=self.overrides.get("stride_frequency", 0.9),
            stride_height=self.overrides.get("stride_height", 0.06),
            confidence=0.9,
        )
        return AdaptationReport(
            stamp_ns=stamp_ns,
            roughness=0.2,
            roughness_sigma=0.05,
            step_height=0.1,
            step_height_sigma=0.05,
            ahead_roughness=0.25,
            ahead_step_height=float("nan"),
            source="vision",
            desired=desired,
            applied=applied,
            overridden=tuple(self.overrides),
            preset="usual",
            perception=self.perception,
        )

    def _gait(self, stamp_ns: int) -> GaitState:
        return GaitState(
            stamp_ns=stamp_ns,
            gait="tripod",
            phase=np.full(6, (self.tick % 50) / 50),
            swing=np.arange(6) % 2 == 0,
            parameters_frequency=0.9,
            parameters_height=0.06,
            parameters_stiffness=2200.0,
        )

    def _publish(self, topic: topics.Topic, message: object) -> None:
        self.bus.publish(self.robot_id, topic, message)


def _power(stamp_ns: int) -> PowerState:
    return PowerState(
        stamp_ns=stamp_ns,
        battery_voltage=26.0,
        battery_fraction=0.8,
        supply_power=120.0,
        motor_power=60.0,
        energy=1000.0,
        cost_of_transport=float("nan"),
    )


def main() -> None:
    """Run one by hand beside a console: `python tests/console/wire_robot.py [id] [endpoint]`."""
    import sys

    from weaver_shared.bus import ZenohBus

    robot_id = sys.argv[1] if len(sys.argv) > 1 else "weaver"
    endpoint = sys.argv[2] if len(sys.argv) > 2 else "tcp/127.0.0.1:7447"
    bus = ZenohBus(connect=[endpoint])
    robot = WireRobot(bus, robot_id, session=str(time.time_ns()))
    robot.start()
    try:
        while True:
            time.sleep(1.0)
    finally:
        robot.stop()
        bus.close()


if __name__ == "__main__":
    main()
