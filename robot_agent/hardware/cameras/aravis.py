"""Aravis, the GenICam library, which Debian has for its own Python: `gir1.2-aravis-0.8` and `python3-gi`."""

from __future__ import annotations

import importlib
import importlib.util
import sys
import warnings
from functools import lru_cache
from pathlib import Path
from typing import Any

from weaver_shared.errors import ResourceError

DEBIAN = Path("/usr/lib/python3/dist-packages/gi")
PACKAGES = "gir1.2-aravis-0.8 python3-gi"


@lru_cache(maxsize=1)
def aravis() -> Any:
    """The library. Raises ResourceError that names the packages where it is missing."""
    try:
        gi = importlib.import_module("gi") if importlib.util.find_spec("gi") else _debians()
        gi.require_version("Aravis", "0.8")
        with warnings.catch_warnings():
            # Its importer is of an older kind than Python would like.
            warnings.simplefilter("ignore", ImportWarning)
            return importlib.import_module("gi.repository.Aravis")
    except (ImportError, ValueError) as error:
        raise ResourceError(f"GenICam cameras need Aravis: apt-get install {PACKAGES} ({error})") from error


def _debians() -> Any:
    """A virtual environment does not see Debian's packages, and this one is not on PyPI as a wheel."""
    spec = importlib.util.spec_from_file_location(
        "gi", DEBIAN / "__init__.py", submodule_search_locations=[str(DEBIAN)]
    )
    if spec is None or spec.loader is None or not DEBIAN.exists():
        raise ImportError("Debian's Python has no gi")
    module = importlib.util.module_from_spec(spec)
    sys.modules["gi"] = module
    spec.loader.exec_module(module)
    return module
