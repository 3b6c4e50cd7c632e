"""What every source of stereo pairs is for the process that reads it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from weaver_shared.messages import StereoFrame


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraHealth:
    """Of the pictures since the source was opened."""

    pairs: int
    lost: int  # pictures without the other eye's, incomplete ones included
    trouble: str  # empty: none


class StereoSource(Protocol):
    def read(self, timeout: float) -> StereoFrame | None:
        """The next pair, stamped at mid-exposure on the robot's clock, or None when none came within `timeout` s."""
        ...

    def health(self) -> CameraHealth: ...

    def close(self) -> None: ...
