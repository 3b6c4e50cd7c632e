"""Runs the pipelines: read, step, write, publish, wait. One loop a process; the bus hands over by latest-wins slots."""

from __future__ import annotations

import logging
import secrets
import time
from collections.abc import Callable, Sequence

import numpy as np

from robot_agent.adaptation import ParameterOverrides
from robot_agent.body import Body, JointTargets, Trouble
from robot_agent.commands import CommandDesk, Situation
from robot_agent.cover_watch import CoverWatch
from robot_agent.felt_queue import Felt, FeltQueue
from robot_agent.headway import Headway
from robot_agent.mapping import TerrainMap
from robot_agent.navigation import Area
from robot_agent.perception import CloseLook
from robot_agent.pipeline import VisionPipeline, VisionTick, WalkPipeline, WalkTick
from robot_agent.telemetry import Telemetry
from robot_agent.timing import LoopMeter
from weaver_shared import codec, topics
from weaver_shared.bus import Bus
from weaver_shared.config.perception import PLANE_MODES, PerceptionConfig, PlaneMode
from weaver_shared.latest import LatestSlot
from weaver_shared.messages import (
    AdaptationReport,
    Event,
    ForbiddenAreas,
    Health,
    NavigationGoal,
    OdometryEstimate,
    PerceptionOrder,
    Presence,
    Proprioception,
    RoutePlan,
    SafetyAction,
    Severity,
    StereoFrame,
    TeleopFrame,
)
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose, rotation_z, yaw_of

logger = logging.getLogger(__name__)

CONTROL_RATE = 100.0
HEALTH_TICKS = 50


class WalkLoop:
    """Body, safety and locomotion of one robot. `tick()` is one control period; the body decides how long that is."""

    def __init__(
        self,
        *,
        robot_id: str,
        body: Body,
        bus: Bus,
        world: str = "",
        wall_clock_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        self._body = body
        robot = body.robot
        overrides = ParameterOverrides(body.robot.adaptation)
        self.desk = CommandDesk(robot=robot, overrides=overrides, wall_clock_ns=wall_clock_ns)
        self._pipeline = WalkPipeline(robot, overrides, dt=1.0 / CONTROL_RATE, holding=body.holding)
        self._odometry: LatestSlot[OdometryEstimate] = LatestSlot()
        self._report: LatestSlot[AdaptationReport] = LatestSlot()
        self._route: LatestSlot[RoutePlan] = LatestSlot()
        if body.holding:
            # A program that died left it on its feet: there it stays, and nobody need be there yet.
            self.desk.stand_unattended()
        presence = Presence(
            robot_id=robot_id,
            session=secrets.token_hex(4),
            kind=body.kind,
            robot=robot.name,
            world=world,
            schema=codec.SCHEMA_VERSION,
        )
        self._telemetry = Telemetry(bus=bus, robot_id=robot_id, robot=robot, presence=presence, rate=CONTROL_RATE)
        self._meter = LoopMeter("walk", CONTROL_RATE)
        self._headway = Headway()
        self._mission_serial = 0
        self._last_estimate: OdometryEstimate | None = None
        self._told: set[str] = set()
        self._ticks = 0
        bus.subscribe(robot_id, topics.ODOMETRY, lambda _id, _key, message: self._odometry.put(message))
        bus.subscribe(robot_id, topics.DESIRED_GAIT, lambda _id, _key, message: self._report.put(message))
        bus.subscribe(robot_id, topics.ROUTE, lambda _id, _key, message: self._route.put(message))
        bus.subscribe(robot_id, topics.MAP_TILE, lambda _id, _key, tile: self.desk.ground.put(tile))
        bus.subscribe(robot_id, topics.TELEOP, self._teleoperate)
        bus.serve(robot_id, self.desk.answer)
        bus.announce(robot_id, "walk")

    def tick(self) -> tuple[WalkTick, Proprioception]:
        stamp_ns = self._body.wait_next()
        self._meter.woke(stamp_ns)
        sensed = self._body.read()
        try:
            tick = self._step(sensed)
        except BaseException:
            self._halt(sensed)
            raise
        self._body.write(tick.targets)
        self._after(tick, sensed)
        return tick, sensed

    def _step(self, sensed: Proprioception) -> WalkTick:
        if (estimate := self._odometry.take()) is not None:
            self._last_estimate = estimate
            self._pipeline.correct(estimate)
        if (report := self._report.take()) is not None:
            self._pipeline.adapt(report)
        if (route := self._route.take()) is not None:
            self._pipeline.take_route(route)
        orders = self.desk.orders()
        self._mission_serial = orders.mission_serial
        troubles = self._body.findings()
        self._tell(troubles)
        return self._pipeline.step(sensed, orders, troubles)

    def _tell(self, troubles: Sequence[Trouble]) -> None:
        """New troubles of the body as events; what leaves it without torque stops it until somebody releases it."""
        for trouble in troubles:
            if trouble.text not in self._told:
                self.desk.note(Severity.WARNING, trouble.text)
            if trouble.action is SafetyAction.CUT:
                self.desk.stop_by_itself()
        self._told = {trouble.text for trouble in troubles}

    def _after(self, tick: WalkTick, sensed: Proprioception) -> None:
        if tick.follower is not None:
            self.desk.mission_progress(
                serial=self._mission_serial,
                index=tick.follower.index - 1,
                cross_track_error=tick.follower.cross_track_error,
                distance_left=tick.follower.distance_left,
                lookahead=tick.follower.lookahead_in_world,
                done=tick.follower.done,
            )
        if tick.route is not None and tick.route.hopeless:
            self.desk.give_up_mission(tick.route.waiting)
        self._watch_headway(tick)
        if tick.verdict.action in (SafetyAction.SIT, SafetyAction.CUT):
            self.desk.withdraw_stand()
        x, y, _ = tick.state.world_from_body.position
        self.desk.observe(
            Situation(
                stamp_ns=tick.stamp_ns,
                robot_xy=(float(x), float(y)),
                mode=tick.permission.mode,
                settled=tick.permission.settled,
                stand_blockers=tick.verdict.reasons if tick.permission.mode in ("OFF", "READY", "FAULT") else (),
                lift_margins=tick.walk.lift_margins,
                change_refusal=tick.walk.change_refusal,
                leg_reach=self._pipeline.leg_reach,
                world_from_body=tick.state.world_from_body,
            )
        )
        for text in tick.walk.events:
            self.desk.note(Severity.WARNING, text)
        self._telemetry.publish(tick, sensed, self.desk, self._body.joint_faults)
        self._ticks += 1
        if self._ticks % HEALTH_TICKS == 0:
            age = self._pipeline.odometry_age
            self._telemetry.publish_health(self._meter.report(tick.stamp_ns), sensed, self._last_estimate, age)

    def _watch_headway(self, tick: WalkTick) -> None:
        """Pause a mission on which the robot does not get on."""
        if tick.follower is None or not tick.permission.walk:
            self._headway.rest()
        elif self._headway.stuck(tick.state.world_from_body, tick.stamp_ns):
            self._headway.rest()
            why = ", ".join(tick.walk.reasons) or "something is in its way"
            self.desk.give_up_mission(f"the robot does not get on ({why}); steer it free, then start again")

    def _halt(self, sensed: Proprioception) -> None:
        """Last act after an unexpected error: hold the joints where they are. Never raises."""
        try:
            self._body.write(
                JointTargets(
                    stamp_ns=sensed.stamp_ns,
                    position=sensed.joint_position,
                    torque_limit=np.full(sensed.joint_position.size, np.inf),
                    torque_on=True,
                )
            )
        except Exception:
            logger.exception("the body did not take the order to hold")

    def _teleoperate(self, _robot_id: str, _key: str, frame: TeleopFrame) -> None:
        self.desk.teleoperate(frame)


class VisionLoop:
    """Odometry, perception, map and adaptation of one robot; begins where the walk loop says the robot is."""

    def __init__(self, *, robot_id: str, robot: RobotDescription, bus: Bus) -> None:
        self._robot_id = robot_id
        self._robot = robot
        self._bus = bus
        self._pipeline: VisionPipeline | None = None
        self._felt = FeltQueue()
        self._meter = LoopMeter("vision", robot.camera.rate)
        self._cover = CoverWatch()
        self._goal: LatestSlot[NavigationGoal] = LatestSlot()
        self._judging: PlaneMode = PerceptionConfig().mode
        self._ordered: LatestSlot[PerceptionOrder] = LatestSlot()
        self._areas: LatestSlot[ForbiddenAreas] = LatestSlot()
        self._forbidden: tuple[Area, ...] = ()
        bus.subscribe(robot_id, topics.GOAL, lambda _id, _key, message: self._goal.put(message))
        bus.subscribe(robot_id, topics.AREAS, lambda _id, _key, message: self._areas.put(message))
        bus.subscribe(robot_id, topics.PERCEPTION, lambda _id, _key, message: self._ordered.put(message))
        self._frames = 0

    def feel(self, sensed: Proprioception) -> None:
        self._felt.add(sensed)

    def imu_covers(self, stamp_ns: int) -> bool:
        return self._felt.newest_imu_ns() >= stamp_ns

    def begin(self, world_from_body: Pose) -> None:
        """Start, or start again, with the robot at this position and heading."""
        upright = Pose(rotation=rotation_z(yaw_of(world_from_body.rotation)), position=world_from_body.position)
        self._pipeline = VisionPipeline(self._robot, upright)
        self._pipeline.judge_ground(self._judging)
        self._cover = CoverWatch()

    @property
    def begun(self) -> bool:
        return self._pipeline is not None

    @property
    def map(self) -> TerrainMap | None:
        """The terrain map, once begun; not to be touched while a picture is processed."""
        return self._pipeline.map if self._pipeline is not None else None

    def step(self, frame: StereoFrame, *, closely: bool = False) -> VisionTick:
        """Process one pair whose IMU samples have arrived, and publish what came of it."""
        tick = self.process(frame, self.take_felt(frame.stamp_ns), closely=closely)
        self.publish(tick)
        return tick

    def take_felt(self, stamp_ns: int) -> Felt:
        """What was felt up to a picture's stamp, each reading once."""
        return self._felt.up_to(stamp_ns)

    def process(self, frame: StereoFrame, felt: Felt, *, closely: bool = False) -> VisionTick:
        """Process one pair without publishing: safe on another thread while this one goes on feeling."""
        if self._pipeline is None:
            raise RuntimeError("begin() comes before process()")
        self._meter.woke(frame.stamp_ns)
        return self._pipeline.step(frame, felt.imu, felt.legs, closely=closely)

    def publish(self, tick: VisionTick) -> None:
        publish = self._bus.publish
        publish(self._robot_id, topics.ODOMETRY, tick.odometry)
        if tick.terrain is not None:
            publish(self._robot_id, topics.TERRAIN, tick.terrain)
        if tick.report is not None:
            publish(self._robot_id, topics.DESIRED_GAIT, tick.report)
        for tile in tick.tiles:
            publish(self._robot_id, topics.MAP_TILE, tile, i=tile.i, j=tile.j)
        if tick.features is not None:
            publish(self._robot_id, topics.FEATURES, tick.features, name="left")
        if tick.route is not None:
            publish(self._robot_id, topics.ROUTE, tick.route)
        if tick.look is not None:
            publish(self._robot_id, topics.EVENT, _event_of(tick.look))
        if tick.terrain is not None and self._pipeline is not None:
            event = self._cover.step(self._pipeline.map.cover, tick.terrain.stamp_ns)
            if event is not None:
                publish(self._robot_id, topics.EVENT, event)
        self._take_orders()
        self._frames += 1
        if self._frames % 10 == 0:
            self._publish_health(tick.odometry)

    def _take_orders(self) -> None:
        """Between pictures, so that one on another thread sees the same orders from beginning to end."""
        if self._pipeline is None:
            return
        if (goal := self._goal.take()) is not None:
            self._pipeline.seek(goal)
        if (areas := self._areas.take()) is not None:
            self._forbidden = areas.areas
        self._pipeline.keep_out(self._forbidden)
        order = self._ordered.take()
        if order is not None and order.mode in PLANE_MODES:
            self._judging = order.mode
            self._pipeline.judge_ground(self._judging)

    def _publish_health(self, odometry: OdometryEstimate) -> None:
        timing = self._meter.report(odometry.stamp_ns)
        health = Health(
            stamp_ns=odometry.stamp_ns,
            timings=(timing,),
            odometry_quality=odometry.quality.value,
            odometry_reason=odometry.reason,
            odometry_age=0.0,
            tracked_features=odometry.tracked_features,
            max_temperature=float("nan"),
        )
        self._bus.publish(self._robot_id, topics.HEALTH, health, process="vision")


def _event_of(look: CloseLook) -> Event:
    if look.cells:
        severity = Severity.INFO
        text = f"a close look measured {look.cells} cells, typically to {1000 * look.sigma:.1f} mm"
    else:
        severity, text = Severity.WARNING, f"a close look measured nothing: {look.reason}"
    return Event(stamp_ns=look.stamp_ns, severity=severity, source="vision", text=text)
