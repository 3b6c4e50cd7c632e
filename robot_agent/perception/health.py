"""How far a pair of pictures can be trusted: contrast, sharpness, agreement of the eyes and density of matches.

Density alone hides trouble: at a tenth of the light it is still 0.98 while a sixth of the matches is wrong.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from weaver_shared.config.perception import HealthConfig

Picture = NDArray[np.uint8]

WINDOW = 4  # px to each side of a sample
STRIDE = 12  # px between samples
FEWEST_WINDOWS = 20
WORTH_SAYING = 0.8  # a score below this comes with its reason


@dataclass(frozen=True, slots=True, kw_only=True)
class PictureHealth:
    """Measures of a matched pair and the score 0..1, the product of what each of them gives."""

    contrast: float  # grey levels: median standard deviation of small windows of the darker eye
    sharpness: float  # detail from pixel to pixel over contrast, of the less detailed direction
    consistency: float  # mean correlation of matched windows
    row_error: float  # px by which one eye's rows lie lower than the other's
    density: float  # share of sampled pixels with a match
    score: float
    reason: str  # what is worst, empty when all is well


def assess(left: Picture, right: Picture, disparity: NDArray[np.int16], config: HealthConfig) -> PictureHealth:
    """Judge rectified pictures and their disparity (height, width), the latter in sixteenths of a pixel."""
    windows = _windows(left, right, disparity, WINDOW, STRIDE)
    matched = windows[windows[:, 4] > -2.0]
    contrast = float(min(np.median(windows[:, 0]), np.median(windows[:, 1])))
    sharpness = float(np.median(windows[:, 2:4], axis=0).min())
    enough = len(matched) >= FEWEST_WINDOWS
    consistency = float(matched[:, 4].mean()) if enough else 0.0
    row_error = float(np.median(matched[:, 5])) if enough else 0.0
    density = len(matched) / max(1, len(windows))
    scores = {
        "the pictures have too little contrast": _score(contrast, config.contrast),
        "the pictures are blurred": _score(sharpness, config.sharpness),
        "the eyes do not agree": _score(consistency, config.consistency),
        "the eyes' rows are out of line": _score(-abs(row_error), (-config.row_error[0], -config.row_error[1])),
        "too little of the ground is matched": _score(density, config.density),
    }
    reason = min(scores, key=lambda name: scores[name])
    score = float(np.prod(list(scores.values())))
    return PictureHealth(
        contrast=contrast,
        sharpness=sharpness,
        consistency=consistency,
        row_error=row_error,
        density=density,
        score=score,
        reason=reason if score < WORTH_SAYING else "",
    )


def _score(value: float, bad_good: tuple[float, float]) -> float:
    bad, good = bad_good
    return float(np.clip((value - bad) / (good - bad), 0.0, 1.0))


@njit(cache=True)
def _windows(
    left: Picture, right: Picture, disparity: NDArray[np.int16], half: int, stride: int
) -> NDArray[np.float64]:
    """Rows of: deviation left, right; detail along x, y over deviation; correlation (-3 unmatched); row offset."""
    height, width = left.shape
    columns = max(0, (width - 2 * half - 4) // stride)
    rows = max(0, (height - 2 * half - 4) // stride)
    result = np.zeros((rows * columns, 6))
    for k in range(rows * columns):
        v = half + 2 + (k // columns) * stride
        u = half + 2 + (k % columns) * stride
        deviation = _deviation(left, v, u, half)
        result[k, 0] = deviation
        result[k, 1] = _deviation(right, v, u, half)
        result[k, 2] = _detail(left, v, u, half, 0, 1) / (deviation + 1.0)
        result[k, 3] = _detail(left, v, u, half, 1, 0) / (deviation + 1.0)
        result[k, 4] = -3.0
        shift = (disparity[v, u] + 8) // 16
        if disparity[v, u] > 0 and u - shift >= half:
            middle = _correlation(left, right, v, u, v, u - shift, half)
            above = _correlation(left, right, v, u, v - 1, u - shift, half)
            below = _correlation(left, right, v, u, v + 1, u - shift, half)
            result[k, 4] = max(above, middle, below)
            curvature = above - 2.0 * middle + below
            if curvature < 0.0:
                result[k, 5] = min(1.0, max(-1.0, 0.5 * (above - below) / curvature))
            else:
                result[k, 5] = 1.0 if below > above else -1.0
    return result


@njit(cache=True)
def _deviation(picture: Picture, v: int, u: int, half: int) -> float:
    total, squares, n = 0.0, 0.0, (2 * half + 1) ** 2
    for i in range(v - half, v + half + 1):
        for j in range(u - half, u + half + 1):
            value = float(picture[i, j])
            total += value
            squares += value * value
    return float(np.sqrt(max(0.0, squares / n - (total / n) ** 2)))


@njit(cache=True)
def _detail(picture: Picture, v: int, u: int, half: int, down: int, right: int) -> float:
    """Mean absolute difference of pixels two apart in one direction."""
    total = 0.0
    for i in range(v - half, v + half + 1):
        for j in range(u - half, u + half + 1):
            total += abs(float(picture[i + down, j + right]) - float(picture[i - down, j - right]))
    return total / (2 * half + 1) ** 2


@njit(cache=True)
def _correlation(left: Picture, right: Picture, v: int, u: int, v_right: int, u_right: int, half: int) -> float:
    """Normalised cross-correlation of two windows, -1..1; 0 where one of them is constant."""
    a = b = aa = bb = ab = 0.0
    n = (2 * half + 1) ** 2
    for i in range(-half, half + 1):
        for j in range(-half, half + 1):
            p = float(left[v + i, u + j])
            q = float(right[v_right + i, u_right + j])
            a += p
            b += q
            aa += p * p
            bb += q * q
            ab += p * q
    spread = (aa - a * a / n) * (bb - b * b / n)
    if spread <= 1e-9:
        return 0.0
    return float((ab - a * b / n) / np.sqrt(spread))
