"""`weaver router`: a fixed address on the bus at which the processes of robots and consoles find each other.

Processes that meet here connect to each other directly, so they stay in touch when this one ends. With a certificate
and users it guards the bus instead: whoever has a name then speaks through it alone, encrypted, and by its rules.
"""

import argparse
import signal
import tempfile
import threading
from pathlib import Path

from weaver_shared.bus import ZenohBus
from weaver_shared.bus_security import read_users, router_settings
from weaver_shared.errors import ConfigurationError


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    with tempfile.TemporaryDirectory(prefix="weaver-router-") as folder:
        bus = ZenohBus(listen=[options.listen], settings=_security(options, Path(folder)))
        try:
            print(f"the bus meets at {options.listen}", flush=True)
            ended.wait()
        finally:
            bus.close()
    return 0


def _security(options: argparse.Namespace, folder: Path) -> dict[str, object]:
    given = [option is not None for option in (options.certificate, options.key, options.users)]
    if not any(given):
        if options.listen.startswith("tls/"):
            raise ConfigurationError("a tls/ endpoint needs --certificate, --key and --users")
        return {}
    if not all(given):
        raise ConfigurationError("--certificate, --key and --users are given together")
    users = read_users(options.users)
    settings = router_settings(options.certificate, options.key, folder / "users", users)
    return {"mode": "router", **settings}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver router", description=__doc__)
    parser.add_argument("--listen", default="tcp/127.0.0.1:7447", help="bus endpoint to listen on (%(default)s)")
    parser.add_argument("--certificate", type=Path, metavar="FILE", help="certificate (PEM) for a tls/ endpoint")
    parser.add_argument("--key", type=Path, metavar="FILE", help="the certificate's key (PEM)")
    users = 'who may come in: {"NAME": {"password": "...", "role": "robot|console|viewer", "robots": ["ID"]}, ...}'
    parser.add_argument("--users", type=Path, metavar="FILE", help=users)
    return parser
