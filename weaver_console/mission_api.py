"""Saved missions over HTTP: list, keep, delete."""

from __future__ import annotations

import asyncio
from typing import Annotated

from fastapi import FastAPI, Response
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field

from weaver_console.missions import LONGEST_NAME, MissionStore
from weaver_shared.config.command import CommandLimits
from weaver_shared.errors import InputError, ResourceError
from weaver_shared.messages import Waypoint

Coordinate = Annotated[float, Field(ge=-1e5, le=1e5, allow_inf_nan=False)]  # m


class Place(BaseModel):
    model_config = ConfigDict(extra="forbid")

    x: Coordinate
    y: Coordinate


class KeptMission(BaseModel):
    """What a page sends to keep."""

    model_config = ConfigDict(extra="forbid")

    waypoints: Annotated[list[Place], Field(max_length=CommandLimits().waypoint_count)]
    areas: Annotated[list[Annotated[list[Place], Field(min_length=3, max_length=400)]], Field(max_length=50)] = []
    operator: Annotated[str, Field(max_length=LONGEST_NAME)] = ""
    robot: Annotated[str, Field(max_length=LONGEST_NAME)] = ""


def add_mission_api(app: FastAPI, store: MissionStore) -> None:
    @app.get("/api/missions")
    async def missions() -> dict[str, object]:
        kept = await asyncio.to_thread(store.all)
        return {"missions": [mission.to_page() for mission in kept]}

    @app.put("/api/missions/{name}")
    async def keep(name: str, mission: KeptMission) -> Response:
        waypoints, *areas = (
            tuple(Waypoint(x=place.x, y=place.y) for place in part) for part in (mission.waypoints, *mission.areas)
        )
        try:
            kept = await asyncio.to_thread(
                store.save, name, waypoints, mission.operator, mission.robot, areas=tuple(areas)
            )
        except InputError as error:
            return JSONResponse({"error": str(error)}, status_code=422)
        except ResourceError as error:
            return JSONResponse({"error": str(error)}, status_code=507)
        return JSONResponse(kept.to_page())

    @app.delete("/api/missions/{name}")
    async def delete(name: str) -> Response:
        try:
            found = await asyncio.to_thread(store.delete, name)
        except ResourceError as error:
            return JSONResponse({"error": str(error)}, status_code=507)
        return JSONResponse({"deleted": found}, status_code=200 if found else 404)
