"""A robot's folder of recordings: their names, how long they are, and parts of them for who downloads one."""

from __future__ import annotations

import re
import shutil
from datetime import datetime
from pathlib import Path

from robot_agent.recording.file_format import SUFFIX
from robot_agent.recording.file_parts import file_part
from robot_agent.recording.reader import open_recording
from robot_agent.recording.span import recorded_span
from weaver_shared.errors import InputError, ResourceError
from weaver_shared.messages import PartRequest, RecordingEntry, RecordingPart

MOST_LISTED = 50
_NAME = re.compile(rf"[A-Za-z0-9_-][A-Za-z0-9_.-]{{0,100}}{re.escape(SUFFIX)}")


class RecordingStore:
    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._known: dict[tuple[str, int, int], RecordingEntry | None] = {}

    def new_path(self, robot_id: str, started: datetime) -> Path:
        """A name that is not taken."""
        stem = f"{robot_id}_{started:%Y-%m-%d_%H-%M-%S}"
        path = self.folder / f"{stem}{SUFFIX}"
        number = 2
        while path.exists():
            path = self.folder / f"{stem}_{number}{SUFFIX}"
            number += 1
        return path

    def entries(self, active: str = "") -> tuple[RecordingEntry, ...]:
        """The newest recordings, but not the one being written; files that are none of ours are left out."""
        paths = sorted(self.folder.glob(f"*{SUFFIX}")) if self.folder.is_dir() else []
        ours = [path for path in paths if path.name != active and _NAME.fullmatch(path.name)]
        found = [entry for path in ours if (entry := self._entry(path)) is not None]
        return tuple(sorted(found, key=lambda entry: entry.started, reverse=True)[:MOST_LISTED])

    def free(self) -> int:
        """B left on the disk."""
        folder = self.folder
        while not folder.exists() and folder != folder.parent:
            folder = folder.parent
        return shutil.disk_usage(folder).free

    def path(self, name: str) -> Path:
        """Where a recording lies. Raises ResourceError when the name is none of a file here."""
        if not _NAME.fullmatch(name):
            raise ResourceError(f"{name!r:.60} is not the name of a recording")
        return self.folder / name

    def part(self, request: PartRequest) -> RecordingPart:
        """Some of a file's bytes; never raises."""
        return file_part(self.folder, _NAME, request)

    def _entry(self, path: Path) -> RecordingEntry | None:
        try:
            status = path.stat()
            key = (path.name, status.st_size, status.st_mtime_ns)
            if key not in self._known:
                self._known[key] = _described(path, status.st_size)
            return self._known[key]
        except OSError:
            return None


def _described(path: Path, size: int) -> RecordingEntry | None:
    try:
        about = open_recording(path).about
    except InputError:
        return None
    seconds, whole = recorded_span(path)
    return RecordingEntry(
        name=path.name, started=about.started, seconds=seconds, size=size, pictures=about.pictures, whole=whole
    )
