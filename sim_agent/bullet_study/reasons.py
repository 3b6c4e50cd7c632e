"""Where simulation and paper differ, and why, in sentences made of the measured figures."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import numpy as np

from sim_agent.bullet_study import paper
from sim_agent.bullet_study.measure import Measured
from sim_agent.bullet_study.points import PROBED
from sim_agent.bullet_study.tables import bipod_faster, curve, find, label


def reasons(measured: Sequence[Measured]) -> list[str]:
    """One paragraph a difference; those whose points were not measured are left out."""
    found = [
        _idle(measured),
        _walk_air(measured),
        _stance(measured),
        _order(measured),
        _speed(measured),
        _bipod(measured),
    ]
    return [text for text in (*found, *_variants(measured), *SETTING) if text]


SETTING = (
    "Power is what servos draw from the supply through a converter of 93 %; computer and sensors are left out, as in "
    "the paper. Gaits are timed as OpenSHC's (tripod 2:2, bipod 2:4, step frequency over the swing), feet are put down "
    "where and when planned, and nothing slows the robot down for stability.",
    "The paper's Figs. 14 to 16 are pictures; only what its text says of them can be set beside our curves. Stride "
    "lengths are those of its Table II, body and stride heights those of Table III; link masses, stance and supply "
    "voltage are ours (see the descriptions).",
)


def _idle(measured: Sequence[Measured]) -> str:
    standing = [m for m in measured if m.point.scenario == "SA" and not m.point.variant]
    if not standing:
        return ""
    ours = np.array([m.power for m in standing])
    theirs = np.array([paper.TABLE_4[m.point.robot, "tripod"].stance_air for m in standing])
    shares = [f"{m.power - m.idle / 0.93:.1f} W ({label(m.point.robot)})" for m in standing]
    return (
        f"Stance in air: {ours.mean():.1f} W on average, the paper {theirs.mean():.1f} W. This is no prediction in its "
        "size: the servos' idle power of 0.86 W is set from the paper's least value, the same for every posture. What "
        f"holding the legs adds is: {', '.join(shares)}."
    )


def _walk_air(measured: Sequence[Measured]) -> str:
    rows = [
        (m, paper.TABLE_4[m.point.robot, m.point.gait])
        for m in measured
        if m.point.scenario == "WA" and not m.point.variant
    ]
    if not rows:
        return ""
    told = [f"{label(m.point.robot)} {m.point.gait} {m.power - t.walk_air:+.0f} W" for m, t in rows]
    limited = [
        f"{label(m.point.robot)} {m.point.gait} {100 * m.at_largest_speed:.0f} %"
        for m, _ in rows
        if m.at_largest_speed > 0
    ]
    lost = [
        f"{label(m.point.robot)} {m.point.gait} {100 * m.granted / m.asked:.0f} %"
        for m, _ in rows
        if m.granted < 0.98 * m.asked
    ]
    text = f"Walk in air, ours minus the paper's: {', '.join(told)}."
    if limited:
        text += (
            " Part of the time a servo is at its largest speed ("
            + ", ".join(limited)
            + "), for our swing keeps the last "
            "link upright and OpenSHC's leaves it free"
        )
        text += f"; the gait then makes only this share of the speed: {', '.join(lost)}." if lost else "."
    return text


def _stance(measured: Sequence[Measured]) -> str:
    told = []
    for robot in PROBED:
        ground, air = (find(measured, robot=robot, scenario=name, variant="") for name in ("SG", "SA"))
        if ground is not None and air is not None:
            theirs = paper.TABLE_4[robot, "tripod"]
            heat = ground.heat - air.heat
            told.append(
                f"{label(robot)} {ground.power - air.power:.1f} W "
                f"(paper {theirs.stance_ground - theirs.stance_air:.1f} W; {heat:.1f} W of ours heats the windings)"
            )
    if not told:
        return ""
    return (
        f"Carrying the body costs, stance on ground minus stance in air: {', '.join(told)}. Nearly all of it is "
        "current through the windings at rest, so it goes with the square of the feet's distance from the joints: the "
        "stance, which the paper gives in a picture only, decides it."
    )


def _order(measured: Sequence[Measured]) -> str:
    told = []
    for arrangement in ("a", "b"):
        both = [
            find(measured, robot=f"bullet_{arrangement}_{p}", scenario="SG", variant="")
            for p in ("mammalian", "insectoid")
        ]
        if both[0] is not None and both[1] is not None:
            relation = "less" if both[0].power < both[1].power else "not less"
            told.append(
                f"in arrangement {arrangement.upper()} {relation} ({both[0].power:.1f} against {both[1].power:.1f} W)"
            )
    if not told:
        return ""
    return (
        f"Standing on the ground, the mammalian posture takes {' and '.join(told)}; in the paper it takes less in both."
    )


def _speed(measured: Sequence[Measured]) -> str:
    walks = [m for m in measured if m.point.scenario == "WG" and not m.point.variant and not m.fell]
    if not walks:
        return ""
    limited = [m for m in walks if m.granted < 0.9 * m.asked]
    slipped = [m for m in walks if m.speed < 0.9 * m.granted]
    fell = sum(m.fell for m in measured)
    return (
        f"Of {len(walks)} walks on the ground {len(limited)} were slower than asked by more than a tenth because "
        f"servos or strides were at their limits, and {len(slipped)} slid by more than a tenth; {fell} fell. The paper "
        "saw its joint limits from 2 Hz (insectoid) and 3.5 Hz (mammalian B) on."
    )


def _bipod(measured: Sequence[Measured]) -> str:
    ratio = bipod_faster(measured)
    if not isfinite(ratio):
        return ""
    shared = [
        (b.cost, t.cost)
        for b in curve(measured, "bullet_a_insectoid", "bipod", 1.0)
        for t in curve(measured, "bullet_a_insectoid", "tripod", 1.0)
        if b.point.frequency == t.point.frequency and not b.fell and not t.fell
    ]
    cheaper = sum(b <= t for b, t in shared)
    return (
        f"The bipod gait walks {100 * (ratio - 1):.0f} % faster than the tripod gait at the same step frequency (paper "
        f"{100 * (paper.BIPOD_FASTER - 1):.0f} %) and costs no more at {cheaper} of {len(shared)} frequencies (the "
        "paper: at all)."
    )


def _variants(measured: Sequence[Measured]) -> list[str]:
    told = []
    texts = {
        "no_friction": "Without friction in the servos",
        "heavy_legs": "With legs half as heavy again",
        "stiff": "With servos of twice the position gain",
    }
    for variant, text in texts.items():
        changes = []
        for robot in PROBED:
            for name, what in (("WA", "walking in air"), ("SG", "standing on the ground")):
                plain, other = (
                    find(measured, robot=robot, gait="tripod", scenario=name, variant=v) for v in ("", variant)
                )
                if plain is not None and other is not None:
                    changes.append(f"{label(robot)} {what} {other.power - plain.power:+.1f} W")
        if changes:
            told.append(f"{text}: {', '.join(changes)}.")
    return told
