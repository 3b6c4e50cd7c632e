"""A picture as another view of the same ground would show it, so that only what is not ground moves between the two.

A walker's eyes look at the ground at a slant, so that a square of the left picture is sheared in the right one, by a
third of a pixel a row. A search that only shifts squares then matches whichever part has more contrast, which is the
nearer one: far points came out 0.09 px too near, near ones 0.2 px noisy. Against the warped picture no shear is left,
and the noise is a tenth. Coming closer between two pictures does the same to a lesser degree, often not worth it.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.vision.camera import PinholeCamera
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]

LEAST_BEND = 0.5
"""px by which a followed square's corner must move against its middle before a picture is worth warping."""

MOST_STRETCH = 1.5
"""A plane that stretches or squeezes the picture further than this is not the ground."""


def ground_warp(
    first: PinholeCamera,
    second: PinholeCamera,
    second_from_first: Pose,
    inverse_depth: Array | None,
    square: float = 0.0,
) -> Array | None:
    """Homography (3, 3) from the first view's pixels to the second's, by the plane of `inverse_depth` (3,) over x, y, 1
    in the first; None without a plane, where it can not be the ground, or where it hardly bends a `square` (px) of it.

    The lenses' distortion is left out: what the warped picture lacks of being like the first one, the search finds.
    """
    if inverse_depth is None:
        return None
    size = np.array([first.width, first.height], dtype=np.float64)
    warp, is_ground = _plane_warp(
        first.matrix,
        second.matrix,
        np.ascontiguousarray(second_from_first.rotation),
        second_from_first.position,
        inverse_depth,
        size,
    )
    return warp if is_ground and (square == 0.0 or _bend(warp, size, 0.5 * square) > LEAST_BEND) else None


@compiled
def _bend(warp: Array, size: Array, half: float) -> float:
    """The farthest, in px, that the corner of a square of two `half` sides moves against its middle in the picture."""
    farthest = 0.0
    middle, corner = np.empty((1, 2)), np.empty((1, 2))
    for across in (0.1, 0.5, 0.9):
        for down in (0.1, 0.5, 0.9):
            middle[0, 0], middle[0, 1] = across * size[0], down * size[1]
            there = _carried(warp, middle)
            for side in (-half, half):
                corner[0, 0], corner[0, 1] = middle[0, 0] + half, middle[0, 1] + side
                moved = _carried(warp, corner) - there
                farthest = max(farthest, np.hypot(moved[0, 0] - half, moved[0, 1] - side))
    return farthest


@compiled
def _plane_warp(
    first: Array, second: Array, rotation: Array, position: Array, inverse_depth: Array, size: Array
) -> tuple[Array, bool]:
    """The homography between pictures of `size` (2,) px and these camera matrices; can it be the ground's?"""
    on_plane = np.empty((3, 3))
    for a in range(3):
        for b in range(3):
            on_plane[a, b] = rotation[a, b] + position[a] * inverse_depth[b]
    warp = second @ on_plane @ np.linalg.inv(first)
    corners = np.array([[0.0, 0.0], [size[0], 0.0], [size[0], size[1]], [0.0, size[1]]])
    for n in range(4):
        if warp[2, 0] * corners[n, 0] + warp[2, 1] * corners[n, 1] + warp[2, 2] <= 0.0:
            return warp, False
    moved = _carried(warp, corners)
    for n in range(4):
        side, before = moved[n] - moved[n - 1], corners[n] - corners[n - 1]
        stretch = np.sqrt(np.sum(side * side) / np.sum(before * before))
        if not 1.0 / MOST_STRETCH < stretch < MOST_STRETCH:
            return warp, False
    return warp, True


@compiled
def _carried(warp: Array, pixel: Array) -> Array:
    moved = np.empty(pixel.shape)
    for n in range(pixel.shape[0]):
        x, y = pixel[n, 0], pixel[n, 1]
        scale = 1.0 / (warp[2, 0] * x + warp[2, 1] * y + warp[2, 2])
        moved[n, 0] = scale * (warp[0, 0] * x + warp[0, 1] * y + warp[0, 2])
        moved[n, 1] = scale * (warp[1, 0] * x + warp[1, 1] * y + warp[1, 2])
    return moved


@compiled
def inverted(warp: Array) -> Array:
    """The homography back."""
    back: Array = np.linalg.inv(warp).astype(np.float64)
    return back


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
    return np.asarray(_carried(warp, np.ascontiguousarray(pixel, dtype=np.float64)))
