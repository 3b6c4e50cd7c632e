"""Pictures for people: what was found, marked where it is."""

from __future__ import annotations

import cv2
import numpy as np

from robot_agent.calibration.sightings import Sighting
from weaver_shared.messages import StereoFrame

MARK = (80, 220, 80)  # BGR
EYE_SIZE = (320, 240)  # px of an eye


def drawn(frame: StereoFrame, sightings: tuple[Sighting | None, ...]) -> bytes:
    """Both eyes beside each other with the found corners marked, as JPEG for people."""
    eyes = []
    for picture, sighting in zip((frame.left, frame.right), sightings, strict=True):
        width, height = EYE_SIZE
        small = np.zeros((height, width), dtype=np.uint8)
        if picture.size:
            small = cv2.resize(picture, EYE_SIZE, interpolation=cv2.INTER_AREA)
        colour = cv2.cvtColor(small, cv2.COLOR_GRAY2BGR)
        if sighting is not None:
            scale = np.array(EYE_SIZE) / picture.shape[::-1]
            for x, y in np.rint(16.0 * sighting.pixels * scale).astype(int):
                cv2.circle(colour, (int(x), int(y)), 16 * 3, MARK, 1, cv2.LINE_AA, shift=4)
        eyes.append(colour)
    _, encoded = cv2.imencode(".jpg", np.hstack(eyes), [cv2.IMWRITE_JPEG_QUALITY, 75])
    return bytes(encoded)
