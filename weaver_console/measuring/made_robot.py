"""A robot at the wire, as a process: real messages at a robot's rates over a changing map, and an answer to everything.

It does not walk: it loads a console as a robot does, and stamps what it says so that delays can be measured.
"""

from __future__ import annotations

import argparse
import signal
import threading
import time

import numpy as np
from numpy.typing import NDArray

from weaver_shared import codec, topics
from weaver_shared.bus import Bus, ZenohBus
from weaver_shared.config.mapping import MappingConfig
from weaver_shared.messages import (
    AdaptationReport,
    Answer,
    Command,
    CommandName,
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
)
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body

MAP = MappingConfig()
BLOCK = 3
"""Tiles along the edge of the square that changes with every update of the map."""

STANDING = np.tile([0.0, 0.0, -0.5, 1.3, 0.75], 6)


class MadeRobot:
    """Stamps are the computer's monotonic clock, ns, so that whoever hears them here can tell how late they are."""

    def __init__(self, bus: Bus, robot_id: str, *, extent: float) -> None:
        """`extent` is the length of the map's edge, m; 0 for a robot without a map."""
        self._bus = bus
        self._robot_id = robot_id
        self._robot = load_robot("weaver")
        self._presence = Presence(
            robot_id=robot_id, session=f"{time.time_ns():x}", kind="SIM", robot="weaver", world="flat",
            schema=codec.SCHEMA_VERSION,
        )  # fmt: skip
        self._edge = round(extent / (MAP.cell * MAP.tile))
        self._feet = feet_in_body(self._robot, STANDING)
        self._holder, self._epoch = "", 0
        self._random = np.random.default_rng(1)
        bus.serve(robot_id, self.answer)
        bus.announce(robot_id, "walk")

    def answer(self, command: Command) -> Answer:
        if command.command is CommandName.TAKE_CONTROL:
            self._holder, self._epoch = command.operator, self._epoch + 1
        elif command.command is CommandName.RELEASE_CONTROL:
            self._holder = ""
        self._publish_lease()
        return Answer(accepted=True, reason="", lease_epoch=self._epoch, applied_value=command.value)

    def publish_map(self) -> None:
        for i in range(self._edge):
            for j in range(self._edge):
                self._publish_tile(i, j)

    def change_map(self, update: int) -> None:
        """Nine tiles measured anew, about a place that moves on by a tile every ten updates."""
        places = self._edge - BLOCK + 1
        first_i, first_j = divmod(update // 10 % places**2, places)
        for i in range(first_i, first_i + BLOCK):
            for j in range(first_j, first_j + BLOCK):
                self._publish_tile(i, j)

    def publish_state(self, tick: int) -> None:
        stamp_ns = time.monotonic_ns()
        joints = STANDING + 0.15 * np.sin(0.2 * tick + np.arange(30))
        contact = np.arange(6) % 2 == (tick // 25) % 2
        state = RobotState(
            stamp_ns=stamp_ns,
            position_in_world=np.array([2.0 + 0.002 * (tick % 500), 2.0, 0.3]),
            wxyz=np.array([1.0, 0.0, 0.0, 0.0]),
            velocity_command=np.array([0.1, 0.0, 0.0]),
            velocity_in_body=np.array([0.1, 0.0, 0.0]),
            joint_position=joints,
            joint_torque=np.sin(0.1 * tick + np.arange(30)),
            foot_in_body=self._feet,
            foot_contact=contact,
            foot_force=np.where(contact, 33.3, 0.0),
            stability_margin=0.08,
            roll=0.01,
            pitch=0.02,
        )
        self._bus.publish(self._robot_id, topics.STATE, state)

    def publish_gait(self, tick: int) -> None:
        stamp_ns = time.monotonic_ns()
        gait = GaitState(
            stamp_ns=stamp_ns, gait="tripod", phase=np.full(6, (tick % 50) / 50), swing=np.arange(6) % 2 == 0,
            parameters_frequency=0.9, parameters_height=0.06, parameters_stiffness=2200.0,
        )  # fmt: skip
        self._bus.publish(self._robot_id, topics.GAIT, gait)
        beat = Heartbeat(stamp_ns=stamp_ns, sequence=tick, session=self._presence.session)
        self._bus.publish(self._robot_id, topics.HEARTBEAT, beat)

    def publish_slow(self) -> None:
        stamp_ns = time.monotonic_ns()
        parameters = GaitParameters(
            stamp_ns=stamp_ns, virtual_stiffness=2200.0, stride_frequency=0.9, stride_height=0.06, confidence=0.9
        )
        report = AdaptationReport(
            stamp_ns=stamp_ns, roughness=0.2, roughness_sigma=0.05, step_height=0.1, step_height_sigma=0.05,
            ahead_roughness=0.25, ahead_step_height=float("nan"), source="vision", desired=parameters,
            applied=parameters, overridden=(),
        )  # fmt: skip
        power = PowerState(
            stamp_ns=stamp_ns, battery_voltage=26.0, battery_fraction=0.8, supply_power=120.0, motor_power=60.0,
            energy=1000.0, cost_of_transport=1.2,
        )  # fmt: skip
        mode = ModeState(
            stamp_ns=stamp_ns, mode="STAND", action=SafetyAction.ALLOW, reasons=(), stopped=False, stop_level="",
            allowed=tuple(name.value for name in CommandName),
        )  # fmt: skip
        mission = MissionState(
            stamp_ns=stamp_ns, phase="empty", waypoints=(), next_waypoint=0, cross_track_error=0.0, distance_left=0.0,
            lookahead_in_world=np.full(2, np.nan),
        )  # fmt: skip
        self._bus.publish(self._robot_id, topics.PRESENCE, self._presence)
        self._bus.publish(self._robot_id, topics.ADAPTATION, report)
        self._bus.publish(self._robot_id, topics.POWER, power)
        self._bus.publish(self._robot_id, topics.MODE, mode)
        self._bus.publish(self._robot_id, topics.MISSION, mission)
        self._publish_lease()

    def _publish_lease(self) -> None:
        lease = LeaseState(holder=self._holder, epoch=self._epoch, seconds_left=2.0 if self._holder else 0.0)
        self._bus.publish(self._robot_id, topics.LEASE, lease)

    def _publish_tile(self, i: int, j: int) -> None:
        noise = self._random.integers(-3, 4, size=(MAP.tile, MAP.tile))
        index = (100 + 20 * noise).astype(np.uint8)
        known: NDArray[np.uint8] = np.full((MAP.tile, MAP.tile), 6, dtype=np.uint8)
        tile = MapTile(
            stamp_ns=time.monotonic_ns(), i=i, j=j, size=MAP.tile, cell=MAP.cell,
            elevation_mm=(self._height_mm(i, j) + noise).astype(np.int16), sigma_mm=known, roughness=index,
            step_height=index // 2, age_s=np.zeros_like(known),
        )  # fmt: skip
        self._bus.publish(self._robot_id, topics.MAP_TILE, tile, i=i, j=j)

    def _height_mm(self, i: int, j: int) -> NDArray[np.float64]:
        x = (i * MAP.tile + np.arange(MAP.tile) + 0.5)[:, None] * MAP.cell
        y = (j * MAP.tile + np.arange(MAP.tile) + 0.5)[None, :] * MAP.cell
        return np.asarray(30.0 * np.sin(2.0 * x) * np.cos(3.0 * y))


def talk(robot: MadeRobot, ended: threading.Event, *, state_rate: float, map_rate: float) -> None:
    """Publish until `ended`; rates in Hz."""
    robot.publish_map()
    jobs = [
        (1.0 / state_rate, robot.publish_state),
        (0.05, robot.publish_gait),
        (0.2, lambda _: robot.publish_slow()),
    ]
    if map_rate > 0.0:
        jobs.append((1.0 / map_rate, robot.change_map))
    due = [time.monotonic() + period / len(jobs) * k for k, (period, _) in enumerate(jobs)]
    counts = [0] * len(jobs)
    while not ended.wait(max(0.0, min(due) - time.monotonic())):
        k = due.index(min(due))
        period, job = jobs[k]
        job(counts[k])
        counts[k] += 1
        due[k] = max(due[k] + period, time.monotonic() - period)


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    bus = ZenohBus(connect=options.connect)
    robots = [MadeRobot(bus, robot_id, extent=options.extent) for robot_id in options.robot_id]
    talking = [
        threading.Thread(
            target=talk, args=(one, ended), kwargs={"state_rate": options.state_rate, "map_rate": options.map_rate}
        )
        for one in robots
    ]
    for thread in talking:
        thread.start()
    for thread in talking:
        thread.join()
    bus.close()
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver_console.measuring.made_robot", description=__doc__)
    parser.add_argument("--robot-id", action="append", required=True, help="name on the bus; may be repeated")
    parser.add_argument("--connect", action="append", required=True, help="bus endpoint to join; may be repeated")
    parser.add_argument("--state-rate", type=float, default=30.0, help="states a second, Hz (%(default)s)")
    parser.add_argument("--map-rate", type=float, default=0.0, help="map updates of nine tiles a second, Hz")
    parser.add_argument("--extent", type=float, default=0.0, help="edge of the map, m; 0 for none")
    return parser


if __name__ == "__main__":
    import sys

    sys.exit(main(sys.argv[1:]))
