"""A recording as a Rerun file (.rrd): body, feet, ground and pictures in space, everything else as curves and text."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from numpy.typing import NDArray

from robot_agent.recording.playback import Playback
from weaver_shared.messages import (
    AdaptationReport,
    CameraPicture,
    MapTile,
    MissionState,
    ModeState,
    OdometryEstimate,
    PowerState,
    RobotState,
    Severity,
    TruthState,
)
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.forward_kinematics import joint_frames_in_body

Array = NDArray[np.float64]

TIMELINE = "robot"
"""Seconds of the recorded robot's clock."""

FORCE_SCALE = 0.004  # m of arrow per N
UNKNOWN_MM = -32768
LEVELS = {Severity.INFO: "INFO", Severity.WARNING: "WARN", Severity.ERROR: "ERROR"}
LOW, HIGH = np.array([51.0, 80.0, 122.0]), np.array([217.0, 207.0, 150.0])
"""Colours of the lowest and the highest ground of a tile's metre."""


class RerunFile:
    """Writes one file; `close` completes it."""

    def __init__(self, path: Path, playback: Playback) -> None:
        about = playback.recording.about
        self._stream = rr.RecordingStream("weaver", recording_id=playback.recording.path.stem, send_properties=False)
        self._stream.save(path, default_blueprint=_blueprint())
        self._robot = playback.recording.robot
        self._mode = ""
        self._stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._stream.log("about", rr.TextDocument(f"{about.robot_id}, {about.started}, {about.software}"), static=True)

    def write_all(self, playback: Playback) -> int:
        """Everything in the recording; returns the number of messages. Raises InputError where it is damaged."""
        count = 0
        for said in playback.between(playback.first_ns - 1, playback.last_ns):
            count += 1
            self._at(said.time_ns)
            self._write(said.message)
        for mark in playback.marks():
            self._at(playback.first_ns + round(mark.seconds * 1e9))
            self._stream.log("events", rr.TextLog(f"{mark.source}: {mark.text}", level=LEVELS[mark.severity]))
        return count

    def close(self) -> None:
        self._stream.disconnect()

    def _at(self, stamp_ns: int) -> None:
        self._stream.set_time(TIMELINE, duration=stamp_ns * 1e-9)

    def _write(self, message: Any) -> None:
        match message:
            case RobotState():
                self._write_state(message)
            case TruthState():
                self._stream.log("world/truth", rr.Points3D([message.position_in_world], radii=0.02))
            case OdometryEstimate():
                self._curves("odometry/sigma", np.sqrt(np.abs(np.diag(message.covariance)[3:])))
            case MapTile():
                self._write_tile(message)
            case CameraPicture():
                picture = rr.EncodedImage(contents=message.jpeg, media_type="image/jpeg")
                self._stream.log(f"cameras/{message.name}", picture)
            case AdaptationReport():
                self._write_adaptation(message)
            case PowerState():
                self._curves("power/supply", [message.supply_power])
                self._curves("power/cost_of_transport", [message.cost_of_transport])
            case MissionState():
                self._write_mission(message)
            case ModeState() if message.mode != self._mode:
                self._mode = message.mode
                self._stream.log("events", rr.TextLog(f"state {message.mode}"))

    def _write_state(self, state: RobotState) -> None:
        x, y, z, w = (*state.wxyz[1:], state.wxyz[0])
        place = rr.Transform3D(translation=state.position_in_world, quaternion=rr.Quaternion(xyzw=[x, y, z, w]))
        self._stream.log("world/body", place)
        self._stream.log("world/body/links", rr.LineStrips3D(_links(self._robot, state.joint_position), radii=0.01))
        colours = np.where(state.foot_contact[:, None], [52, 199, 129], [236, 236, 240])
        self._stream.log("world/body/feet", rr.Points3D(state.foot_in_body, colors=colours, radii=0.018))
        forces = np.zeros((len(state.foot_force), 3))
        forces[:, 2] = FORCE_SCALE * np.nan_to_num(state.foot_force) * state.foot_contact
        self._stream.log("world/body/forces", rr.Arrows3D(origins=state.foot_in_body, vectors=forces))
        self._curves("joints/position", state.joint_position)
        self._curves("joints/torque", state.joint_torque)
        self._curves("stability/margin", [state.stability_margin])
        self._curves("velocity/asked", state.velocity_command)
        self._curves("velocity/estimated", state.velocity_in_body)

    def _write_adaptation(self, report: AdaptationReport) -> None:
        self._curves("ground/roughness", [report.roughness])
        self._curves("ground/step_height", [report.step_height])
        for name in ("virtual_stiffness", "stride_frequency", "stride_height"):
            pair = [getattr(report.applied, name), getattr(report.desired, name)]
            self._curves(f"gait/{name}", pair)

    def _write_mission(self, mission: MissionState) -> None:
        self._curves("mission/cross_track_error", [mission.cross_track_error])
        places = [[waypoint.x, waypoint.y, 0.0] for waypoint in mission.waypoints]
        self._stream.log("world/mission", rr.LineStrips3D([places] if len(places) > 1 else []))

    def _write_tile(self, tile: MapTile) -> None:
        mesh = _tile_mesh(tile)
        self._stream.log(f"world/ground/{tile.i}_{tile.j}", mesh if mesh is not None else rr.Clear(recursive=False))

    def _curves(self, path: str, values: Any) -> None:
        """One entity for all curves of a kind: one for each takes five times the time."""
        self._stream.log(path, rr.Scalars(np.asarray(values, dtype=np.float64)))


def _links(robot: RobotDescription, joints: Array) -> list[Array]:
    """Each leg as a line through its joints, in body."""
    return [leg[:, :3, 3] for leg in joint_frames_in_body(robot, joints)]


def _tile_mesh(tile: MapTile) -> rr.Mesh3D | None:
    """The known cells as a coloured height field; None without any."""
    size, known = tile.size, tile.elevation_mm != UNKNOWN_MM
    number = np.arange(size * size).reshape(size, size)
    whole = known[:-1, :-1] & known[1:, :-1] & known[:-1, 1:] & known[1:, 1:]
    a, b, c, d = (part[whole] for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    if not a.size:
        return None
    rows, columns = np.indices((size, size))
    height = np.where(known, tile.elevation_mm, 0) * 1e-3
    x, y = (tile.i * size + rows + 0.5) * tile.cell, (tile.j * size + columns + 0.5) * tile.cell
    share = np.clip(height + 0.5, 0.0, 1.0)[..., None]
    colours = (LOW * (1 - share) + HIGH * share).reshape(-1, 3).astype(np.uint8)
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    places = np.stack([x, y, height], axis=-1).reshape(-1, 3)
    return rr.Mesh3D(vertex_positions=places, triangle_indices=triangles, vertex_colors=colours)


def _blueprint() -> rrb.Blueprint:
    curves = ("gait", "ground", "stability", "power", "mission", "joints/torque")
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(
                rrb.Spatial3DView(origin="world", name="World"),
                rrb.Horizontal(rrb.Spatial2DView(origin="cameras", name="Cameras"), rrb.TextLogView(origin="events")),
                row_shares=[2, 1],
            ),
            rrb.Vertical(*(rrb.TimeSeriesView(origin=origin, name=origin.capitalize()) for origin in curves)),
            column_shares=[3, 2],
        ),
        collapse_panels=True,
    )
