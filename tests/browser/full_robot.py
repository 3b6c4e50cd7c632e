"""The robot at the wire with all that the page can show: health, odometry, pictures, a recorder."""

from __future__ import annotations

import io
import threading
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw
from wire_robot import SPEED, WireRobot

from robot_agent.forbidden_areas import Area, areas_of
from robot_agent.recording.playback import Playback
from robot_agent.recording.player import Player
from robot_agent.recording.store import RecordingStore
from robot_agent.recording_process import RecordingProcess
from robot_agent.replays import Replays
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import MonotonicClock
from weaver_shared.errors import InputError
from weaver_shared.messages import (
    Answer,
    CameraPicture,
    Command,
    CommandName,
    ForbiddenAreas,
    Health,
    LocomotionState,
    LoopTiming,
    MissionOutlook,
    MotionOrders,
    OdometryEstimate,
    OdometryQuality,
    ServoStates,
    TrackedFeatures,
)

PATIENT_LEASE = 20.0  # s


class FullRobot(WireRobot):
    def __init__(self, bus: MemoryBus, robot_id: str, folder: Path, **settings: str) -> None:
        super().__init__(bus, robot_id, **settings)
        self.quality, self.temperature = OdometryQuality.GOOD, 41.0
        self.faults: tuple[str, ...] = ()
        self.real_time_factor = 1.0
        self.areas: tuple[Area, ...] = ()
        self._recorder = RecordingProcess(
            robot_id=robot_id,
            robot=self.description,
            bus=bus,
            open_bus=lambda: Ear(bus),
            store=RecordingStore(folder),
            replays=Replays(lambda path, name: Playing(path, bus, name)),
            clock=MonotonicClock(),
            wall_time=lambda: datetime.now(UTC),
        )
        self._recording = threading.Thread(target=self._recorder.run, args=(self._stopping,), daemon=True)

    def start(self) -> None:
        self._recording.start()
        super().start()

    def stop(self) -> None:
        super().stop()
        self._recording.join()

    def set_back(self) -> None:
        """As it was before any test."""
        with self._lock:
            self.holder, self.lease_until = "", 0.0
            self.mode, self.stopped, self.phase = "SIT", False, "empty"
            self.waypoints, self.next_waypoint, self.overrides = (), 0, {}
            self.place, self.commands, self.areas = np.zeros(2), [], ()
            self.quality, self.temperature, self.real_time_factor = OdometryQuality.GOOD, 41.0, 1.0
            self.faults, self.perception, self.speed = (), "robust", SPEED

    def _decide(self, command: Command) -> Answer:
        """A busy computer holds up pages for seconds; losing control by that is not what these tests are about."""
        answer = super()._decide(command)
        if self.holder:
            self.lease_until = max(self.lease_until, time.monotonic() + PATIENT_LEASE)
        return answer

    def _obey(self, command: Command, now: float) -> Answer:
        if command.command is CommandName.SET_AREAS:
            try:
                self.areas = areas_of(command)
            except InputError as error:
                return Answer(accepted=False, reason=str(error))
        elif command.command is CommandName.SET_PERCEPTION:
            self.perception = command.name
        return super()._obey(command, now)

    def step(self, dt: float = 0.02) -> None:
        super().step(dt)
        stamp_ns = self.tick * 20_000_000
        if self.tick % 4 == 1:
            self._publish(topics.ODOMETRY, self._odometry(stamp_ns))
            self._publish(topics.LOCOMOTION, self._locomotion(stamp_ns))
        if self.tick % 10 == 1:
            self.bus.publish(self.robot_id, topics.CAMERA, _picture(stamp_ns, self.tick), name="left")
            self.bus.publish(self.robot_id, topics.FEATURES, _features(stamp_ns, self.tick), name="left")
            self._publish(topics.MOTION, self._motion(stamp_ns))
            self._publish(topics.SERVOS, self._servos(stamp_ns))
        if self.tick % 25 == 1:
            self.bus.publish(self.robot_id, topics.HEALTH, self._health(stamp_ns, "walk"), process="walk")
            self.bus.publish(self.robot_id, topics.HEALTH, self._health(stamp_ns, "vision"), process="vision")
            self._publish(topics.OUTLOOK, self._outlook(stamp_ns))
            self._publish(topics.AREAS, ForbiddenAreas(stamp_ns=stamp_ns, areas=self.areas))

    def _odometry(self, stamp_ns: int) -> OdometryEstimate:
        state = self.state(stamp_ns)
        return OdometryEstimate(
            stamp_ns=stamp_ns,
            position_in_world=state.position_in_world,
            wxyz=state.wxyz,
            velocity_in_world=self.velocity,
            angular_velocity_in_body=np.zeros(3),
            gyro_bias=np.zeros(3),
            accel_bias=np.zeros(3),
            covariance=np.diag([1e-5] * 3 + [4e-4, 9e-4, 1e-4]),
            quality=self.quality,
            reason="" if self.quality is OdometryQuality.GOOD else "few features",
            tracked_features=140,
        )

    def _locomotion(self, stamp_ns: int) -> LocomotionState:
        return LocomotionState(
            stamp_ns=stamp_ns,
            posture="walking" if self.mode == "WALK" else "standing",
            stability="good",
            stability_margin=0.08,
            energy_margin=0.02,
            ground_plane=np.zeros(3),
            ground_residual=0.004,
            pose_position=np.zeros(3),
            pose_rpy=np.zeros(3),
            slipping=np.zeros(6, dtype=bool),
            leg_stages=("supporting",) * 6,
            lift_margins=np.full(6, 0.03) if self.mode == "STAND" else np.zeros(0),
            leg_posture="",
        )

    def _motion(self, stamp_ns: int) -> MotionOrders:
        return MotionOrders(
            stamp_ns=stamp_ns,
            pose=np.zeros(6),
            automatic_posing=False,
            levelling=True,
            in_sequence=False,
            cruise_velocity=np.zeros(3),
            cruise_seconds_left=0.0,
            held_legs=(),
            held_tips=np.zeros((0, 3)),
        )

    def _health(self, stamp_ns: int, process: str) -> Health:
        seeing = process == "vision"
        timing = LoopTiming(
            name=process,
            stamp_ns=stamp_ns,
            rate=20.0 if seeing else 100.0,
            period_error_p99=0.0021,
            overruns=0,
            cpu_fraction=0.4,
            real_time_factor=self.real_time_factor,
        )
        return Health(
            stamp_ns=stamp_ns,
            timings=(timing,),
            odometry_quality=self.quality.value if seeing else "",
            odometry_reason="few features" if seeing and self.quality is not OdometryQuality.GOOD else "",
            odometry_age=0.04,
            tracked_features=140 if seeing else 0,
            max_temperature=float("nan") if seeing else self.temperature,
        )

    def _servos(self, stamp_ns: int) -> ServoStates:
        temperature = np.linspace(30.0, self.temperature, self.description.joint_count)
        return ServoStates(stamp_ns=stamp_ns, temperature=temperature, faults=self.faults)

    def _outlook(self, stamp_ns: int) -> MissionOutlook:
        return MissionOutlook(
            stamp_ns=stamp_ns,
            start_in_world=np.zeros(2),
            speed=0.1,
            speed_basis="measured",
            measured_over=2.0,
            energy_per_metre=900.0,
            cost_of_transport=8.9,
        )


class Playing:
    """A replay in a thread of the test's own process."""

    def __init__(self, path: Path, bus: MemoryBus, name: str) -> None:
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._play, args=(path, Ear(bus), name), daemon=True)
        self._thread.start()

    def poll(self) -> int | None:
        return None if self._thread.is_alive() else 0

    def terminate(self) -> None:
        self._ended.set()

    def wait(self, timeout: float) -> int:
        self._thread.join(timeout)
        return 0

    def _play(self, path: Path, bus: Ear, name: str) -> None:
        playback = Playback(path)
        player = Player(playback, bus, MonotonicClock(), replay_id=name, run=str(time.monotonic_ns()))  # type: ignore[arg-type]
        while not (self._ended.wait(0.02) or player.ended):
            player.turn()
        bus.close()
        playback.close()


class Ear:
    """An end of a bus within the process that can be closed alone."""

    def __init__(self, bus: MemoryBus) -> None:
        self._bus = bus
        self._announced: list[tuple[str, str]] = []
        self._open = True

    def subscribe(self, robot_id: str, topic: topics.Topic, receiver: Callable[[str, str, Any], None]) -> None:
        self._bus.subscribe(robot_id, topic, lambda *said: receiver(*said) if self._open else None)

    def announce(self, robot_id: str, process: str) -> None:
        self._announced.append((robot_id, process))
        self._bus.announce(robot_id, process)

    def close(self) -> None:
        self._open = False
        for robot_id, process in self._announced:
            self._bus._alive.remove((robot_id, process))
            for watcher in self._bus._watchers:
                watcher(robot_id, process, False)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._bus, name)


def _features(stamp_ns: int, tick: int) -> TrackedFeatures:
    """The corners of what moves in the picture, at twice its size."""
    k = np.arange(12)
    x, y = (37 * k + 3 * (tick // 10)) % 320, (53 * k) % 240
    corners = np.concatenate([np.stack([x, y], axis=1), np.stack([x + 18, y + 14], axis=1)]).astype(np.int16) * 2
    return TrackedFeatures(
        stamp_ns=stamp_ns, width=640, height=480, both_eyes=corners[:16], one_eye=corners[16:21], rejected=corners[21:]
    )


def _picture(stamp_ns: int, tick: int) -> CameraPicture:
    """A picture with something that moves."""
    picture = Image.new("L", (320, 240), 90)
    draw = ImageDraw.Draw(picture)
    for k in range(12):
        x, y = (37 * k + 3 * (tick // 10)) % 320, (53 * k) % 240
        draw.rectangle((x, y, x + 18, y + 14), fill=(40 + 15 * k) % 255)
    stream = io.BytesIO()
    picture.save(stream, "JPEG", quality=60)
    return CameraPicture(stamp_ns=stamp_ns, name="left", jpeg=stream.getvalue())
