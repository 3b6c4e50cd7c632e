"""One program at a time on a serial port: the lock of the port itself keeps out only those who ask for it too."""

from __future__ import annotations

import fcntl
import os
import tempfile
from pathlib import Path

from weaver_shared.errors import ResourceError


class PortLock:
    """A file that carries the holder's process id; the kernel releases it with the process, however that ends."""

    def __init__(self, port: str) -> None:
        name = os.path.realpath(port).strip("/").replace("/", "-")
        self._path = Path(tempfile.gettempdir()) / f"weaver-{name}.lock"
        self._port = port
        self._file: int | None = None

    def take(self) -> None:
        """Raises ResourceError that names the holder."""
        handle = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            holder = os.read(handle, 32).decode(errors="replace").strip() or "unknown"
            os.close(handle)
            raise ResourceError(f"port {self._port} is in use by process {holder}") from error
        os.ftruncate(handle, 0)
        os.write(handle, str(os.getpid()).encode())
        self._file = handle

    def release(self) -> None:
        if self._file is not None:
            os.close(self._file)
            self._file = None
