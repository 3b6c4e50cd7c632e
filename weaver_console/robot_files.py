"""Hands out a robot's files, recordings and calibrations: asked for in parts over the bus, passed on as one."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

from fastapi import FastAPI, Response
from fastapi.responses import JSONResponse, StreamingResponse

from weaver_console.link import Link
from weaver_shared import topics
from weaver_shared.errors import InputError, WeaverError
from weaver_shared.messages import PartRequest, RecordingPart
from weaver_shared.topics import Query

PART_BYTES = 1024 * 1024
TIMEOUT = 5.0
"""s that a part may take, on a slow link as well."""

LONGEST_NAME = 200

PartQuery = Query[PartRequest, RecordingPart]


SHOWN = {".html": "text/html", ".md": "text/plain", ".yaml": "text/plain", ".toml": "text/plain"}
"""What a browser may show; all else is saved."""


def add_robot_files(app: FastAPI, link: Link) -> None:
    @app.get("/api/recordings/{robot}/{name}")
    async def recording(robot: str, name: str) -> Response:
        return await _file(link, topics.RECORDING_PART, robot, name)

    @app.get("/api/calibrations/{robot}/{folder}/{name}")
    async def calibration(robot: str, folder: str, name: str) -> Response:
        return await _file(link, topics.CALIBRATION_PART, robot, f"{folder}/{name}")


async def _file(link: Link, query: PartQuery, robot: str, name: str) -> Response:
    if link.robot(robot) is None or len(name) > LONGEST_NAME:
        return JSONResponse({"error": f"there is no robot {robot!r:.60} with such a file"}, status_code=404)
    try:
        first = await _part(link, query, robot, name, 0)
    except WeaverError as error:
        return JSONResponse({"error": str(error)}, status_code=504)
    if first.reason:
        return JSONResponse({"error": first.reason}, status_code=404)
    short = name.rpartition("/")[2]
    media = SHOWN.get(short[short.rfind(".") :], "application/octet-stream")
    headers = {"Content-Length": str(first.size), "Cache-Control": "no-store"}
    if media != "text/html":
        headers["Content-Disposition"] = f'attachment; filename="{short}"'
    return StreamingResponse(_bytes(link, query, robot, name, first), media_type=media, headers=headers)


async def _bytes(link: Link, query: PartQuery, robot: str, name: str, first: RecordingPart) -> AsyncIterator[bytes]:
    """As many bytes as the file had at first; one that is being written grows meanwhile.

    Raises WeaverError when the robot falls silent: the download is then seen to be broken off.
    """
    sent, part = 0, first
    while sent < first.size:
        data = part.data[: first.size - sent]
        if not data:
            raise WeaverError(f"{robot} does not hand out the rest of {name}: {part.reason or 'it is shorter now'}")
        yield data
        sent += len(data)
        if sent < first.size:
            part = await _part(link, query, robot, name, sent)


async def fetch_recording(link: Link, robot: str, name: str, target: Path) -> int:
    """A whole recording into a file; returns its size. Raises InputError when there is none, else WeaverError."""
    if link.robot(robot) is None or len(name) > LONGEST_NAME or "/" in name:
        raise InputError(f"there is no robot {robot!r:.60} with such a file")
    first = await _part(link, topics.RECORDING_PART, robot, name, 0)
    if first.reason:
        raise InputError(first.reason)
    with target.open("wb") as stream:
        async for data in _bytes(link, topics.RECORDING_PART, robot, name, first):
            stream.write(data)
    return first.size


async def _part(link: Link, query: PartQuery, robot: str, name: str, offset: int) -> RecordingPart:
    request = PartRequest(name=name, offset=offset, length=PART_BYTES)
    return await asyncio.to_thread(link.bus.ask, robot, query, request, TIMEOUT)
