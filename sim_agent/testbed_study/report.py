"""The study's tables, and what is to be known when reading them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sim_agent.report_pages import Section, Table, write_pages
from sim_agent.testbed_study import paper
from sim_agent.testbed_study.figures import KindFigures, StudyFigures
from sim_agent.testbed_study.walk import WalkRecord
from weaver_shared.config.adaptation import AdaptationConfig

CAPTIONS = {
    "9": "Odometry error along the course (the paper's Fig. 9, lower plot).",
    "10": "Cost of transport and gait parameters along the course (Fig. 10). Grey: one standard deviation, adaptive.",
    "11": "Sway: mean and one standard deviation of roll and pitch in the phase plane (Fig. 11).",
}
NOTES = (
    "The robot, its servos, its cameras and the course are simulated; pictures are rendered and everything the robot "
    "knows it estimates from them. Adaptive and fixed walks of a seed begin alike and differ in nothing but the "
    "adaptation.",
    "Cost of transport counts the whole supply with the computers, as the paper does; the motors alone are given "
    "beside it. The simulated robot walks faster than the paper's, so the fixed load of the computers weighs less and "
    "all costs are lower.",
    "The fixed parameters are those of the first adaptive walk where it goes most carefully: the paper tunes its fixed "
    "set to the adaptive one on the roughest part.",
    "Variances are of the true roll and pitch about each walk's own mean on the segment.",
)


def write_report(
    folder: Path,
    figures: StudyFigures,
    pictures: dict[str, Path],
    records: list[WalkRecord],
    adaptation: AdaptationConfig,
) -> list[Path]:
    """Write report.md and report.html into `folder`; `records` are of all walks, within the bounds of `adaptation`.

    Raises InputError when that can not be done.
    """
    sections: list[Section] = [
        ("Over the whole course", overall_table(figures)),
        ("By segment (the paper's Table III)", segment_table(figures)),
        ("Gait parameters (Table II)", parameter_table(records, adaptation)),
    ]
    captioned = [(path, CAPTIONS[number]) for number, path in pictures.items()]
    return write_pages(folder, "Testbed: adaptive against fixed gait parameters", sections, captioned, NOTES)


def overall_table(figures: StudyFigures) -> Table:
    adaptive, fixed = figures.kinds["adaptive"], figures.kinds["fixed"]
    return [
        ("", "adaptive", "fixed", "paper adaptive", "paper fixed"),
        ("walks that reached the end", _share(adaptive), _share(fixed), "15 of 15", "15 of 15"),
        (
            "cost of transport, total",
            _pm(adaptive.cost_total),
            _pm(fixed.cost_total),
            _pm(paper.COST_ADAPTIVE),
            _pm(paper.COST_FIXED),
        ),
        ("cost of transport, motors", _pm(adaptive.cost_motors), _pm(fixed.cost_motors), "", ""),
        (
            "reduction of the total, %",
            _number(figures.cost_reduction, 1),
            "",
            _number(paper.COST_REDUCTION, 1),
            "",
        ),
        ("reduction of the motors', %", _number(figures.motor_cost_reduction, 1), "", "", ""),
        ("mean speed, m/s", _pm(adaptive.speed, 3), _pm(fixed.speed, 3), "", ""),
        ("duration, s", _pm(adaptive.duration, 1), _pm(fixed.duration, 1), "", ""),
        ("odometry drift, % of the way", _pm(adaptive.drift_percent, 3), _pm(fixed.drift_percent, 3), "", ""),
    ]


def segment_table(figures: StudyFigures) -> Table:
    rows: Table = [
        (
            "segment",
            "cost adaptive",
            "cost fixed",
            "cost reduction %",
            "paper",
            "roll variance reduction %",
            "paper",
            "pitch variance reduction %",
            "paper",
            "speed adaptive / fixed, m/s",
        )
    ]
    for name, segment in figures.segments.items():
        theirs = paper.SEGMENTS.get(name)
        rows.append(
            (
                name,
                _number(segment.cost_total[0], 2),
                _number(segment.cost_total[1], 2),
                _number(segment.cost_reduction, 1),
                _number(theirs.cost, 1) if theirs else "",
                _number(segment.roll_reduction, 1),
                _number(theirs.roll_variance, 1) if theirs else "",
                _number(segment.pitch_reduction, 1),
                _number(theirs.pitch_variance, 1) if theirs else "",
                " / ".join(_number(value, 3) for value in segment.speed),
            )
        )
    return rows


def parameter_table(records: list[WalkRecord], adaptation: AdaptationConfig) -> Table:
    """What the adaptive walks took of what they may, and the fixed values; the paper's own are lost."""
    labels = {
        "virtual_stiffness": "virtual stiffness, N/m",
        "stride_frequency": "stride frequency, Hz",
        "stride_height": "stride height, m",
    }
    adaptive = [record.rows for record in records if record.plan.kind == "adaptive"]
    constant = next((record.plan.parameters or {} for record in records if record.plan.kind == "fixed"), {})
    rows: Table = [("", "bounds", "adaptive", "fixed")]
    for name, label in labels.items():
        bounds = getattr(adaptation, name)
        taken = [float(of(rows[name])) for of in (np.min, np.max) for rows in adaptive if len(rows[name])]
        rows.append(
            (
                label,
                f"{bounds.lower:g} to {bounds.upper:g}",
                f"{min(taken):.3g} to {max(taken):.3g}" if taken else "–",
                f"{constant[name]:g}" if name in constant else "–",
            )
        )
    return rows


def _share(figures: KindFigures) -> str:
    return f"{figures.reached} of {figures.walks}"


def _pm(value: tuple[float, float], digits: int = 2) -> str:
    return f"{_number(value[0], digits)} ± {_number(value[1], digits)}" if math.isfinite(value[0]) else "–"


def _number(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"
