"""Sensor noise of a camera, drawn once and shifted from picture to picture."""

import cv2
import numpy as np
from numpy.typing import NDArray

SIGMA = 1.5  # grey levels
SHIFTS = 64


class SensorNoise:
    """White noise; which piece of the bank a picture gets depends on its sequence number alone."""

    def __init__(self, width: int, height: int, generator: np.random.Generator) -> None:
        bank = generator.standard_normal((height + SHIFTS, width + SHIFTS), dtype=np.float32) * SIGMA
        self._bank = np.rint(bank).astype(np.int8)
        self._size = height, width

    def add(self, picture: NDArray[np.uint8], sequence: int) -> NDArray[np.uint8]:
        """A noisy copy of a picture (height, width)."""
        height, width = self._size
        row, column = (sequence * 37) % SHIFTS, (sequence * 23 + sequence // SHIFTS) % SHIFTS
        noise = self._bank[row : row + height, column : column + width]
        noisy: NDArray[np.uint8] = cv2.add(picture, noise, dtype=cv2.CV_8U)
        return noisy
