"""Maps as NPZ files that nothing is lost in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from robot_agent.mapping.files.snapshot import LAYERS, MapSnapshot
from weaver_shared.errors import InputError
from weaver_shared.npz_files import read_npz

VERSION = 1
KIND = "weaver terrain map"


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
    if version is None or version.shape != () or int(version) != VERSION:
        raise InputError(f"{path} is a map of version {version}; this program reads version {VERSION}")
    missing = [name for name in ("resolution", "row0", "column0", "seen_ns", *LAYERS) if name not in arrays]
    if missing:
        raise InputError(f"{path} is a map without {', '.join(missing)}")
    shape = arrays["seen_ns"].shape
    wrong = [name for name in LAYERS if arrays[name].shape != shape]
    if len(shape) != 2 or wrong:
        raise InputError(f"{path}: layers of different shapes ({', '.join(wrong) or 'seen_ns'} is not {shape})")
    cell = float(arrays["resolution"])
    if not (np.isfinite(cell) and cell > 0.0):
        raise InputError(f"{path}: cells of {cell} m; their length must be positive")
    return MapSnapshot(
        row0=int(arrays["row0"]),
        column0=int(arrays["column0"]),
        cell=cell,
        layers={name: arrays[name].astype(np.float32) for name in LAYERS},
        seen_ns=arrays["seen_ns"].astype(np.int64),
    )
