"""Pictures of the 3-D view as PNG."""

from io import BytesIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image

LEVEL = 5  # of compression: half the time of the usual one


def png(pixels: NDArray[np.uint8]) -> bytes:
    """`pixels` (height, width, 3) sRGB."""
    stream = BytesIO()
    Image.fromarray(pixels[..., :3]).save(stream, "PNG", compress_level=LEVEL)
    return stream.getvalue()
