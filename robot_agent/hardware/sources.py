"""What a body has beside its servos, each on a serial line of its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from weaver_shared.messages import ImuBatch


@dataclass(frozen=True, slots=True, kw_only=True)
class PowerReading:
    """The battery as the power monitor sees it."""

    stamp_ns: int
    voltage: float
    current: float  # A drawn
    energy: float  # J drawn since the monitor was switched on


class InertialSource(Protocol):
    def take(self, now_ns: int) -> ImuBatch:
        """Samples since the last call, stamped on the robot's clock; none where the IMU is silent."""
        ...

    def close(self) -> None: ...


class PowerSource(Protocol):
    def take(self, now_ns: int) -> PowerReading | None:
        """The newest reading since the last call, or None."""
        ...

    def close(self) -> None: ...
