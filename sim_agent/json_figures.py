"""Figures as JSON can hold them."""

from __future__ import annotations

from math import isfinite
from typing import Any


def without_nan(value: Any) -> Any:
    """The same dicts, lists and numbers; what is not finite, and so not known, becomes None."""
    if isinstance(value, dict):
        return {key: without_nan(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [without_nan(item) for item in value]
    return None if isinstance(value, float) and not isfinite(value) else value
