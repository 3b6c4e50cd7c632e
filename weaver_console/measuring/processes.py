"""The processes of a measurement, and what each has cost."""

from __future__ import annotations

import os
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Mapping, Sequence
from types import TracebackType

from weaver_shared.errors import ResourceError

TICKS = os.sysconf("SC_CLK_TCK")
PAGE = os.sysconf("SC_PAGE_SIZE")


class MeasuredProcess:
    """One `python -m MODULE ...`, ended with the block that it was started in."""

    def __init__(self, module: str, *arguments: str, environment: Mapping[str, str] | None = None) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", module, *arguments],
            stdout=subprocess.DEVNULL,
            env={**os.environ, **(environment or {})},
        )
        self._name = module

    def __enter__(self) -> MeasuredProcess:
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self.end()

    @property
    def pid(self) -> int:
        return self._process.pid

    def end(self, timeout: float = 10.0) -> None:
        self._process.terminate()
        try:
            self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def require_running(self) -> None:
        if (code := self._process.poll()) is not None:
            raise ResourceError(f"{self._name} ended with {code} before it was measured")

    def cpu_seconds(self) -> float:
        """All its threads have computed so far, s, to a hundredth."""
        with open(f"/proc/{self.pid}/stat", encoding="ascii") as file:
            after_name = file.read().rpartition(")")[2].split()
        return (int(after_name[11]) + int(after_name[12])) / TICKS

    def memory(self) -> int:
        """Resident bytes."""
        with open(f"/proc/{self.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * PAGE


def console_process(
    port: int, data: str, *options: str, environment: Mapping[str, str] | None = None
) -> MeasuredProcess:
    """A console that answers on this port. Raises ResourceError when it does not within 30 s."""
    console = MeasuredProcess(
        "weaver_shared.command_line", "console", "--port", str(port), "--data", data, *options, environment=environment
    )
    try:
        wait_for_health(f"http://127.0.0.1:{port}", [console])
    except BaseException:
        console.end()
        raise
    return console


def wait_for_health(address: str, processes: Sequence[MeasuredProcess], timeout: float = 30.0) -> None:
    deadline = time.monotonic() + timeout
    while time.monotonic() < deadline:
        for process in processes:
            process.require_running()
        try:
            with urllib.request.urlopen(f"{address}/api/health", timeout=1.0):
                return
        except (urllib.error.URLError, OSError):
            time.sleep(0.1)
    raise ResourceError(f"the console did not answer on {address} within {timeout:.0f} s")
