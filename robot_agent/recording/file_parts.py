"""Hands out a folder's files in parts, and nothing outside of it."""

from __future__ import annotations

import re
from pathlib import Path

from weaver_shared.messages import PartRequest, RecordingPart

LARGEST_PART = 4 * 1024 * 1024


def file_part(folder: Path, names: re.Pattern[str], request: PartRequest) -> RecordingPart:
    """Some bytes of a file whose name `names` lets through; never raises."""
    if not names.fullmatch(request.name):
        return _nothing(f"{request.name!r:.60} is not the name of a file here")
    if request.offset < 0 or not 0 <= request.length <= LARGEST_PART:
        return _nothing(f"a part begins at 0 or later and has up to {LARGEST_PART} B")
    path = folder / request.name
    try:
        with path.open("rb") as stream:
            stream.seek(request.offset)
            return RecordingPart(data=stream.read(request.length), size=path.stat().st_size, reason="")
    except OSError as error:
        return _nothing(f"{request.name} can not be read: {error.strerror}")


def _nothing(reason: str) -> RecordingPart:
    return RecordingPart(data=b"", size=0, reason=reason)
