"""The robot's data flow, stage after stage (ICRA'17 Fig. 2). No I/O, no clock, no branch on simulated or real.

vision loop   pictures, IMU -> odometry -> perception -> mapping -> adaptation
walk loop     joints, IMU   -> state    -> navigation -> locomotion -> joint targets, under safety
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from robot_agent.adaptation import AdaptationController, ParameterOverrides
from robot_agent.body import JointTargets, Trouble
from robot_agent.feature_view import FeatureView
from robot_agent.limits import JointGate
from robot_agent.locomotion import Postures, WalkInput, WalkOutput
from robot_agent.locomotion.footholds import orders_in_body
from robot_agent.locomotion.leg_reach import LegReach
from robot_agent.mapping import FirmFeet, TerrainMap
from robot_agent.modes import ModeMachine, Permission
from robot_agent.navigation import Area, FollowerOutput, PathFollower, RouteFollower, RoutePlanner, RouteTick
from robot_agent.odometry import NavigationState, OwnLegs, StatePropagator, StereoInertialOdometry
from robot_agent.orders import Orders
from robot_agent.perception import BodySense, CloseLook, FeltGround, Roughness, TerrainPerception
from robot_agent.safety import SafetySupervisor, Verdict
from robot_agent.vigilance import Vigilance
from robot_agent.vision.camera import StereoCalibration
from weaver_shared.config.navigation import RouteConfig
from weaver_shared.config.perception import PerceptionConfig, PlaneMode
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.leg_batch import LegBatch
from weaver_shared.messages import (
    AdaptationReport,
    ImuBatch,
    MapTile,
    NavigationGoal,
    OdometryEstimate,
    OdometryQuality,
    Proprioception,
    RoutePlan,
    StereoFrame,
    TerrainEstimate,
    TrackedFeatures,
    Waypoint,
)
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.transforms import Pose

UNKNOWN_GRAVITY = np.full(3, np.nan)
"""For the attitude of a robot whose IMU is silent: legs and body keep what they do about it."""

REPORT_LIFETIME = 1.0
"""Seconds after which an adaptation report no longer describes the ground under the robot."""

FELT_LIFETIME_NS = 500_000_000
"""As long as that the legs may be silent, and what was felt before still holds: a picture late by a little comes with
no reading of its own."""

PLAN_EVERY = RouteConfig().every


@dataclass(frozen=True, slots=True, kw_only=True)
class VisionTick:
    odometry: OdometryEstimate
    terrain: TerrainEstimate | None  # None in frames that perception leaves out
    report: AdaptationReport | None
    tiles: tuple[MapTile, ...]
    route: RoutePlan | None = None  # when a way was looked for
    look: CloseLook | None = None  # when a close one was asked for
    features: TrackedFeatures | None = None  # of the pictures that people are shown


class VisionPipeline:
    """Pictures and inertia in; pose, map and desired gait parameters out."""

    def __init__(self, robot: RobotDescription, initial: Pose, *, perceive_every: int = 2) -> None:
        self._robot = robot
        calibration = StereoCalibration.of_robot(robot)
        self._odometry = StereoInertialOdometry(calibration=calibration, imu=robot.imu, initial=initial)
        self._perception = TerrainPerception(calibration)
        self._map = TerrainMap()
        self._feet = FirmFeet(robot)
        self._felt_ground = FeltGround(PerceptionConfig().felt, PerceptionConfig().features)
        self._felt = Roughness.unknown()
        self._felt_ns = 0  # when the legs last told anything
        self._adaptation = AdaptationController(robot.adaptation)
        self._planner = RoutePlanner(robot)
        self._goal: NavigationGoal | None = None
        self._areas: tuple[Area, ...] = ()
        self._view = FeatureView(robot.camera.rate)
        self._perceive_every = perceive_every
        self._frames = 0
        self._adapted_ns: int | None = None

    @property
    def map(self) -> TerrainMap:
        return self._map

    def judge_ground(self, mode: PlaneMode) -> None:
        """As published or robustly, from the next picture on."""
        self._perception.mode = mode

    def seek(self, goal: NavigationGoal | None) -> None:
        """Look for a way to this place from now on, or for none."""
        self._goal = goal if goal is not None and goal.active else None

    def keep_out(self, areas: tuple[Area, ...]) -> None:
        """Find no way into these from now on."""
        self._areas = areas

    def step(self, frame: StereoFrame, imu: ImuBatch, legs: LegBatch, *, closely: bool = False) -> VisionTick:
        """One stereo pair with all IMU samples and readings of the legs since the previous one.

        `closely`: perceived in any case, and at full resolution.
        """
        contacts = FootContacts.of(self._robot, legs)
        odometry = self._odometry.step(frame, imu, contacts, OwnLegs.of(self._robot, legs))
        self._frames += 1
        features = self._view.of(frame, self._odometry.followed)
        self._map.remember(odometry)
        self._feel(contacts, legs, odometry)
        if self._frames % self._perceive_every and not closely:
            return VisionTick(odometry=odometry, terrain=None, report=None, tiles=(), features=features)
        ground_height = self._ground_height(contacts, odometry)
        perceived = self._perception.step(frame, odometry, ground_height, closely=closely)
        self._map.follow(self._odometry.settled_poses)
        self._map.update(perceived, odometry)
        x, y, _ = odometry.position_in_world
        worst = self._map.worst_within(x, y)
        dt = 0.0 if self._adapted_ns is None else (frame.stamp_ns - self._adapted_ns) * 1e-9
        self._adapted_ns = frame.stamp_ns
        report = self._adaptation.step(worst, perceived.estimate, frame.stamp_ns, dt, self._felt)
        return VisionTick(
            odometry=odometry,
            terrain=perceived.estimate,
            report=report,
            tiles=tuple(self._map.changed_tiles(frame.stamp_ns)),
            route=self._route(odometry),
            look=CloseLook.of(perceived) if closely else None,
            features=features,
        )

    def _ground_height(self, contacts: FootContacts | None, odometry: OdometryEstimate) -> float | None:
        """Where ground is expected, m in world: a sitting robot's is higher than a standing one's."""
        if contacts is None:
            return None
        height = contacts.ground_height(odometry.world_from_body, self._robot.foot_radius)
        return height if np.isfinite(height) else None

    def _feel(self, contacts: FootContacts | None, legs: LegBatch, odometry: OdometryEstimate) -> None:
        """Footholds enter the map while it is known where they are; with loads and tilt they speak of the ground."""
        if contacts is not None:
            self._felt_ns = odometry.stamp_ns
        elif odometry.stamp_ns - self._felt_ns < FELT_LIFETIME_NS:
            return
        footholds = self._feet.step(contacts, odometry.world_from_body)
        placed = odometry.quality in (OdometryQuality.GOOD, OdometryQuality.DEGRADED)
        self._felt = self._felt_ground.step(
            BodySense.of(
                self._robot, legs, odometry.stamp_ns, odometry.world_from_body, self._feet.standing, placed=placed
            )
        )
        if len(footholds) and placed:
            self._map.touch(footholds, odometry.stamp_ns)

    def _route(self, odometry: OdometryEstimate) -> RoutePlan | None:
        """A way to the goal, looked for after every few perceived pictures."""
        if self._goal is None or self._frames % (self._perceive_every * PLAN_EVERY):
            return None
        x, y, _ = odometry.position_in_world
        if not np.isfinite([x, y]).all():
            return None
        return self._planner.step(self._goal, self._map.grid, float(x), float(y), odometry.stamp_ns, self._areas)


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkTick:
    """Everything one control tick concluded."""

    stamp_ns: int
    targets: JointTargets
    state: NavigationState
    verdict: Verdict
    permission: Permission
    velocity_command: NDArray[np.float64]  # (3,) asked of the gait
    walk: WalkOutput
    report: AdaptationReport
    follower: FollowerOutput | None
    route: RouteTick | None = None  # of a mission that finds its own way


class WalkPipeline:
    """Joints, inertia and the operator's orders in; joint targets out."""

    def __init__(
        self, robot: RobotDescription, overrides: ParameterOverrides, dt: float, *, holding: bool = False
    ) -> None:
        """`holding`: its servos already bear the robot with torque, and go on doing so."""
        self._robot = robot
        self._dt = dt
        self._overrides = overrides
        self._fallback = AdaptationController(robot.adaptation)
        self._follower = PathFollower()
        self._route_follower = RouteFollower(half_width=robot.half_width)
        self._route: RoutePlan | None = None
        self._walker = Postures(robot, dt=dt)
        self._safety = SafetySupervisor()
        self._vigilance = Vigilance()
        self._modes = ModeMachine(torque_on=holding)
        self._begun = False
        self._gate = JointGate(robot)
        self._propagator: StatePropagator | None = None
        self._posture = "sitting"
        self._report: AdaptationReport | None = None
        self._path: tuple[Waypoint, ...] = ()
        self._path_index = 0
        self._path_serial = -1
        self._torque_limit = np.tile([robot.servos[j.servo].stall_torque for j in robot.joints], robot.leg_count)

    def correct(self, estimate: OdometryEstimate) -> None:
        """Take the vision loop's newest pose."""
        if self._propagator is not None:
            self._propagator.correct(estimate)
        self._vigilance.odometry_arrived(estimate)

    def adapt(self, report: AdaptationReport) -> None:
        """Take the vision loop's newest gait parameters."""
        self._report = report

    def take_route(self, route: RoutePlan) -> None:
        """Take the vision loop's newest way to the goal."""
        self._route = route

    @property
    def odometry_age(self) -> float:
        """Seconds since the vision loop was last heard."""
        return self._vigilance.odometry_age()

    @property
    def leg_reach(self) -> LegReach:
        """Where the legs may put their feet; lives on with the walker."""
        return self._walker.leg_reach

    def step(self, sensed: Proprioception, orders: Orders, troubles: Sequence[Trouble] = ()) -> WalkTick:
        state = self._navigate(sensed)
        upright = self._posture != "sitting"
        inputs = self._vigilance.inspect(sensed, state, orders, upright=upright, troubles=troubles)
        verdict = self._safety.step(inputs, self._dt)
        permission = self._modes.step(orders, verdict, self._posture)
        velocity, follower, route = self._velocity(state, orders, permission)
        report = self._parameters(sensed.stamp_ns)
        if not permission.torque_on or not self._begun:
            self._begun = True
            self._walker.reset(sensed.joint_position)
        walk = self._walker.step(
            WalkInput(
                stamp_ns=sensed.stamp_ns,
                velocity=velocity,
                parameters=report.applied,
                gait=orders.gait,
                stand=permission.stand,
                joint_position=sensed.joint_position,
                joint_torque=sensed.joint_torque,
                foot_contact=sensed.foot_contact,
                gravity_in_body=state.gravity_in_body if verdict.attitude_known else UNKNOWN_GRAVITY,
                posing=orders.posing,
                legs=orders.legs,
                footholds=orders_in_body(orders.footholds, state.world_from_body) if orders.footholds else (),
                in_sequence=orders.in_sequence,
                pack=orders.pack,
                posture_order=orders.posture,
            )
        )
        self._posture = walk.posture
        targets = JointTargets(
            stamp_ns=sensed.stamp_ns,
            position=walk.joint_position,
            torque_limit=self._torque_limit,
            torque_on=permission.torque_on,
        )
        return WalkTick(
            stamp_ns=sensed.stamp_ns,
            targets=self._gate.pass_on(targets, sensed.joint_position, self._dt),
            state=state,
            verdict=verdict,
            permission=permission,
            velocity_command=velocity,
            walk=walk,
            report=report,
            follower=follower,
            route=route,
        )

    def _navigate(self, sensed: Proprioception) -> NavigationState:
        if self._propagator is None:
            self._propagator = StatePropagator(self._robot.imu, initial_pose(self._robot, sensed.joint_position))
        state = self._propagator.propagate(sensed.imu)
        if not np.isfinite(state.age):
            # Inertia alone does not see the robot stand up: until pictures do, the legs say how high it is.
            state = replace(state, world_from_body=self._standing_on_feet(state.world_from_body, sensed))
        return state

    def _standing_on_feet(self, world_from_body: Pose, sensed: Proprioception) -> Pose:
        """The pose with its height such that the lowest foot touches the ground at z = 0."""
        feet = feet_in_body(self._robot, sensed.joint_position) @ world_from_body.rotation.T
        x, y, _ = world_from_body.position
        height = self._robot.foot_radius - float(feet[:, 2].min())
        return Pose(rotation=world_from_body.rotation, position=np.array([x, y, height]))

    def _velocity(
        self, state: NavigationState, orders: Orders, permission: Permission
    ) -> tuple[NDArray[np.float64], FollowerOutput | None, RouteTick | None]:
        """Body velocity (vx, vy, turn) from the mission or the stick, and what the followers said."""
        if not permission.walk:
            return np.zeros(3), None, None
        if orders.teleop_velocity is not None:
            return orders.teleop_velocity, None, None
        if not (orders.mission_active and orders.waypoints):
            return np.zeros(3), None, None
        if orders.find_way:
            route = self._route_follower.step(
                state.world_from_body,
                orders.waypoints,
                orders.mission_serial,
                self._route,
                state.stamp_ns,
                orders.areas,
            )
            return route.follower.velocity, replace(route.follower, index=route.follower.index + 1), route
        if orders.mission_serial != self._path_serial or self._path[1:] != orders.waypoints:
            self._begin_path(state, orders)
        follower = self._follower.step(state.world_from_body, self._path, self._path_index)
        self._path_index = follower.index
        return follower.velocity, follower, None

    def _begin_path(self, state: NavigationState, orders: Orders) -> None:
        """The path begins where the robot stands; waypoints changed under way keep what is behind it."""
        if orders.mission_serial != self._path_serial:
            x, y, _ = state.world_from_body.position
            self._path = (Waypoint(x=float(x), y=float(y)), *orders.waypoints)
            self._path_index = 1
        else:
            self._path = (self._path[0], *orders.waypoints)
        self._path_serial = orders.mission_serial

    def _parameters(self, stamp_ns: int) -> AdaptationReport:
        """The vision loop's parameters, or the safe gait when they are missing or old, under the overrides."""
        report = self._report
        if report is None or (stamp_ns - report.stamp_ns) * 1e-9 > REPORT_LIFETIME:
            report = self._fallback.unknown(stamp_ns, self._dt)
        return self._overrides.apply(report, stamp_ns)


def initial_pose(robot: RobotDescription, joint_position: NDArray[np.float64]) -> Pose:
    """world_from_body at start: over the origin, as high as the lowest foot says, heading along x."""
    lowest = float(feet_in_body(robot, joint_position)[:, 2].min()) - robot.foot_radius
    return Pose(rotation=np.eye(3), position=np.array([0.0, 0.0, -lowest]))
