"""How far the view has moved over a while: a body that creeps, or sways slowly, does not stand still.

From one picture to the next both look like rest. Taken for rest again and again, they lead the estimate astray: of a
body that creeps one way and is thrown back the other, only the throws would count.
"""

from __future__ import annotations

from collections import deque
from math import inf, isnan, nan

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.tracks import Tracks

FEWEST = 8
"""Features seen then and now that can tell."""


class SeenMotion:
    """Remembers where features were `duration` s ago."""

    def __init__(self, duration: float, focal_length: float) -> None:
        self._duration_ns = round(duration * 1e9)
        self._focal_length = focal_length  # px
        self._past: deque[tuple[int, NDArray[np.int64], NDArray[np.float64]]] = deque()
        self._told: deque[tuple[int, float]] = deque()  # stamps and motions of the last `duration`

    def forget(self) -> None:
        """Time begins anew."""
        self._past.clear()
        self._told.clear()

    def step(self, stamp_ns: int, tracks: Tracks) -> float:
        """Median motion of the left eye's features, px, over `duration`, the largest of the last pictures.

        NaN where nothing is known; infinite where all features have been lost.
        """
        self._told.append((stamp_ns, self._motion(stamp_ns, tracks)))
        while self._told[0][0] <= stamp_ns - self._duration_ns:
            self._told.popleft()
        known = [motion for _, motion in self._told if not isnan(motion)]
        return max(known, default=nan)

    def _motion(self, stamp_ns: int, tracks: Tracks) -> float:
        self._past.append((stamp_ns, tracks.identity, tracks.observation[:, 0]))
        while len(self._past) > 1 and self._past[1][0] <= stamp_ns - self._duration_ns:
            self._past.popleft()
        _, identity, then = self._past[0]
        if min(len(identity), tracks.number) < FEWEST:
            return nan
        _, past, now = np.intersect1d(identity, tracks.identity, assume_unique=True, return_indices=True)
        if len(past) < FEWEST:
            return inf
        motion = np.linalg.norm(tracks.observation[now, 0] - then[past], axis=1)
        return self._focal_length * float(np.median(motion))
