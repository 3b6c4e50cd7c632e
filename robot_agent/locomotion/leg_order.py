"""What an operator wants of legs taken out of the standing robot's hands."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class LegOrder:
    """One leg held off the ground; either its tip is placed or its joints are turned."""

    leg: int
    tip: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m in body, from where the foot was lifted to
    joints: tuple[float, ...] | None = None  # rad; takes the place of `tip`
