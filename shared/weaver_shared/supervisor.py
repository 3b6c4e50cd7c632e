"""Keeps a handful of processes running: starts them, says when one ends, starts it again, ends all by their ids."""

from __future__ import annotations

import ctypes
import logging
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field

from weaver_shared.errors import ConfigurationError

logger = logging.getLogger(__name__)

PR_SET_PDEATHSIG = 1
REFUSED = 2
"""Exit code of a command that was given something it can not use."""
STABLE_AFTER = 10.0
"""A process that ran this many seconds is started again at once; one that died sooner waits longer each time."""


@dataclass(slots=True, kw_only=True)
class Child:
    name: str
    command: list[str]
    nice: int = 0
    process: subprocess.Popen[bytes] | None = None
    started: float = 0.0
    starts: int = 0
    failures: int = 0
    next_start: float = field(default=0.0)


class Supervisor:
    """Owns child processes; `watch()` is called a few times a second by whoever runs it."""

    def __init__(self, say: Callable[[str], None]) -> None:
        self._children: list[Child] = []
        self._say = say

    def add(self, name: str, arguments: list[str], *, nice: int = 0) -> None:
        """Start `weaver ARGUMENTS` and keep it running."""
        command = [sys.executable, "-m", *arguments]
        child = Child(name=name, command=command, nice=nice)
        self._children.append(child)
        self._start(child)

    @property
    def pids(self) -> dict[str, int]:
        return {child.name: child.process.pid for child in self._children if child.process is not None}

    def watch(self) -> None:
        """Notice ended children and start them again when their time has come.

        Raises ConfigurationError when one refuses its settings at its first start: it would refuse them for ever.
        """
        now = time.monotonic()
        for child in self._children:
            if child.process is not None and (code := child.process.poll()) is not None:
                child.process = None
                if code == REFUSED and child.starts == 1 and now - child.started < STABLE_AFTER:
                    raise ConfigurationError(f"{child.name} can not start with these settings")
                child.failures = 0 if now - child.started > STABLE_AFTER else child.failures + 1
                pause = 0.0 if child.failures == 0 else min(0.5 * 2**child.failures, 10.0)
                child.next_start = now + pause
                self._say(
                    f"{child.name} {_how_ended(code)}; starting it again" + (f" in {pause:.0f} s" if pause else "")
                )
            if child.process is None and now >= child.next_start:
                self._start(child)

    def close(self, timeout: float = 5.0) -> None:
        """End all children, politely first."""
        running = [child.process for child in self._children if child.process is not None]
        for process in running:
            process.terminate()
        deadline = time.monotonic() + timeout
        for process in running:
            try:
                process.wait(max(0.0, deadline - time.monotonic()))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()

    def _start(self, child: Child) -> None:
        parent = os.getpid()

        def prepare() -> None:
            _die_with_parent(parent)
            _prioritise(child.nice)

        child.process = subprocess.Popen(child.command, preexec_fn=prepare, stdin=subprocess.DEVNULL)  # noqa: PLW1509
        child.started = time.monotonic()
        child.starts += 1


def _die_with_parent(parent: int) -> None:
    """Ask the kernel to end this process when its parent ends, however it ends (Linux)."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
        if os.getppid() != parent:
            os._exit(1)


def _prioritise(nice: int) -> None:
    """Best effort: raising priority needs rights that not every user has."""
    try:
        os.setpriority(os.PRIO_PROCESS, 0, nice)
    except PermissionError:
        return


def _how_ended(code: int) -> str:
    return f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
