"""Two GenICam cameras as one source of stereo pairs, opened again when one of them is gone."""

from __future__ import annotations

import logging
from contextlib import ExitStack, closing

from robot_agent.hardware.cameras.genicam_eye import GenicamEye
from robot_agent.hardware.cameras.grasshopper import settings
from robot_agent.hardware.cameras.pairing import Eye, Pairing
from robot_agent.hardware.cameras.source import CameraHealth
from weaver_shared.clock import Clock
from weaver_shared.config.hardware import GenicamCameras
from weaver_shared.errors import ResourceError
from weaver_shared.messages import StereoFrame

logger = logging.getLogger(__name__)

SILENT_NS = 2_000_000_000
"""After so long without a picture of an eye both are opened anew."""
RETRY_NS = 1_000_000_000
TURN = 0.02  # s


class GenicamStereo:
    """A `robot_agent.hardware.cameras.source.StereoSource`. Raises ResourceError if a camera is not there at first."""

    def __init__(self, config: GenicamCameras, clock: Clock) -> None:
        self._config = config
        self._clock = clock
        self._open = ExitStack()
        self._eyes: tuple[GenicamEye, ...] = ()
        self._pairing = Pairing(1.0 / config.rate)
        self._sequence = 0
        self._trouble = ""
        self._retry_ns = 0
        self._heard_ns = [0, 0]
        self._connect()

    @property
    def eyes(self) -> tuple[GenicamEye, ...]:
        """Left and right; none while they are gone."""
        return self._eyes

    def read(self, timeout: float) -> StereoFrame | None:
        until_ns = self._clock.now_ns() + round(timeout * 1e9)
        while self._clock.now_ns() < until_ns:
            if not self._eyes:
                self._reconnect()
                if not self._eyes:
                    self._clock.sleep_until(min(until_ns, self._retry_ns))
                    continue
            for eye in Eye:
                picture = self._eyes[eye].read(TURN if eye is Eye.LEFT else 0.0)
                if picture is None:
                    continue
                self._heard_ns[eye] = self._clock.now_ns()
                if (pair := self._pairing.add(eye, picture)) is not None:
                    self._sequence += 1
                    # The second eye exposes with the first, which alone has its own clock for when.
                    first = pair[0 if self._config.primary == "left" else 1]
                    return StereoFrame(
                        stamp_ns=first.stamp_ns, sequence=self._sequence, left=pair[0].pixels, right=pair[1].pixels
                    )
            self._look_for_silence()
        return None

    def health(self) -> CameraHealth:
        counts = self._pairing.counts
        incomplete = sum(eye.incomplete for eye in self._eyes)
        return CameraHealth(pairs=counts.paired, lost=counts.single + counts.apart + incomplete, trouble=self._trouble)

    def close(self) -> None:
        self._eyes = ()
        self._open.close()

    def _connect(self) -> None:
        config = self._config
        names = {"left": config.left, "right": config.right}
        # Who is triggered waits before the other begins, and so they count alike.
        order = sorted(names, key=lambda side: side == config.primary)
        opened = {}
        with ExitStack() as stack:
            for side in order:
                wanted = settings(config, primary=side == config.primary)
                eye = GenicamEye(names[side], wanted, config.exposure, self._clock.now_ns)
                opened[side] = stack.enter_context(closing(eye))
                if eye.missing:
                    logger.info("camera %s has no %s", names[side], ", ".join(eye.missing))
            self._open = stack.pop_all()
        self._eyes = (opened["left"], opened["right"])
        self._pairing = Pairing(1.0 / config.rate)
        self._heard_ns = [self._clock.now_ns()] * 2
        self._trouble = ""

    def _reconnect(self) -> None:
        now_ns = self._clock.now_ns()
        if now_ns >= self._retry_ns:
            self._retry_ns = now_ns + RETRY_NS
            try:
                self._connect()
            except ResourceError as error:
                self._trouble = str(error)

    def _look_for_silence(self) -> None:
        now_ns = self._clock.now_ns()
        silent = [eye.name.lower() for eye in Eye if now_ns - self._heard_ns[eye] > SILENT_NS]
        if silent:
            self._trouble = f"the {' and '.join(silent)} camera sends no pictures"
            logger.warning("%s", self._trouble)
            self.close()
