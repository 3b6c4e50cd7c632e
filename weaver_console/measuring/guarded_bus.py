"""A guarded bus for a measurement: a certificate of its own, users, and the environment of each process."""

from __future__ import annotations

import json
import secrets
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

from weaver_shared.bus_security import CERTIFICATE, PASSWORD, USER, BusRole
from weaver_shared.errors import ResourceError


class GuardedBus:
    """Files in `folder`; `robots` names the robots that each robot's computer speaks for."""

    def __init__(self, folder: Path, *, robots: Mapping[str, Sequence[str]]) -> None:
        self.certificate, self.key, self.users = folder / "router.pem", folder / "router.key", folder / "users.json"
        _make_certificate(self.certificate, self.key)
        users: dict[str, dict[str, object]] = {
            "console": {"role": BusRole.CONSOLE},
            "viewer": {"role": BusRole.VIEWER},
            **{name: {"role": BusRole.ROBOT, "robots": list(ids)} for name, ids in robots.items()},
        }
        self._passwords = {name: secrets.token_urlsafe(16) for name in users}
        kept = {name: {**user, "password": self._passwords[name]} for name, user in users.items()}
        self.users.touch(mode=0o600)
        self.users.write_text(json.dumps(kept))

    @property
    def router_options(self) -> list[str]:
        return ["--certificate", str(self.certificate), "--key", str(self.key), "--users", str(self.users)]

    def environment(self, name: str) -> dict[str, str]:
        return {USER: name, PASSWORD: self._passwords[name], CERTIFICATE: str(self.certificate)}


def _make_certificate(certificate: Path, key: Path) -> None:
    """For 127.0.0.1, signed by itself, for a day. Raises ResourceError where openssl is missing."""
    command = [
        "openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "1",
        "-subj", "/CN=127.0.0.1", "-addext", "subjectAltName=IP:127.0.0.1,DNS:localhost",
        "-addext", "basicConstraints=critical,CA:FALSE", "-keyout", str(key), "-out", str(certificate),
    ]  # fmt: skip
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=30.0)
    except FileNotFoundError as error:
        raise ResourceError("openssl is not installed; it makes the certificate of the measured bus") from error
    except subprocess.CalledProcessError as error:
        raise ResourceError(f"openssl made no certificate: {error.stderr.strip()}") from error
