"""Fields of blocks with smoothly random heights: rough ground a foot can stand on."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from sim_agent.worlds.scene import Box

Array = NDArray[np.float64]

DEPTH = 0.30
"""How far blocks reach below the lowest top (m), so that no foot slips in under them."""


def smooth_random_heights(
    rows: int, columns: int, *, difference: float, smoothing: float, generator: np.random.Generator
) -> Array:
    """Heights (rows, columns) whose largest difference is `difference` (m), settling to 0 at both ends of the rows.

    `smoothing` is the width of the Gaussian over white noise in blocks: neighbours step less when it is larger.
    """
    noise = generator.standard_normal((rows, columns))
    field: Array = gaussian_filter(noise, smoothing, mode="reflect")
    field -= field.mean()
    ends = np.minimum(np.arange(rows), np.arange(rows)[::-1])
    field *= np.clip((ends + 1) / 3.0, 0.0, 1.0)[:, None]
    scaled: Array = field * (difference / (field.max() - field.min()))
    return scaled


def block_field(heights: Array, *, x0: float, cell: float, base: float, material: str) -> tuple[Box, ...]:
    """One upright block per height, rows along x from `x0`, columns centred on y = 0, tops at base + height."""
    rows, columns = heights.shape
    y0 = -columns * cell / 2
    floor = float(heights.min()) - DEPTH
    return tuple(
        Box.under(
            x=(x0 + row * cell, x0 + (row + 1) * cell),
            y=(y0 + column * cell, y0 + (column + 1) * cell),
            top=base + float(heights[row, column]),
            depth=float(heights[row, column]) - floor,
            material=material,
        )
        for row in range(rows)
        for column in range(columns)
    )
