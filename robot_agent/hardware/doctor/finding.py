"""What one check found, in a sentence for people and in figures for programs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from enum import StrEnum
from typing import Any


class Verdict(StrEnum):
    GOOD = "good"
    ATTENTION = "attention"  # it works, and somebody should know
    WRONG = "wrong"
    NOT_TESTED = "not tested"


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    check: str
    verdict: Verdict
    found: str
    fix: str = ""
    figures: Mapping[str, Any] = field(default_factory=dict)

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


def not_tested(check: str, why: str, fix: str = "") -> Finding:
    return Finding(check=check, verdict=Verdict.NOT_TESTED, found=why, fix=fix)


def named(things: list[str], most: int = 4) -> str:
    """A few of them by name, and how many more there are."""
    more = f" and {len(things) - most} more" if len(things) > most else ""
    return ", ".join(things[:most]) + more
