"""How far a robot's map is from the ground it walked over, cell by cell, by segment of the course."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.mapping.files import MapSnapshot
from robot_agent.mapping.sliding_features import cell_features
from sim_agent.true_indices import cell_tops
from sim_agent.worlds import World
from weaver_shared.config.mapping import MappingConfig

Array = NDArray[np.float64]

FEWEST = 50  # cells without which nothing is said of a segment
QUANTILE = 0.9


@dataclass(frozen=True, slots=True, kw_only=True)
class LayerErrors:
    """Of one layer on one segment; the figures of indices 0..1, heights in m."""

    mean_absolute_error: float
    bias: float  # map less truth
    within_one_sigma: float  # share of the cells; 0.68 for a normal law
    within_two_sigma: float  # 0.95 likewise
    true_level: float  # the segment's 90 % quantile, as the gait is ruled by
    map_level: float


@dataclass(frozen=True, slots=True, kw_only=True)
class SegmentTruth:
    cells: int
    elevation: LayerErrors
    roughness: LayerErrors
    step_height: LayerErrors


def compare(snapshot: MapSnapshot, world: World, config: MappingConfig) -> dict[str, SegmentTruth]:
    """By segment name; "" holds what lies on none. The map's world must be `world`'s: the run began at its origin.

    The true features are those of eqs. 7 and 8 on the true tops, by the same running sums and without noise.
    """
    x, y = _centres(snapshot)
    top = cell_tops(world, x, y, snapshot.cell)
    truth = cell_features(top.astype(np.float32), np.zeros(top.shape, dtype=np.float32), config)
    names = np.array([[world.segment_at(float(place)) or ""] for place in x])
    on_segment = np.broadcast_to(names, top.shape)
    half_width = world.bounds[3]
    beside = np.abs(y)[None, :] > half_width - config.window * snapshot.cell
    result = {}
    layers = snapshot.layers
    for name in sorted(set(names.ravel())):
        known = (on_segment == name) & ~beside & np.isfinite(layers["elevation"]) & np.isfinite(layers["roughness"])
        if known.sum() < FEWEST:
            continue
        sigma = np.sqrt(layers["variance"])
        result[str(name)] = SegmentTruth(
            cells=int(known.sum()),
            elevation=_errors(layers["elevation"][known], sigma[known], top[known]),
            roughness=_errors(layers["roughness"][known], layers["roughness_sigma"][known], truth.roughness[known]),
            step_height=_errors(
                layers["step_height"][known], layers["step_height_sigma"][known], truth.step_height[known]
            ),
        )
    return result


def rank_correlation(segments: dict[str, SegmentTruth], layer: str) -> float:
    """Spearman's, of the segments' levels by the map and in truth; NaN for fewer than three segments."""
    levels = [getattr(segment, layer) for name, segment in segments.items() if name]
    if len(levels) < 3:
        return float("nan")
    ranks = [np.argsort(np.argsort([getattr(level, side) for level in levels])) for side in ("map_level", "true_level")]
    return float(np.corrcoef(ranks[0], ranks[1])[0, 1])


def _errors(values: NDArray[np.float32], sigma: NDArray[np.float32], truth: Array) -> LayerErrors:
    error = values.astype(np.float64) - truth
    return LayerErrors(
        mean_absolute_error=float(np.abs(error).mean()),
        bias=float(error.mean()),
        within_one_sigma=float((np.abs(error) <= sigma).mean()),
        within_two_sigma=float((np.abs(error) <= 2.0 * sigma).mean()),
        true_level=float(np.quantile(truth, QUANTILE)),
        map_level=float(np.quantile(values, QUANTILE)),
    )


def _centres(snapshot: MapSnapshot) -> tuple[Array, Array]:
    rows, columns = snapshot.shape
    x = (snapshot.row0 + np.arange(rows) + 0.5) * snapshot.cell
    y = (snapshot.column0 + np.arange(columns) + 0.5) * snapshot.cell
    return np.asarray(x), np.asarray(y)
