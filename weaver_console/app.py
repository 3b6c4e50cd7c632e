"""The console as a web application: the page, its WebSocket, the 3-D view behind a proxy, and a read-only API."""

from __future__ import annotations

import asyncio
import contextlib
import json
import re
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from importlib.metadata import version
from pathlib import Path
from typing import Annotated
from urllib.parse import parse_qs

from fastapi import FastAPI, Query, Request, Response, WebSocket, WebSocketDisconnect
from fastapi.exceptions import RequestValidationError
from fastapi.responses import FileResponse, HTMLResponse, JSONResponse, RedirectResponse

from weaver_console import built_page
from weaver_console.access import COOKIE, VALID_S, Access
from weaver_console.database import data_folder
from weaver_console.hub import Hub
from weaver_console.mission_api import add_mission_api
from weaver_console.page_session import PageSession
from weaver_console.rerun_viewer import add_rerun
from weaver_console.robot_files import add_robot_files
from weaver_console.roster import describe
from weaver_console.scene_page import scene_page
from weaver_console.scene_proxy import carry
from weaver_shared.errors import InputError

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

_HOST = re.compile(r"[A-Za-z0-9.:\[\]-]{1,255}")

LARGEST_LOGIN = 4096

_PAGE_ID = re.compile(r"[A-Za-z0-9-]{8,64}")

REPLACED, LOGIN_NEEDED, GOING = 4000, 4001, 4002


def create_app(hub: Hub, access: Access, *, folder: Path | None = None, data: Path | None = None) -> FastAPI:
    """`folder` holds the built page; by default the one in the package or the source tree. `data` is the console's."""

    @contextlib.asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        hub.link.open()
        hub.start()
        checking = asyncio.create_task(hub.keep_checking())
        yield
        checking.cancel()
        await asyncio.to_thread(hub.stop)
        await asyncio.to_thread(hub.link.close)

    app = FastAPI(title="Weaver Console", version=version("weaver-hexapod"), lifespan=lifespan, docs_url=None,
                  redoc_url=None)  # fmt: skip
    app.middleware("http")(_guard(access, hub))
    app.exception_handler(RequestValidationError)(_not_valid)
    _add_api(app, hub)
    add_mission_api(app, hub.missions)
    add_robot_files(app, hub.link)
    add_rerun(app, hub.link, (data or data_folder()) / "rerun")
    _add_login(app, access)
    _add_sockets(app, hub, access)
    _add_pages(app, hub, folder)
    return app


async def _not_valid(_: Request, error: Exception) -> Response:
    """What is wrong with a request, in a sentence; what was sent is not sent back, it may not even be JSON."""
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    where = ".".join(str(part) for part in first["loc"][1:])
    return JSONResponse({"error": f"{where or first['loc'][0]}: {first['msg']}"}, status_code=422)


def _guard(
    access: Access, hub: Hub
) -> Callable[[Request, Callable[[Request], Awaitable[Response]]], Awaitable[Response]]:
    """Checks origin and cookie before anything else, and sets the headers of every answer."""

    async def guard(request: Request, go_on: Callable[[Request], Awaitable[Response]]) -> Response:
        path = request.url.path
        scene = path.startswith("/viser/")
        if not access.origin_allowed(request.headers, sandboxed=scene):
            response: Response = JSONResponse({"error": "requests from other sites are refused"}, status_code=403)
        elif (
            path in ("/api/health", "/api/login")
            or access.admits(request.cookies.get(COOKIE))
            # A 3-D view's sandbox sends no cookie, but it has been told a secret.
            or (scene and hub.page_of(path.split("/")[2]) is not None)
        ):
            response = await go_on(request)
        elif path == "/":
            response = HTMLResponse(built_page.LOGIN, status_code=401)
        else:
            response = JSONResponse({"error": "log in first"}, status_code=401)
        response.headers["Content-Security-Policy"] = _policy(request)
        response.headers["X-Content-Type-Options"] = "nosniff"
        response.headers["Referrer-Policy"] = "same-origin"
        return response

    return guard


def _policy(request: Request) -> str:
    if request.url.path.startswith("/rerun/"):
        return RERUN_POLICY
    if not request.url.path.startswith("/viser/"):
        return PAGE_POLICY
    host = request.headers.get("host", "")
    return SCENE_POLICY.format(host=f"{host} ws://{host} wss://{host}" if _HOST.fullmatch(host) else "")


def _add_api(app: FastAPI, hub: Hub) -> None:
    @app.get("/api/health")
    async def health() -> dict[str, object]:
        return {
            "status": "ok",
            "version": app.version,
            "robots": len(hub.link.robots()),
            "pages": hub.pages,
            "uptime_s": round(time.monotonic() - hub.started, 1),
        }

    @app.get("/api/robots")
    async def robots() -> dict[str, object]:
        now_ns = hub.link.clock.now_ns()
        with hub.link.lock:
            return {"robots": [describe(record, now_ns) for record in hub.link.robots()]}

    @app.get("/api/events")
    async def events(
        before: Annotated[float, Query(allow_inf_nan=False)] = 1e12,
        count: Annotated[int, Query(ge=1, le=1000)] = 200,
    ) -> dict[str, object]:
        past = await asyncio.to_thread(hub.archive.latest, before=before, count=count)
        return {"events": [event.to_page() for event in past]}


def _add_login(app: FastAPI, access: Access) -> None:
    @app.post("/api/login")
    async def login(request: Request) -> Response:
        body = await request.body()
        is_form = request.headers.get("content-type", "").startswith("application/x-www-form-urlencoded")
        if access.blocked:
            return JSONResponse({"error": "too many wrong passwords; wait a minute"}, status_code=429)
        password = _password(body, is_form) if len(body) <= LARGEST_LOGIN else None
        if password is None:
            return JSONResponse({"error": 'send {"password": "..."}'}, status_code=422)
        if access.open or not access.check_password(password):
            if is_form:
                return HTMLResponse(built_page.LOGIN, status_code=401)
            return JSONResponse({"error": "the password is wrong"}, status_code=401)
        response: Response = RedirectResponse("/", status_code=303) if is_form else JSONResponse({"status": "ok"})
        response.set_cookie(COOKIE, access.issue_cookie(), max_age=VALID_S, httponly=True, samesite="strict",
                            secure=request.url.scheme == "https")  # fmt: skip
        return response

    @app.post("/api/logout")
    async def logout() -> Response:
        response = JSONResponse({"status": "ok"})
        response.delete_cookie(COOKIE)
        return response


def _password(body: bytes, is_form: bool) -> str | None:
    try:
        if is_form:
            return parse_qs(body.decode()).get("password", [""])[0]
        password = json.loads(body)["password"]
    except (ValueError, KeyError, TypeError, RecursionError):
        return None
    return password if isinstance(password, str) else None


def _add_sockets(app: FastAPI, hub: Hub, access: Access) -> None:
    async def admitted(socket: WebSocket) -> bool:
        """Whether the connection may go on; else it has been closed."""
        if not access.origin_allowed(socket.headers):
            await socket.close(code=1008)
            return False
        if not access.admits(socket.cookies.get(COOKIE)):
            await socket.close(code=LOGIN_NEEDED)
            return False
        return True

    @app.websocket("/ws")
    async def page_socket(socket: WebSocket, page: str = "", operator: str = "") -> None:
        if not await admitted(socket):
            return
        await socket.accept()
        if not _PAGE_ID.fullmatch(page):
            await socket.close(code=1008, reason="page is an id of 8 to 64 letters, digits and -")
            return
        try:
            session = hub.enter(page, operator)
        except InputError as error:
            await socket.close(code=1008, reason=str(error))
            return
        try:
            await _converse(socket, session, hub)
        finally:
            hub.leave(session)

    @app.websocket("/viser/{key}")
    @app.websocket("/viser/{key}/")
    async def scene_socket(socket: WebSocket, key: str) -> None:
        page = hub.page_of(key) if access.origin_allowed(socket.headers, sandboxed=True) else None
        scene = hub.scene(page) if page is not None else None
        if scene is None:
            await socket.close(code=1008)
            return
        await carry(socket, scene.port)


async def _converse(socket: WebSocket, session: PageSession, hub: Hub) -> None:
    """Both directions of a page until it leaves, is replaced by itself, or stops reading."""
    sender = asyncio.create_task(session.send(socket.send_text))
    receiver = asyncio.create_task(_receive(socket, session, hub))
    done, waiting = await asyncio.wait((sender, receiver), return_when=asyncio.FIRST_COMPLETED)
    for task in waiting:
        task.cancel()
    await asyncio.gather(*waiting, return_exceptions=True)
    with contextlib.suppress(RuntimeError, WebSocketDisconnect, OSError):
        await socket.close(code=1000 if hub.current(session) else REPLACED)
    for task in done:
        error = task.exception()
        if error is not None and not isinstance(error, WebSocketDisconnect | TimeoutError | RuntimeError | OSError):
            raise error


async def _receive(socket: WebSocket, session: PageSession, hub: Hub) -> None:
    while hub.current(session):
        message = await socket.receive()
        if message["type"] == "websocket.disconnect":
            return
        if not hub.current(session):
            return
        session.receive(message.get("text") or message.get("bytes") or "")


def _add_pages(app: FastAPI, hub: Hub, folder: Path | None) -> None:
    @app.get("/viser/{key}")
    @app.get("/viser/{key}/")
    async def scene(key: str) -> Response:
        page = hub.page_of(key)
        if page is None or hub.scene(page) is None:
            return JSONResponse({"error": "this page is not connected"}, status_code=404)
        headers = {"Content-Encoding": "gzip", "Vary": "Accept-Encoding", "Cache-Control": "no-cache"}
        return Response(scene_page(), media_type="text/html", headers=headers)

    @app.post("/viser/{key}/thrift")
    async def thrift(key: str) -> Response:
        """The browser of this page draws without a graphics card."""
        page = hub.page_of(key)
        view = hub.scene(page) if page is not None else None
        if view is not None:
            view.thrifty = True
        return Response(status_code=204)

    @app.get("/{path:path}")
    async def built(path: str) -> Response:
        root = folder or built_page.page_folder()
        if root is None:
            return HTMLResponse(built_page.NOT_BUILT, status_code=503)
        wanted = (root / (path or "index.html")).resolve()
        if not wanted.is_relative_to(root.resolve()) or not wanted.is_file():
            return JSONResponse({"error": "there is nothing at this address"}, status_code=404)
        lasting = path.startswith("assets/")  # the build puts a digest into their names
        caching = "public, max-age=31536000, immutable" if lasting else "no-cache"
        return FileResponse(wanted, headers={"Cache-Control": caching})
