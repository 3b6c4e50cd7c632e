"""All pages of a console: who is connected, their scenes, and the two clocks that keep both up to date."""

from __future__ import annotations

import asyncio
import contextlib
import hashlib
import hmac
import logging
import random
import secrets
import threading
import time
from collections.abc import Callable

from weaver_console import operator_names
from weaver_console.access import OPEN, Identity
from weaver_console.command_desk import CommandDesk
from weaver_console.database import Database
from weaver_console.event_archive import EventArchive
from weaver_console.handover import Handover
from weaver_console.link import Link
from weaver_console.missions import MissionStore
from weaver_console.page_session import PageSession
from weaver_console.roster import Roster
from weaver_console.scene.page_scene import PageScene
from weaver_console.scene.posture import Postures
from weaver_console.scene.terrain_figure import MeshStore

logger = logging.getLogger(__name__)

CHECK_PERIOD = 0.1
EXPIRY_PERIOD = 1.0
"""s between two looks whether whoever has logged in still may be here."""

SCENE_PERIOD = 1.0 / 15.0
"""15 Hz for the robot in the 3-D views."""

GROUND = 3
"""Pictures between new ground: 5 times a second."""

THRIFT = 3
"""Only every third picture for a browser without a graphics card."""

SCENE_KEPT = 10.0
"""Seconds that the 3-D view of a page outlives its connection, so that a short break does not redraw it."""


class Hub:
    def __init__(
        self,
        link: Link,
        *,
        database: Database | None = None,
        scenes: bool = True,
        random_source: random.Random | None = None,
    ) -> None:
        """Without a `database` missions and events last as long as the console."""
        self.link = link
        self._database = database or Database(None)
        self.missions = MissionStore(self._database)
        self.archive = EventArchive(self._database, link.events)
        self.roster = Roster(link)
        self.with_scenes = scenes
        self.started = time.monotonic()
        self._desk = CommandDesk(link)
        self._handover = Handover(link)
        self._random = random_source or random.Random()
        self._secret = secrets.token_bytes(32)
        self._sessions: dict[str, PageSession] = {}
        self._scenes: dict[str, PageScene] = {}
        self._orphaned: dict[str, float] = {}
        self._store, self._postures = MeshStore(), Postures()
        self._expiry_due = 0.0
        self._stopping = threading.Event()
        self._drawer = threading.Thread(target=self._draw, name="scenes", daemon=True)

    @property
    def pages(self) -> int:
        return len(self._sessions)

    def start(self) -> None:
        """From the event loop that the pages' sessions run in."""
        loop = asyncio.get_running_loop()

        def hear(robot_id: str) -> None:
            with contextlib.suppress(RuntimeError):  # the loop has ended
                loop.call_soon_threadsafe(self._wake, robot_id)

        self.link.on_news = hear
        self._drawer.start()

    async def keep_checking(self) -> None:
        """Watch the robots and close the scenes of pages that have gone, until cancelled."""
        while True:
            self.link.check()
            self.roster.refresh()
            self._close_orphans()
            self._end_expired()
            self._handover.check()
            if self.archive.behind:
                await asyncio.to_thread(self.archive.flush)
            await asyncio.sleep(CHECK_PERIOD)

    def stop(self) -> None:
        self._stopping.set()
        if self._drawer.is_alive():
            self._drawer.join(timeout=2.0)
        for scene in self._scenes.values():
            scene.close()
        self._scenes.clear()
        self._desk.close()
        self.archive.flush()
        self._database.close()

    def enter(
        self, page: str, operator: str, who: Identity = OPEN, still: Callable[[], Identity | None] = lambda: OPEN
    ) -> PageSession:
        """A page connects, or again with the same id; an empty operator gets an invented name.

        Whoever has logged in goes by that name. `still` tells who the page is from later on: None once the login has
        expired.
        """
        operator = who.name or operator
        taken = {session.operator for name, session in self._sessions.items() if name != page}
        if operator:
            name = operator_names.distinct(operator_names.valid(operator), taken)
        else:
            name = operator_names.invent(taken, self._random)
        # The same for a page that returns, so that its view stays; nobody can tell it from the page's id.
        key = hmac.new(self._secret, page.encode(), hashlib.sha256).hexdigest()[:32]
        session = PageSession(
            page=page,
            scene_key=key,
            operator=name,
            who=who,
            still=still,
            link=self.link,
            roster=self.roster,
            desk=self._desk,
            handover=self._handover,
        )
        if (former := self._sessions.get(page)) is not None:
            self._handover.leave(former)
        self._sessions[page] = session
        self._handover.enter(session)
        self._orphaned.pop(page, None)
        session.greet(with_scene=self.with_scenes)
        return session

    def leave(self, session: PageSession) -> None:
        session.end()
        self._handover.leave(session)
        if self._sessions.get(session.page) is session:
            del self._sessions[session.page]
            self._orphaned[session.page] = time.monotonic()

    def current(self, session: PageSession) -> bool:
        """False once the same page has connected anew."""
        return self._sessions.get(session.page) is session

    def page_of(self, scene_key: str) -> str | None:
        """The connected page to which a 3-D view's secret was given; None for any other text."""
        return next((name for name, session in self._sessions.items() if session.scene_key == scene_key), None)

    def scene(self, page: str) -> PageScene | None:
        """The page's 3-D view, opened at its first use; None for a page that is not connected."""
        session = self._sessions.get(page)
        if session is None or not self.with_scenes:
            return None
        scene = self._scenes.get(page)
        if scene is None:
            scene = PageScene(
                self._store,
                on_pick=lambda point: self._tell(page, "pick", point),
                on_drag=lambda index, point, done: self._tell(page, "drag", index, point, done),
                on_legend=lambda scale: self._tell(page, "show_legend", scale),
                postures=self._postures,
            )
            self._scenes[page] = scene
        if session.scene is not scene:
            session.scene = scene
            scene.wish(**session.wishes)
        return scene

    def _wake(self, robot_id: str) -> None:
        for session in self._sessions.values():
            if session.robot == robot_id:
                session.wake()

    def _tell(self, page: str, what: str, *arguments: object) -> None:
        session = self._sessions.get(page)
        if session is not None:
            getattr(session, what)(*arguments)

    def _end_expired(self) -> None:
        now = time.monotonic()
        if now < self._expiry_due:
            return
        self._expiry_due = now + EXPIRY_PERIOD
        for session in list(self._sessions.values()):
            session.check_login()

    def _close_orphans(self) -> None:
        for page, since in list(self._orphaned.items()):
            if time.monotonic() - since > SCENE_KEPT:
                del self._orphaned[page]
                scene = self._scenes.pop(page, None)
                if scene is not None:
                    threading.Thread(target=scene.close, daemon=True).start()

    def _draw(self) -> None:
        """Keep every watched scene up to date; a fault in one is logged once and ends neither it nor the others."""
        faulty: set[str] = set()
        tick = 0
        while not self._stopping.wait(SCENE_PERIOD):
            tick += 1
            for page, scene in list(self._scenes.items()):
                session = self._sessions.get(page)
                if session is None or not scene.watched or (scene.thrifty and tick % THRIFT):
                    continue
                try:
                    record = self.link.robot(session.robot) if session.robot is not None else None
                    scene.update(record, ground_due=tick % GROUND == 0)
                except Exception:
                    if page not in faulty:
                        faulty.add(page)
                        logger.exception("the 3-D view of page %s was not drawn completely", page)
