"""Pictures for people: small, and packed as JPEG."""

import cv2
import numpy as np
from numpy.typing import NDArray

SIZE = (320, 240)  # px
QUALITY = 70  # of JPEG


def preview(picture: NDArray[np.uint8]) -> bytes:
    """A small JPEG of a grey picture."""
    small = cv2.resize(picture, SIZE, interpolation=cv2.INTER_AREA)
    _, encoded = cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    return bytes(encoded)
