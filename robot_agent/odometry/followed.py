"""Where features were followed in the newest left picture, for people to look at; the estimate does not use it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Followed(NamedTuple):
    """All in px of the left picture; `rejected` were found again, but not where one motion of the eye leads them."""

    identity: NDArray[np.int64]  # (n,)
    pixel: Array  # (n, 2)
    both: NDArray[np.bool_]  # (n,) found in the right picture too
    rejected: Array  # (m, 2)

    @staticmethod
    def nothing() -> Followed:
        return Followed(np.zeros(0, dtype=np.int64), np.zeros((0, 2)), np.zeros(0, dtype=np.bool_), np.zeros((0, 2)))

    def without(self, identities: NDArray[np.int64]) -> Followed:
        """With these given up as wrong."""
        wrong = np.isin(self.identity, identities)
        rejected = np.concatenate([self.rejected, self.pixel[wrong]])
        return Followed(self.identity[~wrong], self.pixel[~wrong], self.both[~wrong], rejected)
