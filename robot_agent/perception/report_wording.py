"""A terrain report as one JSON object and as a few lines to read."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from robot_agent.perception.layer_comparison import LayerComparison
from robot_agent.perception.local_planes import LocalPlanes
from robot_agent.perception.stairs import Stairs
from robot_agent.perception.terrain_report import TerrainReport


def as_json(report: TerrainReport) -> dict[str, object]:
    """Figures in SI units; unknown numbers are null."""
    terrain = report.terrain
    return {
        "kind": report.kind,
        "frame": report.frame,
        "cell": report.cell,
        "coverage": _number(report.coverage),
        "roughness": {"value": _number(terrain.roughness), "sigma": _number(terrain.roughness_sigma)},
        "step_height": {"value": _number(terrain.step_height), "sigma": _number(terrain.step_height_sigma)},
        "features": [_number(value) for value in report.features],
        "plane": {
            "normal_in_input": [float(value) for value in report.normal_in_input],
            "tilt_deg": report.tilt_deg,
            "tilt_reference": report.tilt_reference,
            "rms": report.rms,
        },
        "steps": [round(top.height, 5) for top in report.steps],
        "step_areas": [round(top.area, 5) for top in report.steps],
        "stairs": _stairs_json(report.stairs),
        "layers": _layers_json(report.layers, report.compared),
    }


def as_text(report: TerrainReport) -> str:
    terrain, normal = report.terrain, ", ".join(f"{value:.4f}" for value in report.normal_in_input)
    steps = ", ".join(f"{1000 * top.height:.0f} mm" for top in report.steps) or "none"
    more = []
    if (stairs := report.stairs) is not None:
        more.append(
            f"stairs       {stairs.rises} rises of {1000 * stairs.rise:.0f} +- {1000 * stairs.rise_sigma:.0f} mm"
        )
    more.extend(
        f"file's {layer.name}: differs by {layer.median:.2g} {layer.unit} (median), "
        f"{layer.percentile_99:.2g} (99 %) in {layer.cells} cells"
        for layer in report.compared
    )
    return "\n".join(
        [
            f"{report.kind} in cells of {1000 * report.cell:.0f} mm, {report.coverage:.0%} known",
            f"roughness    {terrain.roughness:.3f} +- {terrain.roughness_sigma:.3f} (0 flat, 1 roughest)",
            f"step height  {terrain.step_height:.3f} +- {terrain.step_height_sigma:.3f} (0 none, 1 highest)",
            f"plane        normal ({normal}), {report.tilt_deg:.2f} degrees to {report.tilt_reference}, "
            f"rms {1000 * report.rms:.1f} mm",
            f"flat tops    {steps} above the ground",
            *more,
        ]
    )


def _stairs_json(stairs: Stairs | None) -> dict[str, object] | None:
    if stairs is None:
        return None
    return {"lowest": stairs.lowest, "rise": stairs.rise, "rise_sigma": stairs.rise_sigma, "rises": stairs.rises}


def _layers_json(planes: LocalPlanes | None, compared: tuple[LayerComparison, ...]) -> dict[str, object] | None:
    if planes is None:
        return None
    return {
        "radius": planes.radius,
        "slope": _distribution(planes.slope),
        "roughness": _distribution(planes.roughness),
        "compared_with_file": {
            layer.name: {
                "unit": layer.unit,
                "cells": layer.cells,
                "median_difference": layer.median,
                "p99_difference": layer.percentile_99,
                "largest_difference": layer.largest,
            }
            for layer in compared
        },
    }


def _distribution(layer: NDArray[np.float64]) -> dict[str, float | None]:
    known = layer[np.isfinite(layer)]
    if not len(known):
        return {"median": None, "p95": None, "max": None}
    median, p95, largest = np.quantile(known, [0.5, 0.95, 1.0])
    return {"median": float(median), "p95": float(p95), "max": float(largest)}


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
