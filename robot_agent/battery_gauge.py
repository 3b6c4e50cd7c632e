"""The battery's state as its cut-off sees it: without the sag of a step's current, and without a moment's dip."""

from __future__ import annotations

from math import exp, isfinite, nan

RESISTANCE = 0.042  # ohm of a pack of seven cells of 6 mohm (chosen: a fresh one of 5 A h)
TIME_CONSTANT = 2.0  # s


class BatteryGauge:
    """Rest voltage, filtered; NaN until a reading came, the last one while none comes."""

    def __init__(self) -> None:
        self._voltage = nan
        self._stamp_ns = 0

    def step(self, voltage: float, current: float, stamp_ns: int) -> float:
        """V at rest of V under load and the A drawn then."""
        if isfinite(voltage) and isfinite(current):
            rest = voltage + RESISTANCE * current
            share = 1.0 - exp(-(stamp_ns - self._stamp_ns) * 1e-9 / TIME_CONSTANT)
            self._voltage = self._voltage + share * (rest - self._voltage) if isfinite(self._voltage) else rest
        self._stamp_ns = stamp_ns
        return self._voltage
