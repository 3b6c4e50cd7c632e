"""The robots OpenSHC 0.5.11 is recorded with: `default`, `bullet_insectoid` and `bullet_mammalian`.

Numbers are the packages' shipped parameters (facts, not code), quarter turns rounded as there.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from robot_agent.locomotion.openshc.configuration import Configuration
from robot_agent.locomotion.openshc.reading import configuration_of
from robot_agent.locomotion.openshc.shipped_gaits import BULLET_POSES, DEFAULT_POSES, GAITS, auto_pose, gait
from weaver_shared.errors import ConfigurationError

LEGS = ("AR", "BR", "CR", "CL", "BL", "AL")
RIGHT = LEGS[:3]
ROW = {"AR": 0, "BR": 1, "CR": 2, "CL": 2, "BL": 1, "AL": 0}
QUARTER = 1.571

ROBOTS = ("default", "bullet_insectoid", "bullet_mammalian")


@cache
def shipped(name: str) -> Configuration:
    """Raises ConfigurationError that names the robots OpenSHC is reproduced for."""
    builders = {"default": _default, "bullet_insectoid": _insectoid, "bullet_mammalian": _mammalian}
    if name not in builders:
        raise ConfigurationError(f"robot {name!r} is not one of OpenSHC's; known are {', '.join(ROBOTS)}")
    return builders[name]()


def _default() -> Configuration:
    joints = {
        "coxa": _joint(-0.55, 0.55, [-1.571], 0.0),
        "femur": _joint(-1.5, 1.5, [1.9], 0.785),
        "tibia": _joint(-2.355, -0.1, [1.2], -1.138),
    }
    hip_angles = (0.523, QUARTER, 2.617)
    per_leg: dict[str, Any] = {}
    for leg in LEGS:
        side = _side(leg)
        links = {
            "base": _link(side * hip_angles[ROW[leg]], 0.0, 0.05, 0.0),
            "coxa": _link(0.0, 0.0, 0.05, QUARTER),
            "femur": _link(0.0, 0.0, 0.05, 0.0),
            "tibia": _link(-0.1, 0.0, 0.1, 0.0),
        }
        per_leg |= _keys(leg, joints, links, [(0.13, 0.075), (0.0, 0.15), (-0.13, 0.075)])
    own = {
        "syropod_type": "default",
        "time_delta": 0.02,
        "joint_id": ["coxa", "femur", "tibia"],
        "gait_type": "tripod_gait",
        "body_clearance": 0.1,
        "step_frequency": _adjustable(1.0, 0.001, 2.0, 0.1),
        "swing_height": _adjustable(0.02, 0.01, 0.05, 0.005),
        "angular_cruise_velocity": 0.5,
        "time_to_start": 6.0,
        "rotation_pid_gains": {"p": 0.0, "i": 0.0, "d": 0.0},
        "max_translation": {"x": 0.025, "y": 0.025, "z": 0.025},
        "max_rotation": {"roll": 0.25, "pitch": 0.25, "yaw": 0.25},
        "use_joint_effort": False,
        "integrator_step_time": 0.5,
        "virtual_mass": _adjustable(10.0, 1.0, 100.0, 5.0),
        "virtual_stiffness": _adjustable(12.0, 1.0, 50.0, 5.0),
        "virtual_damping_ratio": _adjustable(0.8, 0.1, 10.0, 0.05),
        "force_gain": _adjustable(0.1, 0.001, 100.0, 1.0),
        "load_stiffness_scaler": 5.0,
        "swing_stiffness_scaler": 0.1,
    }
    names = ("wave_gait", "amble_gait", "ripple_gait", "tripod_gait")
    return _whole(own | per_leg, names, DEFAULT_POSES)


def _insectoid() -> Configuration:
    per_leg: dict[str, Any] = {}
    for leg in LEGS:
        joints = {
            "coxa": _coxa(leg),
            "coxat": _joint(-2.355, 2.355, _sided(leg, [0.0, 2.39]), 0.0),
            "femur": _joint(-1.571, 1.45, [0.278, 0.278], 1.088),
            "tibia": _joint(-2.355, 0.001, [1.39, 1.39], -0.765),
            "tarsus": _joint(-2.355, 2.355, [1.532, 1.532], -1.212),
        }
        links = _bullet_links(leg, base_d=0.051, base_r=(0.25, 0.0, -0.25), coxa_r=-0.047, coxat_d=-0.06)
        per_leg |= _keys(leg, joints, links, [(0.3, 0.35), (-0.02, 0.35), (-0.35, 0.35)])
    return _bullet({"gait_type": "tripod_gait", "swing_height": _adjustable(0.09, 0.01, 0.18, 0.01)} | per_leg)


def _mammalian() -> Configuration:
    per_leg: dict[str, Any] = {}
    for leg in LEGS:
        turn = (-3.142, 0.0) if leg in RIGHT else (0.0, 3.142)
        joints = {
            "coxa": _coxa(leg),
            "coxat": _joint(*turn, _sided(leg, [0.0, 2.39]), 0.0),
            "femur": _joint(-2.355, 2.355, [0.278, 0.278], 1.088),
            "tibia": _joint(-2.355, 0.001, [1.39, 1.39], -0.765),
            "tarsus": _joint(-3.142 if leg in {"AR", "AL"} else -2.355, 0.001, [1.532, 1.532], -1.212),
        }
        links = _bullet_links(leg, base_d=0.055, base_r=(0.268, 0.018, -0.232), coxa_r=0.0, coxat_d=-0.058)
        per_leg |= _keys(leg, joints, links, [(0.325, 0.225), (0.0, 0.375), (-0.325, 0.225)])
    own = {"gait_type": "bipod_gait", "swing_height": _adjustable(0.07, 0.01, 0.18, 0.01), "ignore_IK_warnings": True}
    return _bullet(own | per_leg)


def _bullet(own: dict[str, Any]) -> Configuration:
    common = {
        "syropod_type": "bullet",
        "time_delta": 0.01,
        "combined_control_interface": False,
        "joint_id": ["coxa", "coxat", "femur", "tibia", "tarsus"],
        "clamp_joint_velocities": False,
        "body_clearance": 0.25,
        "step_frequency": _adjustable(1.1, 0.001, 5.0, 0.1),
        "angular_cruise_velocity": 0.0,
        "time_to_start": 5.0,
        "rotation_pid_gains": {"p": 1.0, "i": 0.01, "d": -0.05},
        "max_translation": {"x": 0.5, "y": 0.1, "z": 0.2},
        "max_rotation": {"roll": 0.5, "pitch": 0.5, "yaw": 0.08},
        "use_joint_effort": True,
        "integrator_step_time": 0.06,
        "virtual_mass": _adjustable(6.0, 1.0, 100.0, 5.0),
        "virtual_stiffness": _adjustable(20.0, 1.0, 50.0, 5.0),
        "virtual_damping_ratio": _adjustable(2.5, 0.1, 100.0, 0.05),
        "force_gain": _adjustable(0.5, 0.001, 100.0, 1.0),
        "load_stiffness_scaler": 2.0,
        "swing_stiffness_scaler": 0.01,
        "console_verbosity": "debug",
    }
    return _whole(common | own, tuple(GAITS), BULLET_POSES)


def _whole(own: dict[str, Any], gaits: tuple[str, ...], poses: dict[str, Any]) -> Configuration:
    common = {
        "leg_id": list(LEGS),
        "link_id": ["base", *own["joint_id"]],
        "swing_width": _adjustable(0.0, -0.3, 0.3, 0.01),
        "step_depth": _adjustable(0.0, 0.0, 0.0, 0.0),
        "stance_span_modifier": _adjustable(0.0, -1.0, 1.0, 0.1),
        "linear_cruise_velocity": {"x": 1.0, "y": 0.0},
        "max_translation_velocity": 0.05,
        "max_rotation_velocity": 0.2,
    }
    return configuration_of(
        {
            "parameters": common | own,
            "gait_parameters": {name: gait(name) for name in gaits},
            "auto_pose_parameters": {name: auto_pose(name, amplitudes) for name, amplitudes in poses.items()},
        }
    )


def _bullet_links(
    leg: str, *, base_d: float, base_r: tuple[float, float, float], coxa_r: float, coxat_d: float
) -> dict[str, Any]:
    side = -_side(leg)
    return {
        "base": _link(0.0, base_d, base_r[ROW[leg]], side * QUARTER),
        "coxa": _link(0.0, 0.195, coxa_r, -side * QUARTER),
        "coxat": _link(-side * QUARTER, coxat_d, 0.035, QUARTER),
        "femur": _link(0.0, 0.0, 0.114, 0.0),
        "tibia": _link(0.0, 0.0, 0.114, 0.0),
        "tarsus": _link(0.0, 0.0, 0.173, 0.0),
    }


def _coxa(leg: str) -> dict[str, Any]:
    turn = QUARTER if leg == "AR" else 1.57
    return _joint(-turn, turn, _sided(leg, [1.493, 1.493]), 0.0)


def _side(leg: str) -> float:
    return -1.0 if leg in RIGHT else 1.0


def _sided(leg: str, angles: list[float]) -> list[float]:
    return [_side(leg) * angle + 0.0 for angle in angles]


def _keys(leg: str, joints: dict[str, Any], links: dict[str, Any], stance: list[tuple[float, float]]) -> dict[str, Any]:
    x, y = stance[ROW[leg]]
    keys = {f"{leg}_{name}_joint_parameters": values for name, values in joints.items()}
    keys |= {f"{leg}_{name}_link_parameters": values for name, values in links.items()}
    return keys | {f"{leg}_stance_position": {"x": x, "y": _side(leg) * y}}


def _joint(lower: float, upper: float, packed: list[float], unpacked: float) -> dict[str, Any]:
    postures = {"packed": packed[0]} if len(packed) == 1 else {f"packed_{k}": angle for k, angle in enumerate(packed)}
    return {"min": lower, "max": upper, "offset": 0.0, "unpacked": unpacked, "max_vel": 5.0, **postures}


def _link(theta: float, d: float, r: float, alpha: float) -> dict[str, float]:
    return {"theta": theta, "d": d, "r": r, "alpha": alpha}


def _adjustable(default: float, lower: float, upper: float, step: float) -> dict[str, float]:
    return {"default": default, "min": lower, "max": upper, "step": step}
