"""Named arrays from an .npz file, or a sentence that says why not."""

from __future__ import annotations

import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError

DAMAGE = (
    OSError,
    ValueError,
    EOFError,
    KeyError,
    NotImplementedError,
    RuntimeError,
    SyntaxError,
    tokenize.TokenError,
    zipfile.BadZipFile,
    zlib.error,
)
"""What reading an archive raises when single bits of it are wrong: its directory, an array's head, packed data."""


def read_npz(path: Path, what: str) -> dict[str, NDArray[Any]]:
    """All arrays of the file. Raises InputError that says what was found and that `what` is expected.

    `what` is a clause such as "a map is an .npz file with named arrays".
    """
    if not path.is_file():
        raise InputError(f"{path} is not a file; {what}")
    try:
        with path.open("rb") as stream:
            archive = np.load(stream, allow_pickle=False)
            if not isinstance(archive, Mapping):
                raise InputError(f"{path} holds a bare array; {what}")
            return {key: archive[key] for key in archive}
    except DAMAGE as error:
        raise InputError(f"{path} can not be read as an .npz file: {error}") from error
