"""A map as a picture of costs with its YAML, as Nav2's map server and ROS's older one read them."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import yaml
from numpy.typing import NDArray

from robot_agent.mapping.files.snapshot import MapSnapshot
from weaver_shared.errors import InputError

FREE, OCCUPIED, UNKNOWN = 254, 0, 205
OCCUPIED_ABOVE, FREE_BELOW = 0.65, 0.196
"""The map server's usual thresholds; between them `mode: scale` keeps the cost as it is."""


def write_costmap(path: Path, snapshot: MapSnapshot) -> Path:
    """Write `path` (a .png) and the .yaml beside it; the cost of a cell is the worse of roughness and step height.

    Returns the path of the YAML. Raises InputError when they can not be written.
    """
    if path.suffix.lower() != ".png":
        raise InputError(f"{path}: a costmap is a .png; its .yaml is written beside it")
    description = path.with_suffix(".yaml")
    west, south = snapshot.corner
    text = yaml.safe_dump(
        {
            "image": path.name,
            "mode": "scale",
            "resolution": snapshot.cell,
            "origin": [west, south, 0.0],
            "negate": 0,
            "occupied_thresh": OCCUPIED_ABOVE,
            "free_thresh": FREE_BELOW,
        },
        sort_keys=False,
    )
    _, png = cv2.imencode(".png", picture_of(snapshot))
    try:
        path.write_bytes(png.tobytes())
        description.write_text(text)
    except OSError as error:
        raise InputError(f"{path} can not be written: {error.strerror}") from error
    return description


def picture_of(snapshot: MapSnapshot) -> NDArray[np.uint8]:
    """Grey levels (columns, rows): white free, black impassable, 205 unknown; the top row has the largest y."""
    cost = np.fmax(snapshot.layers["roughness"], snapshot.layers["step_height"])
    known = np.isfinite(cost) & np.isfinite(snapshot.layers["elevation"])
    grey = np.rint(FREE + (OCCUPIED - FREE) * np.clip(np.nan_to_num(cost), 0.0, 1.0)).astype(np.uint8)
    # The reader takes this one level for unknown.
    grey[grey == UNKNOWN] = UNKNOWN + 1
    return np.ascontiguousarray(np.where(known, grey, np.uint8(UNKNOWN)).T[::-1])
