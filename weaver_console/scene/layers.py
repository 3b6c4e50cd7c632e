"""Terrain layers as colours: what a layer means, its colour scale, and the legend both views draw from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.ground import UNKNOWN_MM
from weaver_shared.messages import MapTile

Array = NDArray[np.float64]

LAYERS = ("elevation", "roughness", "step_height", "uncertainty", "age")
UNKNOWN_COLOUR = "#3a3f46"
SHADES = 1024
"""Colours told apart on a scale: more than a screen does."""

_VIRIDIS = (
    "#440154",
    "#482878",
    "#3e4989",
    "#31688e",
    "#26828e",
    "#1f9e89",
    "#35b779",
    "#6ece58",
    "#b5de2b",
    "#fde725",
)
_EARTH = ("#33507a", "#4c7d8f", "#6fa287", "#a9bf84", "#d9cf96", "#c79f6b", "#a4704f", "#f1ece6")
_HEAT = ("#2c6e63", "#5a9a64", "#a3bd5c", "#e3d35f", "#e7a64a", "#d96c3c", "#b03034")
_FADE = ("#f2d388", "#b89f7a", "#7d7a78", "#555c66")


@dataclass(frozen=True, slots=True, kw_only=True)
class Legend:
    """A colour scale: linear between the stops, clamped outside."""

    layer: str
    label: str
    unit: str
    stops: tuple[tuple[float, str], ...]

    def colours(self, values: Array) -> NDArray[np.uint8]:
        """sRGB of values (...), (..., 3); NaN is the colour of the unknown."""
        colours: NDArray[np.uint8] = self.table[self.shades(values)]
        return colours

    def shades(self, values: Array) -> NDArray[np.int64]:
        """Rows of `table` for values (...)."""
        low, high = self.stops[0][0], self.stops[-1][0]
        share = np.rint((SHADES - 1) * np.clip((values - low) / (high - low), 0.0, 1.0))
        share[np.isnan(share)] = SHADES
        return share.astype(np.int64)

    @property
    def table(self) -> NDArray[np.uint8]:
        """sRGB in equal steps from the first stop to the last, and that of the unknown, (SHADES + 1, 3)."""
        return _table(self.stops)

    def to_page(self) -> dict[str, object]:
        stops = [[round(value, 4), colour] for value, colour in self.stops]
        return {
            "type": "legend",
            "layer": self.layer,
            "label": self.label,
            "unit": self.unit,
            "stops": stops,
            "unknown": UNKNOWN_COLOUR,
        }


@lru_cache(maxsize=64)
def _table(stops: tuple[tuple[float, str], ...]) -> NDArray[np.uint8]:
    """Colours in `SHADES` equal steps from the first stop to the last, and that of the unknown, (SHADES + 1, 3)."""
    places = np.linspace(stops[0][0], stops[-1][0], SHADES)
    colours = np.array([_rgb(colour) for _, colour in stops], dtype=np.float64)
    mixed = [np.interp(places, [stop for stop, _ in stops], colours[:, channel]) for channel in range(3)]
    table = np.concatenate([np.stack(mixed, axis=-1), [_rgb(UNKNOWN_COLOUR)]])
    return np.asarray(np.rint(table), dtype=np.uint8)


def legend(layer: str, elevation_range: tuple[float, float] | None = None) -> Legend:
    """The scale of a layer; elevation's follows the known heights in steps of 10 cm, so that it seldom changes."""
    if layer == "elevation":
        low, high = elevation_range or (0.0, 0.0)
        low, high = np.floor(low * 10 - 0.5) / 10, np.ceil(high * 10 + 0.5) / 10
        return Legend(layer=layer, label="Elevation", unit="m", stops=_spread(float(low), float(high), _EARTH))
    if layer == "roughness":
        return Legend(layer=layer, label="Roughness", unit="0 to 1", stops=_spread(0.0, 1.0, _HEAT))
    if layer == "step_height":
        return Legend(layer=layer, label="Step height", unit="0 to 1", stops=_spread(0.0, 1.0, _VIRIDIS))
    if layer == "uncertainty":
        return Legend(layer=layer, label="Uncertainty", unit="m", stops=_spread(0.0, 0.06, _VIRIDIS[::-1]))
    if layer == "age":
        return Legend(layer=layer, label="Age", unit="s", stops=_spread(0.0, 254.0, _FADE))
    raise ValueError(f"layer {layer!r} is unknown; known are {', '.join(LAYERS)}")


def layer_field(layer: str) -> str:
    """The field of a map tile that holds a layer."""
    return {"elevation": "elevation_mm", "uncertainty": "sigma_mm", "age": "age_s"}.get(layer, layer)


def layer_values(tile: MapTile, layer: str) -> Array:
    """Values (size, size) of a layer in its legend's unit, NaN where unknown."""
    if layer == "elevation":
        return np.where(tile.elevation_mm == UNKNOWN_MM, np.nan, tile.elevation_mm * 1e-3)
    if layer == "uncertainty":
        return np.where(tile.sigma_mm == 255, np.nan, tile.sigma_mm * 1e-3)
    if layer == "age":
        return np.where(tile.age_s == 255, np.nan, tile.age_s.astype(np.float64))
    indices = tile.roughness if layer == "roughness" else tile.step_height
    return np.where(indices == 255, np.nan, np.minimum(indices, 200) / 200.0)


TRANSPORT = Legend(
    layer="transport",
    label="Cost of transport",
    unit="",
    stops=((2.0, "#2c6e63"), (6.0, "#a3bd5c"), (10.0, "#e3d35f"), (15.0, "#d96c3c"), (20.0, "#b03034")),
)
"""The trail's scale: energy over weight and way (ICRA'17 eq. 12)."""

TORQUE = Legend(
    layer="torque",
    label="Joint torque",
    unit="of stall",
    stops=((0.0, "#2c3038"), (0.25, "#3d6fa5"), (0.5, "#e3d35f"), (0.8, "#d96c3c"), (1.0, "#d01c1c")),
)


def _spread(low: float, high: float, colours: tuple[str, ...]) -> tuple[tuple[float, str], ...]:
    places = np.linspace(low, high, len(colours))
    return tuple((float(place), colour) for place, colour in zip(places, colours, strict=True))


def _rgb(colour: str) -> tuple[int, int, int]:
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
