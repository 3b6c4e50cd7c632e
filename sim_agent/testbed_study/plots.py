"""The experiment's figures as the paper drew them: odometry error, cost and parameters along the course, sway."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse
from numpy.typing import NDArray

from sim_agent.testbed_study.walk import WalkRecord
from sim_agent.worlds import World
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

BIN = 0.25  # m along the course
COLOURS = {"adaptive": "#1565c0", "fixed": "#c62828"}
LINES = {"adaptive": "-", "fixed": "--"}
STRETCHES = {"A": ("A",), "B": ("B",), "C to F": ("C", "D", "E", "F")}
PARAMETERS = {"virtual_stiffness": "stiffness", "stride_frequency": "frequency", "stride_height": "height"}
PARAMETER_COLOURS = ("#6a1b9a", "#2e7d32", "#ef6c00")


def draw_all(records: list[WalkRecord], world: World, robot: RobotDescription, folder: Path) -> dict[str, Path]:
    """Draw every figure that the finished walks allow; returns PNG files by the figure's number in the paper."""
    finished = [record for record in records if record.outcome == "reached"]
    drawings: dict[str, Callable[[], Figure]] = {
        "9": lambda: _odometry_error(finished, world),
        "10": lambda: _cost_and_parameters(finished, world, robot),
        "11": lambda: _sway(finished, world),
    }
    files = {}
    for number, draw in drawings.items():
        if finished:
            files[number] = folder / f"figure_{number}.png"
            figure = draw()
            FigureCanvasAgg(figure).print_png(files[number])
    return files


def _odometry_error(records: list[WalkRecord], world: World) -> Figure:
    figure = Figure(figsize=(8.0, 3.2), dpi=110, layout="constrained")
    axes = figure.add_subplot()
    places = _places(world)
    errors = np.array([_along(record.rows["x"], _error(record), places) for record in records])
    mean, spread = _mean_and_spread(errors)
    axes.fill_between(places, 1000 * (mean - spread), 1000 * (mean + spread), color="0.85", label="± 1 σ")
    axes.plot(places, 1000 * mean, color="black", label=f"mean of {len(records)} walks")
    axes.set_ylabel("odometry error, mm")
    axes.set_ylim(bottom=0.0)
    _course(axes, world)
    axes.legend(loc="upper left", frameon=False)
    return figure


def _cost_and_parameters(records: list[WalkRecord], world: World, robot: RobotDescription) -> Figure:
    figure = Figure(figsize=(8.0, 5.6), dpi=110, layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    places = _places(world)
    for kind, colour in COLOURS.items():
        walks = [record for record in records if record.plan.kind == kind]
        if not walks:
            continue
        costs = np.array([_cost_along(record.rows, places, robot.mass) for record in walks])
        mean, spread = _mean_and_spread(costs)
        if kind == "adaptive":
            upper.fill_between(places, mean - spread, mean + spread, color="0.85")
        upper.plot(places, mean, LINES[kind], color=colour, label=f"{kind}, mean of {len(walks)}")
        for (name, label), shade in zip(PARAMETERS.items(), PARAMETER_COLOURS, strict=True):
            bounds = getattr(robot.adaptation, name)
            values = np.array([_along(record.rows["x"], record.rows[name], places) for record in walks])
            share = 100.0 * (_mean_and_spread(values)[0] - bounds.lower) / (bounds.upper - bounds.lower)
            lower.plot(places, share, LINES[kind], color=shade, label=f"{label}, {kind}")
    upper.set_ylabel("total cost of transport")
    upper.set_ylim(bottom=0.0)
    upper.legend(loc="upper right", frameon=False)
    lower.set_ylabel("parameters, % of their range")
    lower.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize="small")
    _course(upper, world, label=False)
    _course(lower, world)
    return figure


def _sway(records: list[WalkRecord], world: World) -> Figure:
    """Means and one standard deviation of angle and rate in the phase plane, by stretch of the course."""
    figure = Figure(figsize=(8.0, 3.8), dpi=110, layout="constrained")
    panels = figure.subplots(1, 2, sharey=True)
    styles = dict(zip(STRETCHES, ("-", "--", ":"), strict=True))
    ends = {segment.name: (segment.begin, segment.end) for segment in world.segments}
    for axes, angle in zip(panels, ("roll", "pitch"), strict=True):
        for kind, colour in COLOURS.items():
            walks = [record for record in records if record.plan.kind == kind]
            for stretch, segments in STRETCHES.items():
                parts = [_phase(record.rows, angle, ends[name]) for record in walks for name in segments]
                if parts:
                    _ellipse(axes, np.concatenate(parts, axis=1), colour, styles[stretch], f"{kind}, {stretch}")
        axes.set_title(angle)
        axes.set_xlabel("angle, rad")
        axes.autoscale_view()
    panels[0].set_ylabel("angular velocity, rad/s")
    panels[1].legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize="small")
    return figure


def _ellipse(axes: Any, samples: Array, colour: str, line: str, label: str) -> None:
    if samples.shape[1] < 3:
        return
    middle, spread = samples.mean(axis=1), samples.std(axis=1)
    axes.add_patch(Ellipse(tuple(middle), *(2.0 * spread), fill=False, edgecolor=colour, linestyle=line, label=label))
    axes.plot(*middle, "x", color=colour)


def _phase(rows: dict[str, Array], angle: str, ends: tuple[float, float]) -> Array:
    rate = np.gradient(rows[angle], rows["time"])
    inside = (rows["x"] >= ends[0]) & (rows["x"] < ends[1])
    return np.array([rows[angle][inside], rate[inside]])


def _places(world: World) -> Array:
    return np.arange(world.start[0] + BIN, world.segments[-1].end, BIN)


def _mean_and_spread(values: Array) -> tuple[Array, Array]:
    """Over the walks (walks, places), NaN where none of them came."""
    known = np.isfinite(values).any(axis=0)
    mean, spread = np.full((2, values.shape[1]), np.nan)
    mean[known], spread[known] = np.nanmean(values[:, known], axis=0), np.nanstd(values[:, known], axis=0)
    return mean, spread


def _along(x: Array, values: Array, places: Array) -> Array:
    """Means over a bin about each place, NaN where the walk did not come."""
    result = np.full(len(places), np.nan)
    for k, place in enumerate(places):
        near = (np.abs(x - place) <= 0.5 * BIN) & np.isfinite(values)
        if near.any():
            result[k] = values[near].mean()
    return result


def _cost_along(rows: dict[str, Array], places: Array, mass: float) -> Array:
    """Energy spent in each bin over weight and the bin's length."""
    energy = np.concatenate([[0.0], np.cumsum(rows["supply_power"][:-1] * np.diff(rows["time"]))])
    x = np.maximum.accumulate(rows["x"])
    ends = np.interp([places - 0.5 * BIN, places + 0.5 * BIN], x, energy)
    cost = (ends[1] - ends[0]) / (mass * GRAVITY * BIN)
    return np.where((places - 0.5 * BIN >= x[0]) & (places + 0.5 * BIN <= x[-1]), cost, np.nan)


def _error(record: WalkRecord) -> Array:
    """Distance (m) of the estimated from the true place, the two laid over each other at the start."""
    rows = record.rows
    _, _, heading = record.plan.world().start
    c, s = np.cos(heading), np.sin(heading)
    estimated = (
        c * rows["estimated_x"] - s * rows["estimated_y"],
        s * rows["estimated_x"] + c * rows["estimated_y"],
        rows["estimated_z"],
    )
    apart = np.array(estimated) - np.array([rows["x"], rows["y"], rows["z"]])
    return np.asarray(np.linalg.norm(apart - apart[:, :1], axis=0))


def _course(axes: Any, world: World, *, label: bool = True) -> None:
    """The segments as bands with their letters, and the axis below."""
    for index, segment in enumerate(world.segments):
        if index % 2:
            axes.axvspan(segment.begin, segment.end, color="0.96", zorder=0)
        axes.annotate(
            segment.name,
            (0.5 * (segment.begin + segment.end), 1.0),
            xycoords=("data", "axes fraction"),
            ha="center",
            va="bottom",
        )
    axes.set_xlim(world.start[0], world.segments[-1].end)
    if label:
        axes.set_xlabel("way along the course, m")
