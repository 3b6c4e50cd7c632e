"""The two eyes of an emulated robot: GigE Vision cameras that its wiring names, one triggered by the other's wire."""

from __future__ import annotations

import threading
from contextlib import ExitStack, closing
from pathlib import Path

from robot_agent.hardware.emulated_clock import EmulatedClock
from robot_agent.hardware.wiring import load_wiring
from sim_agent.gige import GigeCamera
from weaver_shared.config.hardware import GenicamCameras
from weaver_shared.messages import StereoFrame
from weaver_shared.robots.parts import Camera

_POLL = 0.1  # s


class ShownEyes:
    """Cameras on the addresses that `config` names, which see what they are shown; their time is that of `clock`."""

    def __init__(self, config: GenicamCameras, clock: EmulatedClock, camera: Camera) -> None:
        size = (camera.width, camera.height)
        self._open = ExitStack()
        names = {"left": config.left, "right": config.right}
        self._eyes = {
            side: self._open.enter_context(closing(GigeCamera(address, side.upper(), size, clock.now_ns)))
            for side, address in names.items()
        }
        self._first = self._eyes.pop(config.primary)
        (self._second,) = self._eyes.values()
        self._first.wire(config.exposure_line, self._second, config.trigger_line)
        self._left_first = config.primary == "left"

    def show(self, frame: StereoFrame) -> None:
        """Let both expose what this pair shows, at its time."""
        pictures = (frame.left, frame.right) if self._left_first else (frame.right, frame.left)
        for eye, picture in zip((self._first, self._second), pictures, strict=True):
            eye.see(picture)
        self._first.tick(frame.stamp_ns)

    def close(self) -> None:
        self._open.close()


def awaited_cameras(wiring: Path, stopping: threading.Event) -> tuple[GenicamCameras, EmulatedClock] | None:
    """The cameras and the clock of an emulated robot once its wiring is there; None where it names no such cameras."""
    while not wiring.exists():
        if stopping.wait(_POLL):
            return None
    config = load_wiring(wiring)
    if not isinstance(config.cameras, GenicamCameras) or config.emulated is None:
        return None
    return config.cameras, EmulatedClock(Path(config.emulated.clock))
