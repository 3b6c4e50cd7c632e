"""The study's figures: power beside the paper's bars, cost of transport and speed against step frequency."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from sim_agent.bullet_study import paper
from sim_agent.bullet_study.measure import Measured
from sim_agent.bullet_study.points import CURVES
from sim_agent.bullet_study.tables import curve, find, label

COLOURS = ("#1565c0", "#c62828", "#2e7d32", "#6a1b9a")
MARKERS = ("o", "s", "^", "D")
BARS = (
    ("SA", "stance_air", "stance in air"),
    ("WA", "walk_air", "walk in air"),
    ("SG", "stance_ground", "stance on ground"),
)


def draw_all(measured: Sequence[Measured], folder: Path) -> dict[str, Path]:
    """PNG files by what they show: "power", and the paper's figures "14" to "16"."""
    files = {"power": folder / "power.png"}
    FigureCanvasAgg(_power(measured)).print_png(files["power"])
    for figure, curves in CURVES.items():
        if any(curve(measured, *one) for one in curves):
            files[figure] = folder / f"figure_{figure}.png"
            FigureCanvasAgg(_curves(measured, figure)).print_png(files[figure])
    return files


def _power(measured: Sequence[Measured]) -> Figure:
    figure = Figure(figsize=(9.0, 3.6), dpi=110, layout="constrained")
    for axes, (scenario, theirs, title) in zip(figure.subplots(1, 3, sharey=True), BARS, strict=True):
        for place, ((robot, gait), row) in enumerate(paper.TABLE_4.items()):
            wanted = gait if scenario == "WA" else "tripod"
            own = find(measured, robot=robot, gait=wanted, scenario=scenario, variant="")
            if own is not None:
                axes.bar(place - 0.2, own.power, 0.4, color=COLOURS[0], label="simulated" if place == 0 else None)
            axes.bar(
                place + 0.2, getattr(row, theirs), 0.4, color="0.6", hatch="//", label="paper" if place == 0 else None
            )
        axes.set_xticks(
            range(len(paper.TABLE_4)), [f"{label(robot)}\n{gait}" for robot, gait in paper.TABLE_4], fontsize=7
        )
        axes.tick_params(axis="x", rotation=60)
        axes.set_title(title, fontsize=10)
    figure.axes[0].set_ylabel("power, W")
    figure.axes[0].legend(frameon=False)
    return figure


def _curves(measured: Sequence[Measured], number: str) -> Figure:
    figure = Figure(figsize=(9.0, 3.6), dpi=110, layout="constrained")
    cost, speed = figure.subplots(1, 2)
    for (robot, gait, stride), colour, marker in zip(CURVES[number], COLOURS, MARKERS, strict=False):
        walked = [m for m in curve(measured, robot, gait, stride) if not m.fell]
        frequencies = [m.point.frequency for m in walked]
        name = f"{label(robot)}, {gait}, {100 * stride:.0f} %"
        cost.plot(frequencies, [m.cost for m in walked], color=colour, marker=marker, label=name)
        speed.plot(frequencies, [m.speed for m in walked], color=colour, marker=marker, label=name)
        speed.plot(frequencies, [m.asked for m in walked], ":", color=colour, linewidth=1.0)
    cost.set_ylabel("cost of transport")
    cost.set_ylim(bottom=0.0)
    speed.set_ylabel("speed, m/s (dotted: asked)")
    speed.set_ylim(bottom=0.0)
    for axes in (cost, speed):
        axes.set_xlabel("step frequency, Hz")
        axes.grid(color="0.9")
    cost.legend(frameon=False, fontsize=8)
    return figure
