"""The console as a web application: the page, its WebSocket, the 3-D view behind a proxy, and a read-only API."""

from __future__ import annotations

import asyncio
import contextlib
import re
import time
from collections.abc import AsyncIterator
from importlib.metadata import version
from pathlib import Path
from typing import Annotated

from fastapi import FastAPI, Query, Request, Response, WebSocket, WebSocketDisconnect
from fastapi.exceptions import RequestValidationError
from fastapi.responses import FileResponse, HTMLResponse, JSONResponse

from weaver_console import built_page
from weaver_console.access import Access
from weaver_console.body_limit import BodyLimit
from weaver_console.database import data_folder
from weaver_console.guard import guard
from weaver_console.hub import Hub
from weaver_console.login_api import add_login, add_user_api
from weaver_console.mission_api import add_mission_api
from weaver_console.page_session import PageSession
from weaver_console.png import png
from weaver_console.rerun_viewer import add_rerun
from weaver_console.robot_files import add_robot_files
from weaver_console.roster import describe
from weaver_console.scene_page import scene_page
from weaver_console.scene_proxy import carry
from weaver_shared.errors import InputError

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
    app.middleware("http")(guard(access, hub))
    app.add_middleware(BodyLimit)
    app.exception_handler(RequestValidationError)(_not_valid)
    _add_api(app, hub)
    add_mission_api(app, hub.missions)
    add_robot_files(app, hub.link)
    add_rerun(app, hub.link, (data or data_folder()) / "rerun")
    add_login(app, access, hub.link.events)
    add_user_api(app, access, hub.link.events)
    _add_sockets(app, hub, access)
    _add_pages(app, hub, folder)
    return app


async def _not_valid(_: Request, error: Exception) -> Response:
    """What is wrong with a request, in a sentence; what was sent is not sent back, it may not even be JSON."""
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    where = ".".join(str(part) for part in first["loc"][1:])
    return JSONResponse({"error": f"{where or first['loc'][0]}: {first['msg']}"}, status_code=422)


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


def _add_sockets(app: FastAPI, hub: Hub, access: Access) -> None:
    @app.websocket("/ws")
    async def page_socket(socket: WebSocket, page: str = "", operator: str = "") -> None:
        if not access.origin_allowed(socket.headers):
            await socket.close(code=1008)
            return
        who = access.identify(socket.headers, socket.cookies)
        await socket.accept()  # or the page would not be told why it is closed
        if who is None:
            await socket.close(code=LOGIN_NEEDED, reason="log in first")
            return
        if not _PAGE_ID.fullmatch(page):
            await socket.close(code=1008, reason="page is an id of 8 to 64 letters, digits and -")
            return
        try:
            session = hub.enter(page, operator, who, lambda: access.identify(socket.headers, socket.cookies))
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
        await socket.close(code=LOGIN_NEEDED if session.over else 1000 if hub.current(session) else REPLACED)
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

    @app.get("/viser/{key}/picture")
    async def picture(key: str, width: Annotated[int, Query(ge=64, le=3840)] = 1280,
                      height: Annotated[int, Query(ge=64, le=2160)] = 720) -> Response:  # fmt: skip
        page = hub.page_of(key)
        view = hub.scene(page) if page is not None else None
        pixels = await asyncio.to_thread(view.picture, height, width) if view is not None else None
        if pixels is None:
            return JSONResponse({"error": "the 3-D view gave no picture"}, status_code=404)
        return Response(await asyncio.to_thread(png, pixels), media_type="image/png")

    @app.get("/{path:path}")
    async def built(path: str) -> Response:
        root = folder or built_page.page_folder()
        if root is None:
            return HTMLResponse(built_page.NOT_BUILT, status_code=503)
        wanted = built_page.file_at(root, path or "index.html")
        if wanted is None:
            return JSONResponse({"error": "there is nothing at this address"}, status_code=404)
        lasting = path.startswith("assets/")  # the build puts a digest into their names
        caching = "public, max-age=31536000, immutable" if lasting else "no-cache"
        return FileResponse(wanted, headers={"Cache-Control": caching})
