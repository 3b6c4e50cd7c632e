"""Takes faults for a running emulated robot from other programs on this computer: a line of JSON each way."""

from __future__ import annotations

import json
import socket
import threading
from pathlib import Path

from sim_agent.twin.faults import Devices, inject
from weaver_shared.errors import InputError, ResourceError

LONGEST = 4096
PATIENCE = 5.0  # s
_POLL = 0.2


class FaultDesk:
    """Listens on the Unix socket `path` until closed; `lock` is held while a fault happens."""

    def __init__(self, path: Path, devices: Devices, lock: threading.Lock) -> None:
        self._path = path
        self._devices = devices
        self._devices_lock = lock
        path.unlink(missing_ok=True)
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.bind(str(path))
        self._socket.listen(4)
        self._socket.settimeout(_POLL)
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self._socket.close()
        self._path.unlink(missing_ok=True)

    def _serve(self) -> None:
        while not self._ending.is_set():
            try:
                caller, _ = self._socket.accept()
            except TimeoutError:
                continue
            with caller:
                caller.settimeout(PATIENCE)
                try:
                    caller.sendall(json.dumps(self._answer(caller.recv(LONGEST))).encode())
                except OSError:
                    continue

    def _answer(self, question: bytes) -> dict[str, object]:
        try:
            asked = json.loads(question)
            name, target, value, ending = (asked[key] for key in ("fault", "target", "value", "ending"))
            with self._devices_lock:
                done = inject(self._devices, name, target, value, ending=ending)
        except (ValueError, KeyError, TypeError) as error:
            return {"refused": f"not understood: {error}"}
        except InputError as error:
            return {"refused": str(error)}
        return {"done": done}


def ask(path: Path, fault: str, target: str, value: float | None, *, ending: bool) -> str:
    """What a running emulated robot says to a fault. Raises InputError as it does, ResourceError if none runs."""
    question = json.dumps({"fault": fault, "target": target, "value": value, "ending": ending}).encode()
    with socket.socket(socket.AF_UNIX) as line:
        line.settimeout(PATIENCE)
        try:
            line.connect(str(path))
            line.sendall(question)
            answer = json.loads(line.recv(LONGEST))
        except (OSError, ValueError) as error:
            raise ResourceError(
                f"no emulated robot answers on {path}; start one with `weaver up --robot twin`"
            ) from error
    if "refused" in answer:
        raise InputError(str(answer["refused"]))
    return str(answer["done"])
