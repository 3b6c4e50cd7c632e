"""The study's tables: power in the four scenarios, costs along step frequency, and what explains the differences."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite, nan

from sim_agent.bullet_study import paper
from sim_agent.bullet_study.measure import Measured
from sim_agent.bullet_study.points import CURVES, PROBED, VARIANTS

Table = list[tuple[str, ...]]

VARIANT_NAMES = {
    "": "as described",
    "no_friction": "servos without friction",
    "heavy_legs": "legs half as heavy again, trunk lighter",
    "stiff": "servos of twice the position gain",
}


def label(robot: str) -> str:
    """`bullet_a_insectoid` as "insectoid A"."""
    _, arrangement, posture = robot.split("_")
    return f"{posture} {arrangement.upper()}"


def find(measured: Sequence[Measured], **wanted: object) -> Measured | None:
    """The first point with these properties."""
    fitting = (m for m in measured if all(getattr(m.point, key) == value for key, value in wanted.items()))
    return next(fitting, None)


def curve(measured: Sequence[Measured], robot: str, gait: str, stride: float) -> list[Measured]:
    """Walks on the ground along step frequency."""
    points = [
        m for m in measured
        if (m.point.robot, m.point.gait, m.point.stride) == (robot, gait, stride)
        and m.point.scenario == "WG" and not m.point.variant
    ]  # fmt: skip
    return sorted(points, key=lambda m: m.point.frequency)


def power_table(measured: Sequence[Measured]) -> Table:
    """Table IV with the paper's figures beside ours, and walking on the ground at the same frequency."""
    rows: Table = [
        (
            "",
            "gait",
            "stance air",
            "paper",
            "walk air",
            "paper",
            "stance ground",
            "paper",
            "walk ground",
            "cost of transport",
        )
    ]
    for (robot, gait), theirs in paper.TABLE_4.items():
        own = {
            "SA": find(measured, robot=robot, scenario="SA", variant=""),
            "WA": find(measured, robot=robot, gait=gait, scenario="WA", variant=""),
            "SG": find(measured, robot=robot, scenario="SG", variant=""),
        }
        nearest = min(
            curve(measured, robot, gait, 1.0),
            key=lambda m: abs(m.point.frequency - paper.TABLE_4_FREQUENCY),
            default=None,
        )
        ground = (
            (f"{_power(nearest)} at {nearest.point.frequency:g} Hz", f"{nearest.cost:.2f}") if nearest else ("", "")
        )
        rows.append(
            (
                label(robot),
                gait,
                _power(own["SA"]),
                f"{theirs.stance_air:.1f}",
                _power(own["WA"]),
                f"{theirs.walk_air:.1f}",
                _power(own["SG"]),
                f"{theirs.stance_ground:.1f}",
                *ground,
            )
        )
    return rows


def parts_table(measured: Sequence[Measured]) -> Table:
    """Where the power goes: electronics, windings, work, converter."""
    rows: Table = [("", "gait", "scenario", "power, W", "electronics", "heat in windings", "work", "converter")]
    for robot, gait in paper.TABLE_4:
        for name in ("SA", "WA", "SG"):
            found = find(measured, robot=robot, scenario=name, variant="", gait=gait if name == "WA" else "tripod")
            if found is not None:
                lost = found.power - found.idle - found.heat - found.work
                rows.append(
                    (label(robot), gait, name, f"{found.power:.1f}", f"{found.idle:.1f}", f"{found.heat:.1f}",
                     f"{round(found.work, 1) + 0.0:.1f}", f"{lost:.1f}")
                )  # fmt: skip
    return rows


def variant_table(measured: Sequence[Measured]) -> Table:
    """What a change of the model changes."""
    rows: Table = [("", "model", "stance ground, W", "walk air, W")]
    for robot in PROBED:
        for variant in VARIANTS:
            ground = find(measured, robot=robot, gait="tripod", scenario="SG", variant=variant)
            air = find(measured, robot=robot, gait="tripod", scenario="WA", variant=variant)
            if ground is not None and air is not None:
                rows.append((label(robot), VARIANT_NAMES[variant], _power(ground), _power(air)))
    return rows if len(rows) > 1 + len(PROBED) else []


def curve_tables(measured: Sequence[Measured]) -> dict[str, Table]:
    """Every figure's curves as numbers."""
    tables: dict[str, Table] = {}
    for figure, curves in CURVES.items():
        rows: Table = [
            ("", "gait", "stride, %", "step frequency, Hz", "power, W", "speed, m/s", "asked, m/s", "cost of transport",
             "servo at its largest speed, %")
        ]  # fmt: skip
        for robot, gait, stride in curves:
            for m in curve(measured, robot, gait, stride):
                rows.append(
                    (label(robot), gait, f"{100 * stride:.0f}", f"{m.point.frequency:g}", f"{m.power:.1f}",
                     "fell" if m.fell else f"{m.speed:.3f}", f"{m.asked:.3f}", _number(m.cost if not m.fell else nan),
                     f"{100 * m.at_largest_speed:.0f}")
                )  # fmt: skip
        tables[figure] = rows
    return tables


def optimum_table(measured: Sequence[Measured]) -> Table:
    """Where every curve is least, beside what the paper's text says of the figure."""
    rows: Table = [("figure", "curve", "least cost", "at, Hz", "fastest, m/s", "the paper's text")]
    for figure, curves in CURVES.items():
        for robot, gait, stride in curves:
            walked = [m for m in curve(measured, robot, gait, stride) if not m.fell and isfinite(m.cost)]
            if walked:
                best, fastest = min(walked, key=lambda m: m.cost), max(walked, key=lambda m: m.speed)
                name = f"{label(robot)} {gait} {100 * stride:.0f} %"
                rows.append(
                    (figure, name, f"{best.cost:.2f}", f"{best.point.frequency:g}", f"{fastest.speed:.3f}",
                     paper.OPTIMUM[figure] if (robot, gait, stride) == curves[0] else "")
                )  # fmt: skip
    return rows


def bipod_faster(measured: Sequence[Measured]) -> float:
    """Mean ratio of the bipod's to the tripod's speed at the same step frequencies, insectoid A; NaN without."""
    tripod = {m.point.frequency: m for m in curve(measured, "bullet_a_insectoid", "tripod", 1.0) if not m.fell}
    ratios = [
        m.speed / tripod[m.point.frequency].speed
        for m in curve(measured, "bullet_a_insectoid", "bipod", 1.0)
        if m.point.frequency in tripod and not m.fell and tripod[m.point.frequency].speed > 0.0
    ]
    return sum(ratios) / len(ratios) if ratios else nan


def _power(measured: Measured | None) -> str:
    return "" if measured is None else f"{measured.power:.1f}"


def _number(value: float) -> str:
    return f"{value:.2f}" if isfinite(value) else "–"
