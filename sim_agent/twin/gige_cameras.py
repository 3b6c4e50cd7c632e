"""GigE Vision cameras that show pictures of ours: Aravis' emulated cameras, with what they see put into them.

Each has an address of its own; a computer's loopback has but one unless it is given more, as in a network namespace.
"""

from __future__ import annotations

import ctypes
import threading
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.cameras.aravis import aravis
from weaver_shared.errors import ResourceError

_WIDTH, _HEIGHT = 0x100, 0x104
_TRIGGER_SOFTWARE = 0x30C
"""Registers of Aravis' emulated camera (arvfakecamera.h)."""
_FILL = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_uint32, ctypes.c_uint32, ctypes.c_uint32)


class EmulatedGigeCamera:
    """Serves grey pictures of `size` (width, height) on `address`. Raises ResourceError where it can not."""

    def __init__(self, address: str, serial: str, size: tuple[int, int]) -> None:
        self._size = size
        self._picture = np.zeros((size[1], size[0]), dtype=np.uint8)
        self._lock = threading.Lock()
        self._served = aravis().GvFakeCamera.new(address, serial)
        if self._served is None or not self._served.is_running():
            raise ResourceError(f"no camera can be emulated on {address}: the computer does not have that address")
        self._library = _library()
        self._camera: Any = self._served.get_fake_camera()
        self._camera.write_register(_WIDTH, size[0])
        self._camera.write_register(_HEIGHT, size[1])
        # Kept, or the library would call into nothing.
        self._fill = _FILL(self._expose)
        self._library.arv_fake_camera_set_fill_pattern(hash(self._camera), self._fill, None)
        self.exposures = 0
        self.wire: EmulatedGigeCamera | None = None
        """Another camera that exposes when this one does."""

    def show(self, picture: NDArray[np.uint8]) -> None:
        """What it sees from now on."""
        with self._lock:
            self._picture = np.ascontiguousarray(picture)

    def trigger(self) -> None:
        """A pulse on its line; it exposes if it is set up to wait for one."""
        self._camera.write_register(_TRIGGER_SOFTWARE, 1)

    def close(self) -> None:
        self._served = self._camera = None

    def _expose(self, buffer: int, _data: int, _exposure: int, _gain: int, _format: int) -> None:
        if self.wire is not None:
            self.wire.trigger()
        with self._lock:
            picture = self._picture
        place = self._library.arv_buffer_get_data(buffer, None)
        ctypes.memmove(place, picture.ctypes.data, picture.size)
        self.exposures += 1


def _library() -> Any:
    """The same functions without the bindings, which can not hand a callback over."""
    library = ctypes.CDLL("libaravis-0.8.so.0")
    library.arv_buffer_get_data.restype = ctypes.c_void_p
    library.arv_buffer_get_data.argtypes = [ctypes.c_void_p, ctypes.c_void_p]
    library.arv_fake_camera_set_fill_pattern.argtypes = [ctypes.c_void_p, _FILL, ctypes.c_void_p]
    return library
