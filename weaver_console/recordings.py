"""Hands out a robot's recordings: asked for in parts over the bus, passed on as one file."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator

from fastapi import FastAPI, Response
from fastapi.responses import JSONResponse, StreamingResponse

from weaver_console.link import Link
from weaver_shared import topics
from weaver_shared.errors import WeaverError
from weaver_shared.messages import PartRequest, RecordingPart

PART_BYTES = 1024 * 1024
TIMEOUT = 5.0
"""s that a part may take, on a slow link as well."""

LONGEST_NAME = 120


def add_recordings(app: FastAPI, link: Link) -> None:
    @app.get("/api/recordings/{robot}/{name}")
    async def download(robot: str, name: str) -> Response:
        if link.robot(robot) is None or len(name) > LONGEST_NAME:
            return JSONResponse({"error": f"there is no robot {robot!r:.60} with such a recording"}, status_code=404)
        try:
            first = await _part(link, robot, name, 0)
        except WeaverError as error:
            return JSONResponse({"error": str(error)}, status_code=504)
        if first.reason:
            return JSONResponse({"error": first.reason}, status_code=404)
        headers = {
            "Content-Length": str(first.size),
            "Content-Disposition": f'attachment; filename="{name}"',
            "Cache-Control": "no-store",
        }
        return StreamingResponse(
            _bytes(link, robot, name, first), media_type="application/octet-stream", headers=headers
        )


async def _bytes(link: Link, robot: str, name: str, first: RecordingPart) -> AsyncIterator[bytes]:
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
            part = await _part(link, robot, name, sent)


async def _part(link: Link, robot: str, name: str, offset: int) -> RecordingPart:
    request = PartRequest(name=name, offset=offset, length=PART_BYTES)
    return await asyncio.to_thread(link.bus.ask, robot, topics.RECORDING_PART, request, TIMEOUT)
