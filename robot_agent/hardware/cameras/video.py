"""Cameras that OpenCV opens: one that sends both eyes side by side, or two of them."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.cameras.source import CameraHealth
from weaver_shared.clock import Clock
from weaver_shared.config.hardware import VideoCameras
from weaver_shared.errors import ResourceError
from weaver_shared.messages import StereoFrame


class VideoStereo:
    """A `robot_agent.hardware.cameras.source.StereoSource`; files and picture sequences are devices, too.

    Stamped when the pictures were grabbed, as late as the driver is: such cameras have no clock that could be asked.
    """

    def __init__(self, config: VideoCameras, clock: Clock) -> None:
        self._clock = clock
        self._half_exposure_ns = round(0.5e9 * config.exposure)
        names = [config.left] if config.right is None else [config.left, config.right]
        self._devices = [cv2.VideoCapture(int(name) if name.isdigit() else name) for name in names]
        for name, device in zip(names, self._devices, strict=True):
            if not device.isOpened():
                self.close()
                raise ResourceError(f"camera {name} can not be opened")
        self._sequence = self._lost = 0

    def read(self, timeout: float) -> StereoFrame | None:
        """`timeout` is the driver's own."""
        # Both are told before either is unpacked: what lies between is all that parts the two exposures.
        grabbed = [device.grab() for device in self._devices]
        stamp_ns = self._clock.now_ns() - self._half_exposure_ns
        if not all(grabbed):
            self._lost += any(grabbed)
            return None
        pictures = [_grey(device.retrieve()[1]) for device in self._devices]
        self._sequence += 1
        if len(pictures) == 1:
            half = pictures[0].shape[1] // 2
            pictures = [np.ascontiguousarray(part) for part in (pictures[0][:, :half], pictures[0][:, half : 2 * half])]
        return StereoFrame(stamp_ns=stamp_ns, sequence=self._sequence, left=pictures[0], right=pictures[1])

    def health(self) -> CameraHealth:
        return CameraHealth(pairs=self._sequence, lost=self._lost, trouble="")

    def close(self) -> None:
        for device in self._devices:
            device.release()


def _grey(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    if picture.ndim == 2:
        return picture
    grey: NDArray[np.uint8] = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY)
    return grey
