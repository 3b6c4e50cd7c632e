"""The best gaits with the polynomials through them, as the paper's Fig. 5, and the score of every trial."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from robot_agent.adaptation import gait_for
from sim_agent.fit_study.best import BestGait, score
from sim_agent.fit_study.least_squares import PARAMETERS
from sim_agent.fit_study.trial import TrialResult
from weaver_shared.config.adaptation import AdaptationConfig

LABELS = {
    "virtual_stiffness": "virtual stiffness, N/m",
    "stride_frequency": "stride frequency, Hz",
    "stride_height": "stride height, m",
}
FITTED, USED = "#1565c0", "0.5"


def draw_all(
    bests: list[BestGait],
    results: list[TrialResult],
    used: AdaptationConfig,
    fitted: AdaptationConfig,
    folder: Path,
) -> dict[str, Path]:
    """PNG files by name."""
    figures = {"polynomials": _polynomials(bests, used, fitted), "costs": _costs(bests, results)}
    files = {}
    for name, figure in figures.items():
        files[name] = folder / f"{name}.png"
        FigureCanvasAgg(figure).print_png(files[name])
    return files


def _polynomials(bests: list[BestGait], used: AdaptationConfig, fitted: AdaptationConfig) -> Figure:
    figure = Figure(figsize=(10.0, 3.6), dpi=110, layout="constrained")
    passed = [best for best in bests if best.passed]
    r = np.linspace(0.0, 1.0, 101)
    h = _step_height_along(passed, r)
    for k, (axes, name) in enumerate(zip(figure.subplots(1, 3), PARAMETERS, strict=True)):
        for config, colour, line, label in ((used, USED, "--", "in use"), (fitted, FITTED, "-", "fitted")):
            curve = [gait_for(float(a), float(b), config)[name] for a, b in zip(r, h, strict=True)]
            axes.plot(r, curve, line, color=colour, label=label)
        axes.errorbar(
            [best.roughness for best in passed],
            [best.parameters[k] for best in passed],
            [best.spread[k] for best in passed],
            fmt="o",
            color="black",
            capsize=3,
            label="best gait and spread of the good ones",
        )
        axes.plot([b.roughness for b in passed], [b.fastest[k] for b in passed], "x", color="#c62828", label="fastest")
        axes.set_xlabel("roughness")
        axes.set_title(LABELS[name])
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    return figure


def _step_height_along(passed: list[BestGait], r: np.ndarray) -> np.ndarray:
    """The step height that goes with a roughness on the studied grounds, up to (1, 1)."""
    order = sorted((best.roughness, best.step_height) for best in passed)
    known = np.array([*order, (1.0, 1.0)])
    return np.asarray(np.interp(r, known[:, 0], known[:, 1]))


def _costs(bests: list[BestGait], results: list[TrialResult]) -> Figure:
    """Every trial's score by stride frequency; a row of crosses at the top for those that failed."""
    columns = min(4, max(1, len(bests)))
    rows = -(-len(bests) // columns)
    figure = Figure(figsize=(2.7 * columns, 2.6 * rows), dpi=110, layout="constrained")
    panels = np.atleast_1d(figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel())
    for axes in panels[len(bests) :]:
        axes.set_visible(False)
    passed = [one for one in results if one.outcome == "reached"]
    scores = [score(one.cost_total, one.roll_variance + one.pitch_variance) for one in passed]
    top = 1.1 * max(scores, default=1.0)
    for axes, best in zip(panels, bests, strict=False):
        here = [(one, s) for one, s in zip(passed, scores, strict=True) if one.trial.ground == best.ground]
        axes.scatter(
            [one.trial.stride_frequency for one, _ in here],
            [s for _, s in here],
            c=[one.trial.stride_height for one, _ in here],
            s=[10.0 + 0.02 * one.trial.virtual_stiffness for one, _ in here],
            cmap="viridis",
            alpha=0.8,
        )
        failed = [one for one in results if one.trial.ground == best.ground and one.outcome != "reached"]
        axes.plot([one.trial.stride_frequency for one in failed], [top] * len(failed), "x", color="#c62828")
        axes.set_title(f"{best.ground}: r {best.roughness:.2f}, h {best.step_height:.2f}", fontsize="small")
        axes.set_ylim(0.0, 1.05 * top)
    figure.supxlabel("stride frequency, Hz")
    figure.supylabel("score")
    return figure
