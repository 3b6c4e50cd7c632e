"""When a device's samples were taken, on the robot's clock: never when they arrived, which a busy computer delays."""

from __future__ import annotations

LARGEST_SKEW = 2e-4  # of two quartz clocks against each other
JUMP = 0.5  # s by which no delay changes: the device's clock began anew


class ClockMap:
    """Keeps the least delay between device and computer: bytes can be late, never early."""

    def __init__(self) -> None:
        self._offset_ns: float | None = None
        self._device_ns = 0
        self.resets = 0

    def observe(self, device_ns: int, arrived_ns: int) -> None:
        """A record with this time of the device's had arrived at `arrived_ns` of ours."""
        offset_ns = float(arrived_ns - device_ns)
        if self._offset_ns is None or abs(offset_ns - self._offset_ns) > JUMP * 1e9:
            self.resets += self._offset_ns is not None
            self._offset_ns = offset_ns
        else:
            # What the clocks may have drifted apart since, in the one direction that the least can not follow.
            drifted_ns = self._offset_ns + LARGEST_SKEW * max(device_ns - self._device_ns, 0)
            self._offset_ns = min(drifted_ns, offset_ns)
        self._device_ns = device_ns

    def at(self, device_ns: int) -> int:
        """Our time of a device's. Of records that came together observe all first: the last was the least delayed."""
        return device_ns + round(self._offset_ns or 0.0)
