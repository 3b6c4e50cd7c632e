"""What became of looking at one pair of pictures at full resolution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robot_agent.perception.terrain import PerceivedTerrain


@dataclass(frozen=True, slots=True, kw_only=True)
class CloseLook:
    """Cells of the map that were measured and the median standard deviation of their heights; none with a reason."""

    stamp_ns: int
    cells: int
    sigma: float  # m, NaN without cells
    reason: str  # why nothing was measured

    @staticmethod
    def of(perceived: PerceivedTerrain) -> CloseLook:
        variance = perceived.grid.variance[np.isfinite(perceived.grid.elevation)]
        if not len(variance):
            reason = perceived.estimate.reason or "no ground is in sight"
            return CloseLook(stamp_ns=perceived.stamp_ns, cells=0, sigma=float("nan"), reason=reason)
        sigma = float(np.sqrt(np.median(variance)))
        return CloseLook(stamp_ns=perceived.stamp_ns, cells=len(variance), sigma=sigma, reason="")
