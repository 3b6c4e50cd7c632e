"""Before anything else of a request: where it comes from, who it is from, what they may; and every answer's headers."""

from __future__ import annotations

import re
from collections.abc import Awaitable, Callable

from fastapi import Request, Response
from fastapi.responses import HTMLResponse, JSONResponse

from weaver_console import built_page
from weaver_console.access import Access
from weaver_console.hub import Hub

PAGE_POLICY = (
    "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; "
    "frame-src 'self'; frame-ancestors 'self'; object-src 'none'; base-uri 'self'; form-action 'self'"
)
SCENE_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob: data:; "
    "worker-src 'self' blob: data:; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
    "font-src 'self' data:; connect-src 'self' {host} data: blob:; frame-ancestors 'self'; object-src 'none'"
)
"""viser's page is one file with its scripts inside, which needs more than ours; neither may ask another host.

Its sandbox has no origin that 'self' could stand for in a worker, so the host is named.
"""

RERUN_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob:; "
    "worker-src 'self' blob:; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self' blob:; "
    "frame-ancestors 'self'; object-src 'none'; base-uri 'self'; form-action 'none'"
)
"""Rerun's viewer would ask for fonts and news of other hosts; it works without."""

OPEN_PATHS = ("/api/health", "/api/login")
EVERYBODYS = (*OPEN_PATHS, "/api/logout")
"""Paths that viewers too may write to."""

READING = ("GET", "HEAD", "OPTIONS")

_HOST = re.compile(r"[A-Za-z0-9.:\[\]-]{1,255}")

Guard = Callable[[Request, Callable[[Request], Awaitable[Response]]], Awaitable[Response]]


def guard(access: Access, hub: Hub) -> Guard:
    async def check(request: Request, go_on: Callable[[Request], Awaitable[Response]]) -> Response:
        scene = request.url.path.startswith("/viser/")
        if not access.origin_allowed(request.headers, sandboxed=scene):
            response: Response = JSONResponse({"error": "requests from other sites are refused"}, status_code=403)
        else:
            refusal = _refusal(access, hub, request, scene)
            response = await go_on(request) if refusal is None else refusal
        response.headers["Content-Security-Policy"] = _policy(request)
        response.headers["X-Content-Type-Options"] = "nosniff"
        response.headers["Referrer-Policy"] = "same-origin"
        if request.url.scheme == "https":
            response.headers["Strict-Transport-Security"] = "max-age=31536000"
        return response

    return check


def _refusal(access: Access, hub: Hub, request: Request, scene: bool) -> Response | None:
    path = request.url.path
    # A 3-D view's sandbox sends no cookie, but it has been told a secret.
    if path in OPEN_PATHS or (scene and hub.page_of(path.split("/")[2]) is not None):
        return None
    who = request.state.who = access.identify(request.headers, request.cookies)
    if who is None:
        if path == "/":
            return HTMLResponse(built_page.login_page(), status_code=401)
        return JSONResponse({"error": "log in first"}, status_code=401)
    if request.method not in READING and path not in EVERYBODYS and not who.operates:
        return JSONResponse({"error": f"{who.name} is a viewer; ask an operator"}, status_code=403)
    return None


def _policy(request: Request) -> str:
    if request.url.path.startswith("/rerun/"):
        return RERUN_POLICY
    if not request.url.path.startswith("/viser/"):
        return PAGE_POLICY
    host = request.headers.get("host", "")
    return SCENE_POLICY.format(host=f"{host} ws://{host} wss://{host}" if _HOST.fullmatch(host) else "")
