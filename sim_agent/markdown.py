"""Cells and rows of Markdown tables."""

from __future__ import annotations

from collections.abc import Iterable


def row(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def word(value: bool | None) -> str:
    """Yes or no; a dash for what was not tried."""
    return "–" if value is None else "yes" if value else "no"


def number(value: float | None, digits: int) -> str:
    """With so many digits after the point; a dash for none."""
    return "–" if value is None else f"{value:.{digits}f}"
