"""What an operator wants of the legs' posture."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class PostureOrder:
    """Begun once, when `serial` rises; one that can not be begun then is dropped."""

    name: str
    serial: int


NO_POSTURE_ORDER = PostureOrder(name="", serial=0)
