"""Where an emulated robot keeps its ports, its wiring and its time."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path


def twin_folder(robot_id: str) -> Path:
    """One for each robot and user of this computer; it may not exist yet."""
    return Path(tempfile.gettempdir()) / f"weaver-twin-{os.getuid()}-{robot_id}"
