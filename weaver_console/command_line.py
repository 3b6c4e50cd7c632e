"""`weaver console`: the operator's console on its own."""

from __future__ import annotations

import argparse
import asyncio
import logging
import socket
import sys
from pathlib import Path

from weaver_console.access import Access
from weaver_console.app import create_app
from weaver_console.database import Database, data_folder
from weaver_console.hub import Hub
from weaver_console.link import Link
from weaver_console.web_server import web_server
from weaver_shared.bus import ZenohBus
from weaver_shared.errors import ConfigurationError, ResourceError

SWITCH_INTERVAL = 0.001
"""s that another thread may keep the interpreter while a page waits to be answered; Python's own is 5 ms."""


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s")
    access = Access(host=options.host, password=_password(options.password_file))
    sys.setswitchinterval(SWITCH_INTERVAL)
    listener = _listen(options.host, options.port)
    try:
        link = Link(ZenohBus(listen=options.listen or ["tcp/127.0.0.1:7447"], connect=options.connect or []))
        database = Database(options.data / "console.sqlite3")
        app = create_app(Hub(link, database=database, scenes=not options.no_scene), access, data=options.data)
        print(f"Weaver Console: {_address(options.host, listener)}", flush=True)
        asyncio.run(web_server(app).serve(sockets=[listener]))
    finally:
        listener.close()
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver console", description="Serve the operator's page.")
    parser.add_argument(
        "--host", default="127.0.0.1", help="address to listen on; others than loopback need a password"
    )
    parser.add_argument("--port", type=int, default=8080, help="TCP port of the page, 0 for any free one (%(default)s)")
    connect = "Zenoh endpoint of a robot or router, such as tcp/192.168.1.20:7447; may be repeated"
    parser.add_argument("--connect", action="append", metavar="ENDPOINT", help=connect)
    listen = "Zenoh endpoint to listen on (tcp/127.0.0.1:7447); may be repeated"
    parser.add_argument("--listen", action="append", metavar="ENDPOINT", help=listen)
    parser.add_argument("--password-file", type=Path, help="file whose first line is the password")
    data = "folder of the database with missions and events (default %(default)s)"
    parser.add_argument("--data", type=Path, default=data_folder(), help=data)
    parser.add_argument("--no-scene", action="store_true", help="serve no 3-D view, only the 2-D map")
    return parser


def _password(path: Path | None) -> str:
    if path is None:
        return ""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeError) as error:
        raise ConfigurationError(f"the password file {path} can not be read: {error}") from error
    if not lines or len(lines[0].strip()) < 8:
        raise ConfigurationError(f"the password in the first line of {path} must have at least 8 characters")
    return lines[0].strip()


def _listen(host: str, port: int) -> socket.socket:
    """A listening socket. Raises ResourceError when the port is taken."""
    if not 0 <= port <= 65535:
        raise ConfigurationError(f"port {port} is not valid; use 0 to 65535")
    try:
        address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, proto=socket.IPPROTO_TCP, flags=socket.AI_PASSIVE
        )[0]
        # NOTE: asyncio sends small messages at once only from sockets that name TCP, others 40 ms late.
        listener = socket.socket(*address[:3])
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address[4])
        listener.listen(128)
    except OSError as error:
        raise ResourceError(
            f"the console can not listen on {host} port {port}: {error.strerror or error}; choose another --port"
        ) from error
    return listener


def _address(host: str, listener: socket.socket) -> str:
    name = f"[{host}]" if ":" in host else host
    return f"http://{name}:{listener.getsockname()[1]}/"
