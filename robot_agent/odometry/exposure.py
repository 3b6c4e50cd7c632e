"""Is there anything to see in a picture, and do both eyes see it equally bright?"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.odometry import FrontEndConfig

Picture = NDArray[np.uint8]


def picture_problem(picture: Picture, width: int, height: int, config: FrontEndConfig) -> str:
    """Why a picture is of no use, in a few words; empty when it is."""
    if picture.ndim != 2 or picture.size == 0:
        return "missing"
    if picture.shape != (height, width):
        return f"{picture.shape[1]}x{picture.shape[0]} instead of {width}x{height}"
    mean, deviation = _brightness(picture)
    if mean < config.dark_mean:
        return "black"
    if deviation < config.flat_deviation:
        return "without contrast"
    return ""


def matched(picture: Picture, reference: Picture) -> Picture:
    """`picture` with the brightness and contrast of `reference`: real eyes are exposed each on their own."""
    (mean, deviation), (other_mean, other_deviation) = _brightness(picture), _brightness(reference)
    gain = min(max(other_deviation / max(deviation, 1e-3), 0.25), 4.0)
    offset = other_mean - gain * mean
    if abs(gain - 1.0) < 0.03 and abs(offset) < 3.0:
        return picture
    line = np.clip(gain * np.arange(256.0) + offset, 0.0, 255.0).astype(np.uint8)
    return np.asarray(cv2.LUT(picture, line), dtype=np.uint8)


def _brightness(picture: Picture) -> tuple[float, float]:
    """Mean and standard deviation of a sample of the grey values."""
    mean, deviation = cv2.meanStdDev(np.ascontiguousarray(picture[::8, ::8]))
    return float(mean[0, 0]), float(deviation[0, 0])
