"""The study as Markdown and as one HTML page."""

from __future__ import annotations

import math
from pathlib import Path

from robot_agent.adaptation import gait_for
from sim_agent.fit_study.best import BestGait
from sim_agent.fit_study.least_squares import PARAMETERS, POLYNOMIALS, Fitted
from sim_agent.fit_study.plots import LABELS
from sim_agent.report_pages import Section, Table, write_pages
from weaver_shared.config.adaptation import AdaptationConfig

CAPTIONS = {
    "polynomials": "Best gait of every ground and the polynomials through them (the paper's Fig. 5).",
    "costs": "Score of every trial by stride frequency. Colour: stride height, dark is low. Size: stiffness. Crosses "
    "at the top: did not reach the end.",
}
PAPER = {
    "virtual_stiffness": "cubic in roughness (9), falls",
    "stride_frequency": "quadratic in roughness (10), falls",
    "stride_height": "affine in step height and roughness (11), rises",
}
NOTES = (
    "The paper measures roughness and step height of example terrains, chooses for each the gait that walks best and "
    "fits polynomials by least squares, which also gives their degree. Its coefficients and ranges are not printed, so "
    "only the form can be compared.",
    "Here each ground's roughness and step height are those of its true surface. The score is the total cost of "
    "transport times (1 + variance of roll and pitch over (3 degrees) squared); a set that fails with any seed is out. "
    "The best gait is the mean of all sets, weighed by how near their score is to the lowest. The set that is merely "
    "fastest, the paper's measure, is given beside it.",
    "The degree is the one that predicts best a ground left out of the fit, of those whose polynomial has the paper's "
    "form: stiffness and frequency never rise with rougher ground, and the stride height never falls. At r = h = 1, "
    "the answer for unknown ground, the polynomials are held to the safe gait in use.",
)


def write_report(
    folder: Path,
    bests: list[BestGait],
    fitted: list[Fitted],
    settings: tuple[AdaptationConfig, AdaptationConfig],
    pictures: dict[str, Path],
) -> list[Path]:
    """Write report.md and report.html; `settings` are those in use and the fitted ones. Raises InputError."""
    used, found = settings
    sections: list[Section] = [
        ("Best gait of every ground", best_table(bests)),
        ("Polynomials", polynomial_table(fitted, used)),
        ("What they answer on these grounds", answer_table(bests, used, found)),
    ]
    captioned = [(path, CAPTIONS[name]) for name, path in pictures.items()]
    return write_pages(folder, "Gait parameters for every roughness", sections, captioned, NOTES)


def best_table(bests: list[BestGait]) -> Table:
    head = ("ground", "roughness", "step height", "sets passed", *(LABELS[name] for name in PARAMETERS), "total cost")
    rows: Table = [(*head, "sway, deg", "speed, m/s", "fastest set", "its speed")]
    for best in bests:
        rows.append(
            (
                best.ground,
                f"{best.roughness:.2f}",
                f"{best.step_height:.2f}",
                f"{best.passed} of {best.sets}",
                *(_with_spread(value, spread) for value, spread in zip(best.parameters, best.spread, strict=True)),
                _number(best.cost_total, 2),
                _number(best.sway_deg, 2),
                _number(best.speed, 3),
                " / ".join(f"{value:g}" for value in best.fastest) if best.passed else "–",
                _number(best.fastest_speed, 3),
            )
        )
    return rows


def polynomial_table(fitted: list[Fitted], used: AdaptationConfig) -> Table:
    rows: Table = [("", "fitted", "in use", "residual", "error where left out", "the paper's form")]
    for one in fitted:
        rows.append(
            (
                LABELS[one.name],
                ", ".join(f"{value:g}" for value in one.coefficients),
                ", ".join(f"{value:g}" for value in getattr(used, POLYNOMIALS[one.name])),
                f"{one.residual:.3g}",
                f"{one.predicted:.3g}",
                PAPER[one.name],
            )
        )
    return rows


def answer_table(bests: list[BestGait], used: AdaptationConfig, found: AdaptationConfig) -> Table:
    rows: Table = [("ground", *(f"{LABELS[name]}, fitted (in use)" for name in PARAMETERS))]
    for best in bests:
        new, old = (gait_for(best.roughness, best.step_height, config) for config in (found, used))
        rows.append((best.ground, *(f"{new[name]:.3g} ({old[name]:.3g})" for name in PARAMETERS)))
    return rows


def _with_spread(value: float, spread: float) -> str:
    return f"{value:.3g} ± {spread:.2g}" if math.isfinite(value) else "–"


def _number(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"
