"""The list of robots as the page and the read-only API show it."""

from __future__ import annotations

from functools import lru_cache

import msgspec

from weaver_console.link import Link
from weaver_console.plain import to_json
from weaver_console.robot_record import RobotRecord
from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.config.command import CommandLimits
from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.robots.counterpart import counterpart_of

_UNITS = {"virtual_stiffness": "N/m", "stride_frequency": "Hz", "stride_height": "m"}


def describe(record: RobotRecord, now_ns: int) -> dict[str, object]:
    """One robot for the list; see docs/console_protocol.md."""
    presence, robot, mode, lease = record.presence, record.description, record.mode, record.lease
    age = record.heartbeat_age(now_ns)
    return {
        "id": record.robot_id,
        "session": record.session,
        "kind": presence.kind if presence else "",
        "robot": presence.robot if presence else "",
        "world": presence.world if presence else "",
        "alive": record.alive,
        "heartbeat_age_s": None if age is None else round(age, 3),
        "processes": sorted(record.processes),
        "mode": mode.mode if mode else "",
        "stopped": mode.stopped if mode else False,
        "holder": lease.holder if lease else "",
        "leg_names": list(robot.leg_names) if robot else [],
        "joint_names": list(robot.joint_names) if robot else [],
        "joint_limits": robot.joint_limits.tolist() * robot.leg_count if robot else [],
        "gaits": list(robot.gaits) if robot else [],
        "parameters": _parameters(robot.adaptation if robot else AdaptationConfig()),
        "presets": list((robot.adaptation if robot else AdaptationConfig()).presets),
        "motion": _motion(robot) if robot else None,
        "conflict": record.conflict(now_ns),
    }


def _parameters(config: AdaptationConfig) -> dict[str, dict[str, object]]:
    """Bounds and units of what an operator may override, and the polynomials by which the ground sets it."""
    bounds = {name: getattr(config, name) for name in _UNITS}
    constant, of_step, of_roughness = config.height_polynomial
    curves: dict[str, dict[str, object]] = {
        "virtual_stiffness": {"roughness": config.stiffness_polynomial, "step_height": ()},
        "stride_frequency": {"roughness": config.frequency_polynomial, "step_height": ()},
        "stride_height": {"roughness": (constant, of_roughness), "step_height": (of_step,)},
    }
    return {
        name: {"lower": b.lower, "upper": b.upper, "unit": _UNITS[name], **curves[name]} for name, b in bounds.items()
    }


def _motion(robot: RobotDescription) -> dict[str, object]:
    """What may be asked of body and legs beyond walking, in m, rad, m/s and rad/s."""
    posing, limits = robot.locomotion.posing, CommandLimits()
    return {
        "largest_pose": [*posing.largest_position, *posing.largest_rotation],
        "largest_tip": robot.locomotion.manipulation.largest_tip,
        "largest_cruise": [limits.teleop_forward, limits.teleop_left, limits.teleop_turn],
        "cruise_seconds": limits.cruise_seconds,
        "postures": _postures(robot.name) if robot.posture else [],
        "packs": robot.packed_joints is not None,
        "half_width": robot.half_width,
    }


@lru_cache
def _postures(name: str) -> list[str]:
    """Into which the legs of a robot of the catalogue can go."""
    robot = load_robot(name)
    other = counterpart_of(robot)
    return [one.posture.name for one in (robot, other) if one is not None and one.posture is not None]


class Roster:
    """The encoded list and a number that grows with every change that matters."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self.version = 0
        self.json = to_json({"type": "robots", "robots": []})
        self._compared: bytes | None = None

    def refresh(self) -> None:
        """Look again; called about ten times a second."""
        now_ns = self._link.clock.now_ns()
        with self._link.lock:
            robots = [describe(record, now_ns) for record in self._link.robots()]
        compared = msgspec.json.encode([{**robot, "heartbeat_age_s": None} for robot in robots])
        if compared != self._compared:
            self._compared = compared
            self.json = to_json({"type": "robots", "robots": robots})
            self.version += 1
