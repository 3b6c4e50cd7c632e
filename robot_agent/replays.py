"""The replays that a robot's recorder has begun, each a process of its own: none may hold up the recording."""

from __future__ import annotations

import contextlib
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from robot_agent.recording.player import replay_id_of
from weaver_shared.errors import ResourceError

MOST = 3


class PlayingProcess(Protocol):
    def poll(self) -> int | None: ...
    def terminate(self) -> None: ...
    def wait(self, timeout: float) -> int: ...


class Replays:
    def __init__(self, start: Callable[[Path, str], PlayingProcess]) -> None:
        """`start` begins to play a file under an id on the bus."""
        self._start = start
        self._playing: dict[str, PlayingProcess] = {}

    def begin(self, path: Path) -> str:
        """The id on the bus under which the recording is replayed, now or already. Raises ResourceError."""
        self._playing = {name: process for name, process in self._playing.items() if process.poll() is None}
        name = replay_id_of(path.name)
        if name not in self._playing:
            if not path.is_file():
                raise ResourceError(f"there is no recording {path.name!r:.120}")
            if len(self._playing) >= MOST:
                raise ResourceError(f"{MOST} recordings are being replayed already; end one of them first")
            self._playing[name] = self._start(path, name)
        return name

    def close(self) -> None:
        for process in self._playing.values():
            process.terminate()
        for process in self._playing.values():
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(2.0)
