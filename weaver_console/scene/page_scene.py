"""The three-dimensional view of one page: its robot, its layer, its draft, its clicks.

Each page has a viser server of its own (5 ms to start, one thread), so that a click is known to be this page's and
nothing one operator chooses shows up at another's.
"""

from __future__ import annotations

import contextlib
import io
import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from weaver_console.robot_record import RobotRecord
from weaver_console.scene.area_figure import AreaFigure
from weaver_console.scene.contours import ContourFigure
from weaver_console.scene.ghost_figure import GhostFigure
from weaver_console.scene.ground import Ground
from weaver_console.scene.layers import Legend
from weaver_console.scene.measure_figure import MeasureFigure
from weaver_console.scene.mission_figure import TOP, Course, MissionFigure
from weaver_console.scene.motion_figure import MotionFigure
from weaver_console.scene.posture import Posture, Postures
from weaver_console.scene.robot_figure import RobotFigure
from weaver_console.scene.terrain_figure import READING_PICTURES, TILES_AN_UPDATE, MeshStore, TerrainFigure
from weaver_shared.bus import free_port
from weaver_shared.config.navigation import PathFollowerConfig
from weaver_shared.messages import CameraPicture, OdometryEstimate, PowerState, RobotState, TruthState, Waypoint
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import Pose

logger = logging.getLogger(__name__)

Array = NDArray[np.float64]

LINES_PERIOD_NS = 120_000_000
"""Polygon, forces and look-ahead are drawn 8 times a second: in the browser lines cost more than all the rest."""

THRIFTY_PERIOD, THRIFTY_TILES, THRIFTY_READING = 3, 4, 15
"""Updates between new ground, tiles of it, and updates until it has been read, in a browser without a graphics card:
each tile costs it dear."""

FOLLOWER = PathFollowerConfig()
CAMERA_FROM_ROBOT = np.array([-1.25, -0.85, 0.75])
LOOK_FROM_ROBOT = np.array([0.35, 0.0, -0.05])
STILL = 3e-4
"""Changes of pose (m, and of its quaternion) and joints (rad) below this are not drawn: the browser then rests too."""

FOLLOW_STEP = 0.02

PICTURE_PERIOD_NS = 400_000_000
PICTURE_TIMEOUT = 15.0
"""s; a browser without a graphics card takes a while for one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wishes:
    """What the page wants to see."""

    layer: str = "elevation"
    draft: tuple[Waypoint, ...] = ()
    selected: int | None = None
    follow: bool = False
    truth: bool = True
    frusta: bool = True
    trail: bool = True
    contours: bool = False
    torques: bool = False
    measure: tuple[Waypoint, ...] = ()
    areas: tuple[tuple[Waypoint, ...], ...] = ()


@dataclass(slots=True)
class _Shown:
    """Everything drawn for one robot; thrown away as a whole when another is selected."""

    record_key: tuple[str, int]
    robot: RobotDescription | None
    root: Any
    figure: RobotFigure | None
    motion: MotionFigure | None
    ghost: GhostFigure | None
    terrain: TerrainFigure
    mission: MissionFigure
    contours: ContourFigure
    measure: MeasureFigure
    areas: AreaFigure
    frusta: dict[str, Any] = field(default_factory=dict)
    followed: Array | None = None
    drawn: RobotState | None = None
    posture: Posture | None = None  # of the same state
    drawable: bool = False  # whether the newest state fits the robot
    versions: dict[str, int] = field(default_factory=dict)


class PageScene:
    """`on_pick` is called, in a thread of viser's, with a point (3,) in world or None for a click beside the ground;
    `on_drag` likewise with a waypoint's number, where it is held over the ground, and whether it was let go."""

    def __init__(
        self,
        store: MeshStore,
        *,
        on_pick: Callable[[Array | None], None],
        on_drag: Callable[[int, Array, bool], None],
        on_legend: Callable[[Legend], None],
        postures: Postures | None = None,
    ) -> None:
        self._store = store
        self._postures = postures or Postures()
        self._on_drag = on_drag
        self._held: Array | None = None
        self._on_pick = on_pick
        self._on_legend = on_legend
        self._wishes = Wishes()
        self._lock = threading.Lock()
        self._shown: _Shown | None = None
        self._ground: Ground | None = None
        with contextlib.redirect_stdout(io.StringIO()):  # viser prints its address, which is not for people
            self._server = viser.ViserServer(host="127.0.0.1", port=free_port(), verbose=False)
        self.port: int = self._server.get_port()
        self._updates = 0
        self.thrifty = False  # the browser draws without a graphics card
        self._set_stage()

    @property
    def watched(self) -> bool:
        return bool(self._server.get_clients())

    def wish(self, **changes: Any) -> None:
        with self._lock:
            self._wishes = replace(self._wishes, **changes)

    def propose(self, draft: Sequence[Waypoint], selected: int | None) -> None:
        self.wish(draft=tuple(draft), selected=selected)

    def close(self) -> None:
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()

    def update(self, record: RobotRecord | None, *, ground_due: bool = True) -> None:
        """Draw what is new of the selected robot; called some 15 times a second, by one thread.

        New ground is drawn only when it is due: for all pages in the same call, since they share its meshes.
        """
        with self._server.atomic():
            self._update(record, ground_due)

    def _update(self, record: RobotRecord | None, ground_due: bool) -> None:
        if record is None:
            self._drop()
            return
        shown = self._for(record)
        with self._lock:
            wishes = self._wishes
        self._ground = record.ground
        self._updates += 1
        hurried = wishes.layer != shown.terrain.legend.layer or (shown.terrain.unfinished and not self.thrifty)
        due = self._updates % THRIFTY_PERIOD == 0 if self.thrifty else ground_due
        most, patience = (THRIFTY_TILES, THRIFTY_READING) if self.thrifty else (TILES_AN_UPDATE, READING_PICTURES)
        shown.terrain.settle()
        if (hurried or due) and shown.terrain.update(record.ground, wishes.layer, most=most, patience=patience):
            self._on_legend(shown.terrain.legend)
        self._update_robot(shown, record, wishes)
        state = record.newest("tele/state", RobotState)
        shown.contours.update(record.ground, wishes.contours)
        shown.measure.update(record.ground, wishes.measure)
        shown.areas.update(record.ground, wishes.areas)
        mission = record.mission
        shown.mission.update(
            record.ground,
            None if state is None else state.position_in_world,
            Course.sent(mission.waypoints, mission.next_waypoint) if mission is not None else Course.sent((), 0),
            Course.draft(wishes.draft, wishes.selected),
        )
        if wishes.follow and state is not None:
            self._follow(shown, state.position_in_world)
        else:
            shown.followed = None

    @property
    def legend(self) -> Legend | None:
        return self._shown.terrain.legend if self._shown is not None else None

    def _update_robot(self, shown: _Shown, record: RobotRecord, wishes: Wishes) -> None:
        state, robot = record.newest("tele/state", RobotState), shown.robot
        if state is None or robot is None or shown.figure is None or shown.motion is None:
            return
        new = _new(shown, record, "tele/state")
        if new:
            shown.drawable = _drawable(state, robot)
        if not shown.drawable:
            return
        if shown.drawn is None:
            self._place_camera(state.position_in_world)
        if new and _moved(shown.drawn, state):
            shown.drawn = state
            posture = shown.posture = self._postures.of(robot, state)
            shown.figure.update(posture)
            power = record.newest("tele/power", PowerState)
            shown.motion.leave_trail(state, power.cost_of_transport if power is not None else float("nan"))
            if _changed(shown, "lines", state.stamp_ns // LINES_PERIOD_NS):
                shown.motion.update(posture)
                shown.motion.lookahead(state, record.mission)
        odometry = record.newest("tele/odometry", OdometryEstimate)
        if odometry is not None and _new(shown, record, "tele/odometry"):
            shown.motion.covariance(odometry)
        if shown.ghost is not None and shown.posture is not None:
            truth = record.newest("truth/state", TruthState) if wishes.truth else None
            shown.ghost.update(_finite(truth), shown.posture)
        shown.figure.torque(state.joint_torque if wishes.torques else None)
        _show_pictures(shown, record, wishes.frusta)
        if _changed(shown, "trail", int(wishes.trail)):
            shown.motion.show_trail(wishes.trail)

    def _for(self, record: RobotRecord) -> _Shown:
        key = (record.robot_id, record.generation)
        shown = self._shown
        if shown is not None and shown.record_key == key and shown.robot is record.description:
            return shown
        self._drop()
        scene, robot = self._server.scene, record.description
        root = scene.add_frame("/world", show_axes=False)
        figure = RobotFigure(scene, "/world/robot", robot) if robot is not None else None
        self._shown = _Shown(
            record_key=key,
            robot=robot,
            root=root,
            figure=figure,
            motion=MotionFigure(scene, "/world/motion") if robot is not None else None,
            ghost=GhostFigure(scene, "/world/truth", robot) if robot is not None else None,
            terrain=TerrainFigure(scene, "/world/terrain", self._store),
            mission=MissionFigure(
                scene,
                "/world/mission",
                passing_radius=FOLLOWER.acceptance_radius,
                goal_radius=FOLLOWER.goal_radius,
                half_width=robot.half_width if robot is not None else 0.0,
                on_drag=self._dragged,
            ),
            contours=ContourFigure(scene, "/world/contours"),
            measure=MeasureFigure(scene, "/world/measure"),
            areas=AreaFigure(scene, "/world/areas"),
        )
        if robot is not None and robot.has_camera:
            self._shown.frusta = _add_frusta(scene, robot)
        return self._shown

    def _drop(self) -> None:
        if self._shown is not None:
            self._shown.root.remove()
            self._shown = None
            self._ground = None

    def _set_stage(self) -> None:
        scene = self._server.scene
        scene.set_up_direction("+z")
        scene.configure_environment_map(None)
        # A low sun shows the relief that viser's own, nearly overhead, hides.
        scene.configure_default_lights(enabled=False)
        scene.add_light_hemisphere("/sky", sky_color=(255, 255, 255), ground_color=(120, 112, 104), intensity=1.5)
        scene.add_light_directional("/sun", intensity=2.4, position=(-3.0, 4.0, 4.0))
        self._server.gui.configure_theme(dark_mode=True, show_share_button=False, show_logo=False)
        scene.add_grid(
            "/grid", width=40.0, height=40.0, cell_size=1.0, section_size=5.0, cell_color=(52, 58, 66),
            section_color=(74, 82, 92), fade_distance=25.0, position=(0.0, 0.0, -0.02),
        )  # fmt: skip
        self._place_camera(np.zeros(3))
        self._server.scene.on_click()(self._clicked)

    def _clicked(self, event: Any) -> None:
        ground = self._ground
        grid = ground.grid() if ground is not None else None
        try:
            point = None
            if grid is not None:
                point = grid.meet(np.array(event.ray_origin), np.array(event.ray_direction))
            self._on_pick(point)
        except Exception:
            logger.exception("a click in the scene was lost")

    async def _dragged(self, event: Any) -> None:
        """A waypoint in hand, in the order of the hand's movements."""
        grid = self._ground.grid() if self._ground is not None else None
        if grid is not None and event.phase != "start":
            # What is in hand is the ball on top: the ground right below it is meant, not that behind it.
            eye, held = np.array(event.client.camera.position) - TOP, np.array(event.end_position) - TOP
            met = grid.meet(eye, held - eye)
            self._held = met if met is not None else self._held
        if self._held is not None and event.phase != "start" and event.instance_index is not None:
            self._on_drag(event.instance_index, self._held, event.phase == "end")
        if event.phase != "update":
            self._held = None

    def picture(self, height: int, width: int) -> NDArray[np.uint8] | None:
        """What the page's view shows now, (height, width, 3) sRGB; None when nobody looks or it takes too long."""
        client = next(iter(self._server.get_clients().values()), None)
        if client is None:
            return None
        try:
            return np.asarray(client.get_render(height, width, timeout=PICTURE_TIMEOUT), dtype=np.uint8)
        except (TimeoutError, RuntimeError):
            return None

    def _place_camera(self, position: Array) -> None:
        """Look at a robot that has just been selected, from behind and above."""
        eye, target = position + CAMERA_FROM_ROBOT, position + LOOK_FROM_ROBOT
        self._server.initial_camera.position = tuple(eye)
        self._server.initial_camera.look_at = tuple(target)
        for client in self._server.get_clients().values():
            client.camera.position, client.camera.look_at = eye, target

    def _follow(self, shown: _Shown, position: Array) -> None:
        """Move the cameras along with the robot; the operator goes on turning and zooming them."""
        if shown.followed is None:
            shown.followed = position
            return
        moved = position - shown.followed
        if float(np.linalg.norm(moved)) < FOLLOW_STEP:
            return
        shown.followed = position
        for client in self._server.get_clients().values():
            client.camera.position = client.camera.position + moved


def _add_frusta(scene: Any, robot: RobotDescription) -> dict[str, Any]:
    """Both eyes', by the names of their pictures."""
    camera = robot.camera
    left = camera.body_from_left
    right = Pose(rotation=left.rotation, position=left.transform(np.array([[camera.baseline, 0.0, 0.0]]))[0])
    return {
        name: scene.add_camera_frustum(
            f"/world/robot/{name}_eye", fov=float(2.0 * np.arctan(0.5 * camera.height / camera.focal_length)),
            aspect=camera.width / camera.height, scale=0.12, thickness=0.004, color=(150, 160, 175), wxyz=pose.wxyz,
            position=pose.position, cast_shadow=False, receive_shadow=False,
        )
        for name, pose in (("left", left), ("right", right))
    }  # fmt: skip


def _show_pictures(shown: _Shown, record: RobotRecord, wanted: bool) -> None:
    for name, frustum in shown.frusta.items():
        frustum.visible = wanted
        picture = record.newest(f"tele/cam/{name}", CameraPicture) if wanted else None
        if picture is not None and _changed(shown, f"eye {name}", picture.stamp_ns // PICTURE_PERIOD_NS):
            # NOTE: viser would take the pixels and make a JPEG of them; the robot has sent one.
            frustum._format, frustum._image_data = "jpeg", picture.jpeg


def _finite(truth: TruthState | None) -> TruthState | None:
    if truth is None or not np.isfinite([*truth.position_in_world, *truth.wxyz]).all():
        return None
    return truth


def _drawable(state: RobotState, robot: RobotDescription) -> bool:
    """Whether the state fits the description and holds numbers: another program's robot may not crash the scene."""
    if state.joint_position.shape != (robot.joint_count,):
        return False
    if state.foot_in_body.shape != (robot.leg_count, 3) or state.foot_contact.shape != (robot.leg_count,):
        return False
    numbers = (state.position_in_world, state.wxyz, state.joint_position, state.foot_in_body)
    return all(bool(np.isfinite(part).all()) for part in numbers) and bool(np.any(state.wxyz))


def _moved(before: RobotState | None, now: RobotState) -> bool:
    if before is None or not np.array_equal(before.foot_contact, now.foot_contact):
        return True
    pairs = (
        (before.position_in_world, now.position_in_world),
        (before.wxyz, now.wxyz),
        (before.joint_position, now.joint_position),
    )
    return any(float(np.abs(a - b).max()) > STILL for a, b in pairs)


def _new(shown: _Shown, record: RobotRecord, key: str) -> bool:
    return _changed(shown, key, record.values[key].version)


def _changed(shown: _Shown, key: str, version: int) -> bool:
    if shown.versions.get(key) == version:
        return False
    shown.versions[key] = version
    return True
