"""`weaver console`: the operator's console on its own."""

from __future__ import annotations

import argparse
import asyncio
import logging
import socket
import ssl
import sys
from pathlib import Path

from weaver_console import user_command
from weaver_console.access import Access, is_loopback
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
    if arguments[:1] == ["user"]:
        return user_command.main(arguments[1:])
    options = _parser().parse_args(arguments)
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s")
    _check(options)
    sys.setswitchinterval(SWITCH_INTERVAL)
    database = Database(options.data / "console.sqlite3")
    access = Access(host=options.host, database=database, guarded=bool(options.trusted_proxy) or options.login)
    listener = _listen(options.host, options.port)
    try:
        endpoints = options.listen or ["tcp/127.0.0.1:7447"]
        link = Link(ZenohBus(listen=endpoints, connect=options.connect or [], newest_only=True))
        app = create_app(Hub(link, database=database, scenes=not options.no_scene), access, data=options.data)
        server = web_server(
            app, trusted_proxies=options.trusted_proxy or (), certificate=options.tls_certificate, key=options.tls_key
        )
        scheme = "https" if options.tls_certificate is not None else "http"
        print(f"Weaver Console: {_address(scheme, options.host, listener)}", flush=True)
        asyncio.run(server.serve(sockets=[listener]))
    finally:
        listener.close()
    return 0


def _check(options: argparse.Namespace) -> None:
    """Raises ConfigurationError on options that would leave passwords readable, or that do not go together."""
    if options.password_file is not None:
        raise ConfigurationError(
            "--password-file is no more: each has their own password now; use `weaver console user add NAME`"
        )
    if (options.tls_certificate is None) != (options.tls_key is None):
        raise ConfigurationError("--tls-certificate and --tls-key are given together")
    if options.tls_certificate is not None:
        try:
            ssl.create_default_context(ssl.Purpose.CLIENT_AUTH).load_cert_chain(
                options.tls_certificate, options.tls_key
            )
        except (OSError, ssl.SSLError) as error:
            raise ConfigurationError(
                f"the certificate {options.tls_certificate} with the key {options.tls_key} can not be used: {error}"
            ) from error
    elif not (is_loopback(options.host) or options.trusted_proxy or options.without_tls):
        raise ConfigurationError(
            f"passwords would be readable on the way to {options.host}; give --tls-certificate and --tls-key, or "
            "--trusted-proxy ADDRESS of the proxy that encrypts, or --without-tls if that is wanted"
        )


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="weaver console",
        description="Serve the operator's page; `weaver console user --help` tells how to let people in.",
    )
    parser.add_argument(
        "--host",
        default="127.0.0.1",
        help="address to listen on; others than loopback need users (weaver console user) and TLS",
    )
    parser.add_argument("--port", type=int, default=8080, help="TCP port of the page, 0 for any free one (%(default)s)")
    connect = "Zenoh endpoint of a robot or router, such as tcp/192.168.1.20:7447; may be repeated"
    parser.add_argument("--connect", action="append", metavar="ENDPOINT", help=connect)
    listen = "Zenoh endpoint to listen on (tcp/127.0.0.1:7447); may be repeated"
    parser.add_argument("--listen", action="append", metavar="ENDPOINT", help=listen)
    login = "ask for the login on loopback too"
    parser.add_argument("--login", action="store_true", help=login)
    certificate = "file with the certificate (PEM) for TLS, with its chain"
    parser.add_argument("--tls-certificate", type=Path, metavar="FILE", help=certificate)
    parser.add_argument("--tls-key", type=Path, metavar="FILE", help="file with the certificate's key (PEM)")
    proxy = "address or network of a proxy whose X-Forwarded-For and -Proto count; may be repeated; asks for the login"
    parser.add_argument("--trusted-proxy", action="append", metavar="ADDRESS", help=proxy)
    parser.add_argument("--without-tls", action="store_true", help="let passwords travel readable off loopback")
    parser.add_argument("--password-file", help=argparse.SUPPRESS)
    data = "folder of the database with missions and events (default %(default)s)"
    parser.add_argument("--data", type=Path, default=data_folder(), help=data)
    parser.add_argument("--no-scene", action="store_true", help="serve no 3-D view, only the 2-D map")
    return parser


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


def _address(scheme: str, host: str, listener: socket.socket) -> str:
    name = f"[{host}]" if ":" in host else host
    return f"{scheme}://{name}:{listener.getsockname()[1]}/"
