"""Where a study keeps its results and its report."""

from __future__ import annotations

from pathlib import Path

from weaver_shared.errors import InputError


def made_folder(folder: Path) -> Path:
    """The folder, made if it is missing. Raises InputError where it can not be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder} can not be made a folder: {error.strerror}") from error
    return folder
