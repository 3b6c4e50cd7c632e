"""One GenICam camera through Aravis, USB3 or GigE: set up, streaming, its pictures stamped at mid-exposure."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from robot_agent.hardware.cameras.aravis import aravis
from robot_agent.hardware.cameras.grasshopper import Setting
from robot_agent.hardware.cameras.pairing import Picture
from robot_agent.hardware.imu.clock_map import ClockMap
from weaver_shared.errors import ResourceError

BUFFERS = 8
CLOCKS = (("GevTimestampControlLatch", "GevTimestampValue"), ("TimestampLatch", "TimestampLatchValue"))
"""What makes a camera keep its time for us, and where: without that a picture's way would count as delay."""
LOOK_NS = 1_000_000_000
"""Between looks at the camera's clock."""
TICKS = "GevTimestampTickFrequency"

logger = logging.getLogger(__name__)


class GenicamEye:
    """`name` is a serial number, an address or Aravis' own. Raises ResourceError where it is not there or refuses."""

    def __init__(self, name: str, wanted: Iterable[Setting], exposure: float, now_ns: Callable[[], int]) -> None:
        self._library = aravis()
        self._now_ns = now_ns
        self._half_exposure_ns = round(0.5e9 * exposure)
        self._clock = ClockMap()
        self._look_ns = 0
        self.incomplete = 0
        """Pictures that came with parts missing."""
        self.missing: list[str] = []
        """Features that it does not have; it was left there as it was."""
        try:
            self._camera = self._library.Camera.new(_known_as(self._library, name))
            device = self._camera.get_device()
            for setting in wanted:
                self._set(device, setting, name)
            _, _, self._width, self._height = self._region()
            self._stream = self._camera.create_stream(None, None)
            payload = self._camera.get_payload()
            for _ in range(BUFFERS):
                self._stream.push_buffer(self._library.Buffer.new_allocate(payload))
            self._latch = next((pair for pair in CLOCKS if device.get_feature(pair[0]) is not None), None)
            self._look_at_clock(now_ns())
            self._camera.start_acquisition()
        except ResourceError:
            raise
        except Exception as error:  # GLib.Error exists only with the library
            raise ResourceError(f"camera {name} can not be opened: {error}") from error

    def read(self, timeout: float) -> Picture | None:
        """The next whole picture, or None when none came within `timeout` s."""
        buffer = self._stream.timeout_pop_buffer(round(timeout * 1e6)) if timeout else self._stream.try_pop_buffer()
        if buffer is None:
            return None
        try:
            return self._picture(buffer)
        finally:
            self._stream.push_buffer(buffer)

    def close(self) -> None:
        """Never raises: the camera may be gone."""
        try:
            self._camera.stop_acquisition()
        except Exception:
            return
        finally:
            self._stream = self._camera = None

    def _picture(self, buffer: Any) -> Picture | None:
        arrived_ns = self._now_ns()
        if buffer.get_status() != self._library.BufferStatus.SUCCESS:
            self.incomplete += 1
            return None
        device_ns = int(buffer.get_timestamp())
        self._clock.observe(device_ns, arrived_ns)
        if arrived_ns - self._look_ns >= LOOK_NS:
            self._look_at_clock(arrived_ns)
        count = self._width * self._height
        pixels = np.frombuffer(buffer.get_data(), dtype=np.uint8, count=count).reshape(self._height, self._width)
        return Picture(
            counter=int(buffer.get_frame_id()),
            stamp_ns=self._clock.at(device_ns) + self._half_exposure_ns,
            pixels=pixels.copy(),
        )

    def _look_at_clock(self, now_ns: int) -> None:
        """Nothing where the camera does not tell its time, or no longer."""
        self._look_ns = now_ns
        if self._latch is None:
            return
        command, value = self._latch
        device = self._camera.get_device()
        try:
            device.execute_command(command)
            kept_ns = self._now_ns()
            self._clock.observe(int(device.get_integer_feature_value(value) * self._tick_ns(device)), kept_ns)
        except Exception:  # GLib.Error exists only with the library
            logger.warning("a camera does not tell its time; pictures are stamped by when they come")

    @staticmethod
    def _tick_ns(device: Any) -> float:
        if device.get_feature(TICKS) is None:
            return 1.0
        return 1e9 / float(device.get_integer_feature_value(TICKS))

    def _region(self) -> tuple[int, int, int, int]:
        x, y, width, height = self._camera.get_region()
        return int(x), int(y), int(width), int(height)

    def _set(self, device: Any, setting: Setting, name: str) -> None:
        if device.get_feature(setting.feature) is None:
            if setting.needed:
                raise ResourceError(f"camera {name} has no {setting.feature}; it can not be used")
            self.missing.append(setting.feature)
            return
        match setting.value:
            case bool():
                device.set_boolean_feature_value(setting.feature, setting.value)
            case str():
                device.set_string_feature_value(setting.feature, setting.value)
            case _:
                device.set_float_feature_value(setting.feature, float(setting.value))


def _known_as(library: Any, name: str) -> str:
    """Aravis' own name of the camera with this serial number; addresses and its own names go through."""
    library.update_device_list()
    for index in range(library.get_n_devices()):
        if library.get_device_serial_nbr(index) == name:
            return str(library.get_device_id(index))
    return name
