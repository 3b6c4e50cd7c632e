"""How well the renderer keeps up, counted for its health report."""

import time

import numpy as np

from weaver_shared.messages import Health, LoopTiming


class RenderTiming:
    """Counts pictures between reports on the wall clock."""

    def __init__(self, rate: float) -> None:
        self._period = 1.0 / rate
        self._begin()

    def rendered(self, stamp_ns: int) -> None:
        self._finished.append(time.monotonic())
        self._stamps.append(stamp_ns)

    @property
    def seconds(self) -> float:
        """Wall time since the last report (s)."""
        return time.monotonic() - self._started

    def report(self, overruns: int) -> Health:
        """Timing since the last report; `overruns` counts scenes that came and went unseen."""
        wall, processor = self.seconds, time.process_time() - self._processor
        periods = np.diff(self._finished)
        timing = LoopTiming(
            name="render",
            stamp_ns=self._stamps[-1] if self._stamps else 0,
            rate=len(self._stamps) / wall,
            period_error_p99=float(np.percentile(np.abs(periods - self._period), 99)) if periods.size else 0.0,
            overruns=overruns,
            cpu_fraction=processor / wall,
            real_time_factor=self._simulated() / wall,
        )
        self._begin()
        return Health(
            stamp_ns=timing.stamp_ns,
            timings=(timing,),
            odometry_quality="",
            odometry_reason="",
            odometry_age=float("nan"),
            tracked_features=0,
            max_temperature=float("nan"),
        )

    def _simulated(self) -> float:
        """Simulated time (s) that the pictures since the last report cover."""
        return (self._stamps[-1] - self._stamps[0]) * 1e-9 + self._period if self._stamps else 0.0

    def _begin(self) -> None:
        self._started = time.monotonic()
        self._processor = time.process_time()
        self._finished: list[float] = []
        self._stamps: list[int] = []
