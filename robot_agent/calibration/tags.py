"""The AprilTag family 36h11 as Kalibr prints it: two cells of black border, half a turn from OpenCV's drawing."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import cv2

CODE_CELLS = 6
BORDER_CELLS = 2
TAG_CELLS = CODE_CELLS + 2 * BORDER_CELLS
FAMILY_SIZE = 587


@functools.cache
def family() -> cv2.aruco.Dictionary:
    import cv2  # only who looks for tags or prints them pays for it

    return cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)


def tag_cells(tag: int) -> NDArray[np.uint8]:
    """Cells (10, 10) of a tag, 1 for white, the row nearest the grid's x axis (the lowest one) first."""
    drawn = family().generateImageMarker(tag, TAG_CELLS, None, BORDER_CELLS)
    # Kalibr's print is OpenCV's turned by half a turn; rows from below then undo the turn's flip of the rows.
    return np.ascontiguousarray((np.asarray(drawn) > 0)[:, ::-1], dtype=np.uint8)
