"""How far our slope and roughness are from those that a map file brings along."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.perception.local_planes import LocalPlanes

Array = NDArray[np.float64]

CRITICAL_SLOPE = 1.0  # rad, ETH's default: what its traversability 0 stands for
CRITICAL_ROUGHNESS = 0.05  # m, likewise


@dataclass(frozen=True, slots=True, kw_only=True)
class LayerComparison:
    """Absolute differences of one of the file's layers from ours, in our unit, where both are defined."""

    name: str
    unit: str
    cells: int
    median: float
    percentile_99: float
    largest: float


@dataclass(frozen=True, slots=True)
class _Meaning:
    """What a known layer holds: a value in `unit`, found from the layer's number where that is not saturated."""

    ours: str
    unit: str
    value: Callable[[Array], Array]
    defined: Callable[[Array], NDArray[np.bool_]]


def _anywhere(layer: Array) -> NDArray[np.bool_]:
    return np.isfinite(layer)


def _unsaturated(layer: Array) -> NDArray[np.bool_]:
    """A traversability of 0 only says that the critical value is reached."""
    return np.isfinite(layer) & (layer > 0.0)


MEANINGS = {
    "slope": _Meaning("slope", "rad", lambda layer: layer, _anywhere),
    "roughness": _Meaning("roughness", "m", lambda layer: layer, _anywhere),
    "traversability_slope": _Meaning("slope", "rad", lambda layer: (1.0 - layer) * CRITICAL_SLOPE, _unsaturated),
    "traversability_roughness": _Meaning(
        "roughness", "m", lambda layer: (1.0 - layer) * CRITICAL_ROUGHNESS, _unsaturated
    ),
}
"""Layers of grid_map's filters and of ETH's traversability_estimation by their names there."""


def compare_layers(ours: LocalPlanes, layers: Mapping[str, Array]) -> tuple[LayerComparison, ...]:
    """One comparison for every layer whose name tells what it holds and that says something somewhere."""
    result = []
    for name, meaning in MEANINGS.items():
        if name not in layers:
            continue
        own = np.asarray(getattr(ours, meaning.ours))
        both = meaning.defined(layers[name]) & np.isfinite(own)
        if not both.any():
            continue
        difference = np.abs(own - meaning.value(layers[name]))[both]
        result.append(
            LayerComparison(
                name=name,
                unit=meaning.unit,
                cells=int(both.sum()),
                median=float(np.median(difference)),
                percentile_99=float(np.quantile(difference, 0.99)),
                largest=float(difference.max()),
            )
        )
    return tuple(result)
