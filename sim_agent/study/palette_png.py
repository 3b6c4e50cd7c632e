"""PNG files with a palette: pictures of speckled ground a third as large as in full colour (PNG, W3C, 2003)."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

COLOURS = 40
EVERY = 7
"""Pixel that helps to choose the colours."""
SEED = 1


def write_palette_png(path: Path, picture: NDArray[np.uint8]) -> None:
    """Write an RGB picture (height, width, 3) with the colours that fit it best, and fine speckles evened out."""
    even = cv2.bilateralFilter(picture, 7, 35.0, 3.0)
    indices, colours = _quantised(np.asarray(even, dtype=np.uint8))
    height, width = indices.shape
    rows = b"".join(b"\0" + row.tobytes() for row in indices)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0))
        + _chunk(b"PLTE", colours.tobytes())
        + _chunk(b"IDAT", zlib.compress(rows, 9))
        + _chunk(b"IEND", b"")
    )


def _quantised(picture: NDArray[np.uint8]) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Number of the nearest colour of every pixel (height, width), and the colours (COLOURS, 3)."""
    pixels = picture.reshape(-1, 3).astype(np.float32)
    cv2.setRNGSeed(SEED)
    enough = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 10, 1.0)
    begin = np.zeros(0, dtype=np.int32)
    _, _, centres = cv2.kmeans(pixels[::EVERY].copy(), COLOURS, begin, enough, 1, cv2.KMEANS_PP_CENTERS)
    colours = np.rint(centres)
    distance = np.stack([((pixels - colour) ** 2).sum(axis=1) for colour in colours])
    indices = distance.argmin(axis=0).astype(np.uint8).reshape(picture.shape[:2])
    return indices, colours.astype(np.uint8)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
