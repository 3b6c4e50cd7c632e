"""Gaits and automatic poses shipped with OpenSHC and with Bullet (facts 3.3, 3.11)."""

from __future__ import annotations

from typing import Any

LEGS = ("AR", "BR", "CR", "CL", "BL", "AL")
QUADRUPED = ("AR", "CR", "CL", "AL")

GAITS: dict[str, tuple[int, int, int, tuple[int, ...]]] = {
    "wave_gait": (10, 2, 2, (2, 3, 4, 1, 0, 5)),
    "amble_gait": (2, 1, 1, (1, 2, 0, 1, 2, 0)),
    "ripple_gait": (4, 2, 1, (2, 0, 4, 1, 3, 5)),
    "tripod_gait": (2, 2, 2, (0, 1, 0, 1, 0, 1)),
    "bipod_gait": (2, 4, 2, (0, 1, 2, 0, 1, 2)),
}
"""Stance, swing and offset in parts of a stride, and how often each leg takes the offset, AR BR CR CL BL AL."""

CYCLES: dict[str, tuple[int, tuple[int, ...], tuple[int, ...]]] = {
    "wave_gait_pose": (12, (1, 3, 5, 7, 9, 11), (1, 11, 9, 3, 5, 7)),
    "amble_gait_pose": (3, (0, 1, 2), (0, 2, 1, 0, 2, 1)),
    "ripple_gait_pose": (6, (0, 1, 2, 3, 4, 5), (0, 2, 4, 1, 5, 3)),
    "tripod_gait_pose": (4, (1, 3), (1, 3, 1, 3, 1, 3)),
    "bipod_gait_pose": (6, (1, 3, 5), (1, 5, 3, 1, 5, 3)),
    "quad_wave_gait_pose": (16, (5, 13, 9, 1), (3, 15, 11, 7)),
}
"""Length of the cycle, where its poses start, and where each leg's negation starts."""

POSE_LENGTH = {"amble_gait_pose": 1, "bipod_gait_pose": 4, "quad_wave_gait_pose": 6}
NEGATION_LENGTH = {"amble_gait_pose": 1, "bipod_gait_pose": 4}
USUAL_LENGTH = 2

NONE = (0.0,) * 6

DEFAULT_POSES: dict[str, dict[str, Any]] = {
    "wave_gait_pose": {
        "roll": (-0.015, 0.015, 0.015, 0.015, -0.015, -0.015),
        "pitch": (0.02, -0.02, 0.0, 0.02, -0.02, 0.0),
    },
    "amble_gait_pose": {},
    "ripple_gait_pose": {
        "roll": (-0.015, 0.015, -0.015, 0.015, -0.015, 0.015),
        "pitch": (-0.02, 0.02, 0.0, -0.02, 0.02, 0.0),
    },
    "tripod_gait_pose": {"roll": (-0.015, 0.015), "z": (0.02, 0.02)},
}
"""Amplitudes that are not zero: rad and m."""

BULLET_POSES: dict[str, dict[str, Any]] = {
    "wave_gait_pose": {"roll": (-0.1, 0.1, 0.1, 0.1, -0.1, -0.1), "pitch": (-0.1, 0.1, 0.0, -0.1, 0.1, 0.0)},
    "amble_gait_pose": {},
    "ripple_gait_pose": {
        "roll": (-0.05, 0.05, -0.05, 0.05, -0.05, 0.05),
        "pitch": (-0.05, 0.05, 0.0, -0.05, 0.05, 0.0),
        "ratio": 0.1,
    },
    "tripod_gait_pose": {"roll": (-0.05, 0.05), "z": (0.01, 0.01)},
    "bipod_gait_pose": {"z": (0.075, 0.075, 0.075), "ratio": 0.5},
    "quad_wave_gait_pose": {
        "x": (-0.03, 0.03, 0.03, -0.03),
        "y": (-0.03, 0.03, -0.03, 0.03),
        "z": (0.008, 0.008, 0.008, 0.008),
        "roll": (0.03, -0.03, 0.03, -0.03),
        "pitch": (-0.04, 0.04, 0.04, -0.04),
        "ratio": None,
    },
}


def gait(name: str) -> dict[str, Any]:
    stance, swing, offset, multipliers = GAITS[name]
    return {
        "stance_phase": stance,
        "swing_phase": swing,
        "phase_offset": offset,
        "offset_multiplier": dict(zip(LEGS, multipliers, strict=True)),
    }


def auto_pose(name: str, amplitudes: dict[str, Any]) -> dict[str, Any]:
    length, starts, negations = CYCLES[name]
    legs = QUADRUPED if name.startswith("quad") else LEGS
    lasts, negates = POSE_LENGTH.get(name, USUAL_LENGTH), NEGATION_LENGTH.get(name, USUAL_LENGTH)
    result: dict[str, Any] = {
        "pose_frequency": -1.0,
        "pose_phase_length": length,
        "pose_phase_starts": list(starts),
        "pose_phase_ends": [(start + lasts) % length for start in starts],
        "pose_negation_phase_starts": dict(zip(legs, negations, strict=True)),
        "pose_negation_phase_ends": {
            leg: (start + negates) % length for leg, start in zip(legs, negations, strict=True)
        },
    }
    for axis in ("x", "y", "z", "gravity", "roll", "pitch", "yaw"):
        result[f"{axis}_amplitudes"] = list(amplitudes.get(axis, NONE[: len(starts)]))
    ratio = amplitudes.get("ratio", 0.0)
    if ratio is not None:
        result["negation_transition_ratio"] = dict.fromkeys(legs, ratio)
    return result
