"""The pictures of a recording as if cameras saw them now."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from robot_agent.hardware.cameras.source import CameraHealth
from robot_agent.recording import open_recording
from weaver_shared import topics
from weaver_shared.clock import Clock
from weaver_shared.config.hardware import ReplayedCameras
from weaver_shared.errors import InputError
from weaver_shared.messages import StereoFrame


class ReplayedStereo:
    """A `robot_agent.hardware.cameras.source.StereoSource`, at the recording's own pace, from its beginning to its end.

    Raises InputError where the recording can not be read or has no pictures.
    """

    def __init__(self, config: ReplayedCameras, clock: Clock) -> None:
        self._clock = clock
        self._frames = (frame for _, _, frame in open_recording(Path(config.recording)).messages(topics.STEREO))
        self._next: StereoFrame | None = next(self._frames, None)
        if self._next is None:
            raise InputError(f"{config.recording} has no stereo pictures; record with pictures")
        self._behind_ns = clock.now_ns() - self._next.stamp_ns
        self._pairs = 0

    def read(self, timeout: float) -> StereoFrame | None:
        until_ns = self._clock.now_ns() + round(timeout * 1e9)
        due_ns = until_ns + 1 if self._next is None else self._next.stamp_ns + self._behind_ns
        self._clock.sleep_until(min(due_ns, until_ns))
        if due_ns > until_ns or self._next is None:
            return None
        frame, self._next = self._next, next(self._frames, None)
        self._pairs += 1
        return replace(frame, stamp_ns=due_ns)

    def health(self) -> CameraHealth:
        return CameraHealth(pairs=self._pairs, lost=0, trouble="" if self._next else "the recording is over")

    def close(self) -> None:
        self._next = None
