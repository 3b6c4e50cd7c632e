"""What the ground is made of: how it holds a foot and how it looks."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """Ground of one kind. A foot has friction 1, so `friction` is the pair's Coulomb coefficient.

    `stiffness` (N/m) and `damping` (N s/m) make a yielding contact; None is rigid. `brightness` and `contrast` are
    grey levels (0..1) of its picture, `pebble` the size of its coarse grain (m), `tint` its colour for people.
    """

    name: str
    friction: float
    brightness: float
    contrast: float
    pebble: float
    tint: tuple[float, float, float]
    stiffness: float | None = None
    damping: float | None = None


# Frictions and compliances are chosen; a 33 N foot sinks 5 mm into the sand and 1 mm into the gravel.
_TABLE = (
    Material(name="board", friction=0.8, brightness=0.58, contrast=0.15, pebble=0.012, tint=(1.0, 0.86, 0.66)),
    Material(name="wood", friction=0.7, brightness=0.50, contrast=0.17, pebble=0.010, tint=(1.0, 0.74, 0.50)),
    Material(
        name="sand",
        friction=0.5,
        brightness=0.62,
        contrast=0.13,
        pebble=0.006,
        tint=(1.0, 0.93, 0.70),
        stiffness=6000.0,
        damping=250.0,
    ),
    Material(
        name="gravel",
        friction=0.6,
        brightness=0.46,
        contrast=0.20,
        pebble=0.014,
        tint=(0.92, 0.94, 1.0),
        stiffness=30000.0,
        damping=300.0,
    ),
    Material(name="stone", friction=0.8, brightness=0.42, contrast=0.17, pebble=0.018, tint=(0.90, 0.95, 1.0)),
    Material(name="earth", friction=0.7, brightness=0.40, contrast=0.16, pebble=0.012, tint=(0.95, 0.86, 0.70)),
    Material(name="grass", friction=0.7, brightness=0.36, contrast=0.15, pebble=0.008, tint=(0.80, 1.0, 0.66)),
)

MATERIALS: dict[str, Material] = {material.name: material for material in _TABLE}
