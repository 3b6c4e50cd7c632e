"""The HTTP server's settings, in one place for the program and its tests."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import uvicorn

from weaver_console.page_messages import LARGEST_FRAME


def web_server(
    app: Any, *, trusted_proxies: Sequence[str] = (), certificate: Path | None = None, key: Path | None = None
) -> uvicorn.Server:
    """`trusted_proxies` are addresses or networks whose word counts for whom they forward and by which scheme."""
    config = uvicorn.Config(
        app,
        proxy_headers=bool(trusted_proxies),
        forwarded_allow_ips=list(trusted_proxies),
        ssl_certfile=certificate,
        ssl_keyfile=key,
        log_level="warning",
        ws="websockets-sansio",
        ws_max_size=LARGEST_FRAME,
        ws_per_message_deflate=False,  # most of the traffic is compressed already, and the rest is small
        ws_ping_interval=5.0,
        ws_ping_timeout=20.0,
        timeout_graceful_shutdown=2,
        server_header=False,
    )
    return uvicorn.Server(config)
