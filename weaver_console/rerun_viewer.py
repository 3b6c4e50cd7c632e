"""Rerun beside the console: recordings as .rrd, and its web viewer from the console's own origin, without a network."""

from __future__ import annotations

import asyncio
import hashlib
import importlib.metadata
import importlib.util
import sys
from collections import defaultdict
from pathlib import Path

from fastapi import FastAPI, Response
from fastapi.responses import FileResponse, JSONResponse

from weaver_console.link import Link
from weaver_console.rerun_assets import FILES
from weaver_console.robot_files import fetch_recording
from weaver_shared.errors import InputError, ResourceError, WeaverError

KEPT = 8
"""Converted recordings on the console's disk; the oldest make room."""

LONGEST = 900.0
"""s that a conversion may take."""

MEDIA = {".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm", ".ico": "image/x-icon"}


class RerunDesk:
    """Converts recordings, one at a time, each in a process of its own, and remembers what it has made."""

    def __init__(self, link: Link, folder: Path) -> None:
        self._link = link
        self._folder = folder
        self._converting = asyncio.Lock()
        self._unpacking: dict[str, asyncio.Lock] = defaultdict(asyncio.Lock)

    @property
    def installed(self) -> bool:
        return importlib.util.find_spec("rerun") is not None

    async def rrd(self, robot: str, recording: str) -> Path:
        """The recording as .rrd. Raises InputError when there is none, ResourceError when it can not be made."""
        if not self.installed:
            raise ResourceError("Rerun is not installed beside the console; `pip install rerun-sdk` brings it")
        async with self._converting:
            # Not by the names that were asked for: they may be longer than a file's, or none at all.
            digest = hashlib.sha256(f"{robot}\n{recording}".encode(errors="replace")).hexdigest()
            source = self._folder / "recordings" / f"{digest}.mcap"
            source.parent.mkdir(parents=True, exist_ok=True)
            try:
                size = await fetch_recording(self._link, robot, recording, source)
                target = source.with_name(f"{source.stem} {size}.rrd")
                if not target.exists():
                    await _convert(source, target)
            finally:
                source.unlink(missing_ok=True)
            self._make_room(target)
            return target

    async def viewer_file(self, name: str) -> Path | None:
        """One of the viewer's files, compressed; None when it has no such file. Raises ResourceError."""
        if name not in FILES:
            return None
        if not self.installed:
            raise ResourceError("Rerun is not installed beside the console; `pip install rerun-sdk` brings it")
        folder = self._folder / f"viewer-{importlib.metadata.version('rerun-sdk')}"
        async with self._unpacking["viewer"]:
            if not all((folder / f"{file}.gz").exists() for file in FILES):
                folder.mkdir(parents=True, exist_ok=True)
                await _run("weaver_console.rerun_assets", str(folder))
        return folder / f"{name}.gz"

    def _make_room(self, newest: Path) -> None:
        made = sorted(newest.parent.glob("*.rrd"), key=lambda path: path.stat().st_mtime)
        for path in made[:-KEPT]:
            path.unlink(missing_ok=True)


def add_rerun(app: FastAPI, link: Link, folder: Path) -> None:
    desk = RerunDesk(link, folder)

    @app.get("/api/rerun/{robot}/{name}")
    async def rrd(robot: str, name: str) -> Response:
        """`name` is a recording's with .rrd in place of .mcap."""
        recording = f"{name.removesuffix('.rrd')}.mcap"
        try:
            path = await desk.rrd(robot, recording)
        except InputError as error:
            return JSONResponse({"error": str(error)}, status_code=404)
        except WeaverError as error:
            return JSONResponse({"error": str(error)}, status_code=504)
        return FileResponse(path, media_type="application/octet-stream", filename=name)

    @app.get("/rerun/")
    @app.get("/rerun/{name}")
    async def viewer(name: str = "index.html") -> Response:
        try:
            path = await desk.viewer_file(name)
        except WeaverError as error:
            return JSONResponse({"error": str(error)}, status_code=504)
        if path is None:
            return JSONResponse({"error": "there is nothing at this address"}, status_code=404)
        headers = {"Content-Encoding": "gzip", "Cache-Control": "private, max-age=86400"}
        return FileResponse(path, media_type=MEDIA[Path(name).suffix], headers=headers)


async def _convert(source: Path, target: Path) -> None:
    part = target.with_suffix(".part")
    try:
        await _run("weaver_shared.command_line", "export", str(source), "--output", str(part))
        part.rename(target)
    finally:
        part.unlink(missing_ok=True)


async def _run(module: str, *arguments: str) -> None:
    """A program of ours to its end, with what it complains of as a ResourceError."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-m", module, *arguments,
        stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.DEVNULL, stderr=asyncio.subprocess.PIPE,
    )  # fmt: skip
    try:
        _, said = await asyncio.wait_for(process.communicate(), LONGEST)
    except TimeoutError as error:
        process.kill()
        raise ResourceError(f"the conversion took longer than {LONGEST:.0f} s") from error
    if process.returncode:
        lines = said.decode(errors="replace").strip().splitlines()
        raise ResourceError(lines[-1] if lines else f"{module} ended with code {process.returncode}")
