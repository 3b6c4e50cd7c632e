"""Logging in and out, and the users for those who look after them."""

from __future__ import annotations

import asyncio
import json
from typing import Annotated
from urllib.parse import parse_qs

from fastapi import FastAPI, Request, Response
from fastapi.responses import HTMLResponse, JSONResponse, RedirectResponse
from pydantic import BaseModel, ConfigDict, Field

from weaver_console import built_page
from weaver_console.access import COOKIE, VALID_S, Access, Role
from weaver_console.event_log import EventLog
from weaver_shared.errors import InputError
from weaver_shared.messages import Severity

LARGEST_LOGIN = 4096

WRONG = "the name or the password is wrong"
ADMINS_ONLY = {"error": "only an admin may do that"}
TOO_MANY = "too many wrong passwords; wait a minute"


class KeptUser(BaseModel):
    """What an admin sends to add a user or to change one; what is left out stays."""

    model_config = ConfigDict(extra="forbid")

    role: Role | None = None
    password: Annotated[str, Field(max_length=LARGEST_LOGIN)] | None = None


def add_login(app: FastAPI, access: Access, events: EventLog) -> None:
    checking = asyncio.Semaphore(2)  # each takes 16 MB and a core for 50 ms

    @app.post("/api/login")
    async def login(request: Request) -> Response:
        is_form = request.headers.get("content-type", "").startswith("application/x-www-form-urlencoded")
        address = request.client.host if request.client is not None else ""
        given = _given(await request.body(), is_form)
        if given is None:
            return JSONResponse({"error": 'send {"name": "...", "password": "..."}'}, status_code=422)
        if access.open:
            return JSONResponse({"error": "nobody needs to log in here"}, status_code=409)
        async with checking:
            if access.blocked(address):
                return _refused(TOO_MANY, is_form, 429)
            entered = await asyncio.to_thread(access.log_in, *given, address)
        if entered is None:
            events.add("", Severity.WARNING, "console", f"a wrong name or password came from {address}")
            return _refused(WRONG, is_form, 401)
        user, secret = entered
        events.add("", Severity.INFO, user.name, f"{user.name} has logged in as {user.role} from {address}")
        response: Response = RedirectResponse("/", status_code=303)
        if not is_form:
            response = JSONResponse({"status": "ok", "name": user.name, "role": user.role})
        response.set_cookie(COOKIE, secret, max_age=VALID_S, httponly=True, samesite="strict",
                            secure=request.url.scheme == "https")  # fmt: skip
        return response

    @app.post("/api/logout")
    async def logout(request: Request) -> Response:
        access.log_out(request.cookies)
        response = JSONResponse({"status": "ok"})
        response.delete_cookie(COOKIE)
        return response


def add_user_api(app: FastAPI, access: Access, events: EventLog) -> None:
    def log(request: Request, answer: Response, text: str) -> Response:
        if answer.status_code == 200:
            who = request.state.who.name or "somebody at the console's computer"
            events.add("", Severity.INFO, who, text)
        return answer

    def administers(request: Request) -> bool:
        return bool(request.state.who.administers)

    @app.get("/api/users")
    async def users(request: Request) -> Response:
        if not administers(request):
            return JSONResponse(ADMINS_ONLY, status_code=403)
        return JSONResponse({"users": [user.to_page() for user in access.users.all()]})

    @app.put("/api/users/{name}")
    async def keep(name: str, user: KeptUser, request: Request) -> Response:
        if not administers(request):
            return JSONResponse(ADMINS_ONLY, status_code=403)
        return log(
            request, await asyncio.to_thread(_keep, access, name, user), f"user {name} has been added or changed"
        )

    @app.delete("/api/users/{name}")
    async def remove(name: str, request: Request) -> Response:
        if not administers(request):
            return JSONResponse(ADMINS_ONLY, status_code=403)
        return log(request, await asyncio.to_thread(_remove, access, name), f"user {name} has been removed")


def _keep(access: Access, name: str, user: KeptUser) -> Response:
    try:
        if access.users.find(name) is None:
            if user.password is None:
                raise InputError("a new user needs a password")
            access.users.add(name, user.role or Role.VIEWER, user.password)
        else:
            if user.role is not None:
                access.users.set_role(name, user.role)
            if user.password is not None:
                access.users.set_password(name, user.password)
    except InputError as error:
        return JSONResponse({"error": str(error)}, status_code=422)
    return JSONResponse({"status": "ok"})


def _remove(access: Access, name: str) -> Response:
    if access.users.find(name) is None:
        return JSONResponse({"deleted": False}, status_code=404)
    try:
        access.users.remove(name)
    except InputError as error:
        return JSONResponse({"error": str(error)}, status_code=422)
    return JSONResponse({"deleted": True})


def _refused(reason: str, is_form: bool, status: int) -> Response:
    if is_form:
        return HTMLResponse(built_page.login_page(reason), status_code=status)
    return JSONResponse({"error": reason}, status_code=status)


def _given(body: bytes, is_form: bool) -> tuple[str, str] | None:
    """Name and password, None when these are not what was sent."""
    if len(body) > LARGEST_LOGIN:
        return None
    try:
        if is_form:
            form = parse_qs(body.decode(), max_num_fields=8)
            given = form.get("name", [""])[0], form.get("password", [""])[0]
        else:
            sent = json.loads(body)
            given = sent["name"], sent["password"]
    except (ValueError, KeyError, TypeError, RecursionError):
        return None
    return given if all(isinstance(part, str) for part in given) else None
