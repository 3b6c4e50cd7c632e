"""A picture as another view of the same ground would show it, so that only what is not ground moves between the two.

A walker's eyes look at the ground at a slant, so that a square of the left picture is sheared in the right one, by a
third of a pixel a row. A search that only shifts squares then matches whichever part has more contrast, which is the
nearer one: far points came out 0.09 px too near, near ones 0.2 px noisy. Against the warped picture no shear is left,
and the noise is a tenth. Coming closer between two pictures does the same, to a lesser degree.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.vision.camera import PinholeCamera
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]

MOST_STRETCH = 1.5
"""A plane that stretches or squeezes the picture further than this is not the ground."""


def ground_warp(
    first: PinholeCamera, second: PinholeCamera, second_from_first: Pose, inverse_depth: Array | None
) -> Array | None:
    """Homography (3, 3) from the first view's pixels to the second's, by the plane of `inverse_depth` (3,) over x, y, 1
    in the first; None without a plane, or where it can not be the ground.

    The lenses' distortion is left out: what the warped picture lacks of being like the first one, the search finds.
    """
    if inverse_depth is None:
        return None
    on_plane = second_from_first.rotation + np.outer(second_from_first.position, inverse_depth)
    warp = second.matrix @ on_plane @ np.linalg.inv(first.matrix)
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) * [first.width, first.height]
    scale = warp[2, :2] @ corners.T + warp[2, 2]
    if (scale <= 0.0).any():
        return None
    moved = carried(warp, corners)
    sides = np.linalg.norm(moved - np.roll(moved, 1, axis=0), axis=1)
    stretch = sides / np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
    return warp if stretch.max() < MOST_STRETCH and stretch.min() > 1.0 / MOST_STRETCH else None


def warped(second: Picture, warp: Array | None) -> Picture:
    """The second view's picture as the first would show it."""
    if warp is None:
        return second
    return np.asarray(
        cv2.warpPerspective(
            second,
            warp,
            (second.shape[1], second.shape[0]),
            flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
            borderMode=cv2.BORDER_REPLICATE,
        ),
        dtype=np.uint8,
    )


def carried(warp: Array | None, pixel: Array) -> Array:
    """Pixels (n, 2) through a homography; where they are without one."""
    if warp is None:
        return pixel
    homogeneous = np.column_stack([pixel, np.ones(len(pixel))]) @ warp.T
    return np.asarray(homogeneous[:, :2] / homogeneous[:, 2:])
