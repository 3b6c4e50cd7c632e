"""Maps as NPZ files that nothing is lost in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.mapping.files.snapshot import LAYERS, MapSnapshot
from weaver_shared.errors import InputError
from weaver_shared.npz_files import read_npz

VERSION = 1
KIND = "weaver terrain map"
HEIGHTS = ("elevation", "upper", "ceiling", "contact")
FARTHEST = 1_000_000  # m from the world's origin, and the highest a cell may lie: beyond it float32 knows no decimetres


def save_map(path: Path, snapshot: MapSnapshot) -> None:
    """Raises InputError when the file can not be written."""
    arrays: dict[str, Any] = {
        "kind": KIND,
        "version": VERSION,
        "resolution": snapshot.cell,
        "row0": snapshot.row0,
        "column0": snapshot.column0,
        "seen_ns": snapshot.seen_ns,
        **snapshot.layers,
    }
    try:
        with path.open("wb") as stream:
            np.savez_compressed(stream, **arrays)
    except OSError as error:
        raise InputError(f"{path} can not be written: {error.strerror}") from error


def load_map(path: Path) -> MapSnapshot:
    """Raises InputError that says what is wrong with a file that is not a whole map of this version."""
    arrays = read_npz(path, "a map is an .npz file as `weaver walk --map` writes it")
    if str(arrays.get("kind")) != KIND:
        found = ", ".join(sorted(arrays)) or "nothing"
        raise InputError(f"{path} is not a map: it holds {found}, and nothing says {KIND!r}")
    version = arrays.get("version")
    if version is None or version.shape != () or version != VERSION:
        raise InputError(f"{path} is a map of version {version}; this program reads version {VERSION}")
    missing = [name for name in ("resolution", "row0", "column0", "seen_ns", *LAYERS) if name not in arrays]
    if missing:
        raise InputError(f"{path} is a map without {', '.join(missing)}")
    shape = arrays["seen_ns"].shape
    wrong = [name for name in LAYERS if arrays[name].shape != shape]
    if len(shape) != 2 or wrong:
        raise InputError(f"{path}: layers of different shapes ({', '.join(wrong) or 'seen_ns'} is not {shape})")
    if not arrays["seen_ns"].size or arrays["seen_ns"].dtype.kind not in "iu":
        raise InputError(f"{path}: seen_ns has to be whole nanoseconds of at least one cell")
    cell = _number(arrays, "resolution", path)
    if not cell > 0.0:
        raise InputError(f"{path}: cells of {cell} m; their length must be positive")
    row0, column0 = (_number(arrays, name, path) for name in ("row0", "column0"))
    for name, first in (("row0", row0), ("column0", column0)):
        if not first.is_integer() or abs(first) * cell > FARTHEST:
            raise InputError(f"{path}: {name} {first} is no whole number of cells within {FARTHEST} m of the origin")
    return MapSnapshot(
        row0=int(row0),
        column0=int(column0),
        cell=cell,
        layers={name: _layer(arrays[name], name, path) for name in LAYERS},
        seen_ns=arrays["seen_ns"].astype(np.int64),
    )


def _number(arrays: dict[str, NDArray[Any]], name: str, path: Path) -> float:
    array = arrays[name]
    if array.shape != () or array.dtype.kind not in "fiu" or not np.isfinite(array):
        raise InputError(f"{path}: {name} has to be one number, not {array}")
    return float(array)


def _layer(array: NDArray[Any], name: str, path: Path) -> NDArray[np.float32]:
    """As float32, NaN unknown."""
    if array.dtype.kind not in "fiu":
        raise InputError(f"{path}: {name} has to be numbers, not {array.dtype}")
    known = array[~np.isnan(array)]
    if len(known) and float(np.abs(known).max()) > FARTHEST:
        raise InputError(f"{path}: {name} holds {known[np.abs(known).argmax()]}, more than any map has")
    if name not in HEIGHTS and (known < 0).any():
        raise InputError(f"{path}: {name} holds {known.min()}, and can not be negative")
    return array.astype(np.float32)
