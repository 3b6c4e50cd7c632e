"""Matches that do not reproduce the picture they were found in.

A surface nearer than the matcher searches has no right answer, and semi-global matching gives it wrong ones in islands
too large for a speckle filter, all of them too far away: pits in the map, right behind a block. Whatever is matched
rightly looks alike to both eyes; those do not.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
Disparity = NDArray[np.int16]
Mask = NDArray[np.bool_]

WINDOW = (7, 7)  # px


class PhotoConsistency:
    """Compares the left picture with the right one moved by the disparity, in windows and without their means."""

    def __init__(self, largest_difference: float, noise: float) -> None:
        """A window may differ by `largest_difference` of its own variance, and by what `noise` (grey values) gives."""
        self._share = largest_difference
        self._noise_squared = 2.0 * noise**2  # of two eyes

    def unlike(self, left: Picture, right: Picture, disparity: Disparity) -> Mask:
        """True (height, width) where the eyes see different things; `disparity` is in sixteenths of a pixel."""
        height, width = disparity.shape
        across = np.arange(width, dtype=np.float32) - disparity * np.float32(1.0 / 16.0)
        down = np.broadcast_to(np.arange(height, dtype=np.float32)[:, None], (height, width))
        moved = cv2.remap(right, across, np.ascontiguousarray(down), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
        seen = left.astype(np.float32)
        allowed = self._share * _variance(seen) + self._noise_squared
        return np.asarray(_variance(seen - moved) > allowed, dtype=np.bool_)


def _variance(picture: NDArray[np.float32]) -> NDArray[np.float32]:
    mean = cv2.blur(picture, WINDOW)
    return np.asarray(cv2.sqrBoxFilter(picture, cv2.CV_32F, WINDOW) - mean * mean, dtype=np.float32)
