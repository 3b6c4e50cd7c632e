"""What measures the console sees what a page would see."""

import asyncio
import threading
import time

import pytest
from running_console import Console
from wire_robot import WireRobot

from weaver_console.measuring import bench_console, bench_links
from weaver_console.measuring.made_robot import MadeRobot
from weaver_console.measuring.narrow_way import NarrowWay
from weaver_console.measuring.page_client import PageClient
from weaver_console.measuring.percentiles import percentiles_ms
from weaver_shared.bus import MemoryBus
from weaver_shared.errors import InputError


async def _visit(page: PageClient, port: int, enough: object) -> None:
    visit = asyncio.create_task(page.run(port))
    async with asyncio.timeout(10.0):
        while not enough():  # type: ignore[operator]
            await asyncio.sleep(0.01)
    visit.cancel()
    await asyncio.gather(visit, return_exceptions=True)


def test_a_made_robot_is_heard_and_answers(console: Console, bus: MemoryBus) -> None:
    robot = MadeRobot(bus, "made-1", extent=2.6)
    robot.publish_map()
    robot.publish_slow()
    robot.publish_gait(1)
    page = PageClient(1, robot="made-1", commands=True)
    ended = threading.Event()

    def talk() -> None:
        tick = 0
        while not ended.wait(0.02):
            robot.publish_state(tick := tick + 1)

    talking = threading.Thread(target=talk)
    talking.start()
    try:
        asyncio.run(_visit(page, console.port, lambda: len(page.heard.states) > 5 and page.heard.round_trips))
    finally:
        ended.set()
        talking.join()
    assert all(0.0 < delay < 5.0 for delay in page.heard.states)
    assert len(page.heard.tiles) == 16
    assert 8000 < page.heard.tile_bytes / 16 < 9000
    assert page.scene is not None


def test_a_narrow_way_carries_so_many_bytes_a_second_and_no_more(console: Console, robot: WireRobot) -> None:
    robot.publish_map(2)
    for _ in range(6):
        robot.step()

    async def through() -> float:
        way = NarrowWay(console.port, rate=200e3)
        port = await way.open()
        page = PageClient(1, robot=robot.robot_id)
        begun = time.monotonic()
        await _visit(page, port, lambda: len(page.heard.tiles) == 16)
        await way.close()
        return page.heard.bytes / (time.monotonic() - begun)

    assert asyncio.run(through()) < 220e3


def test_percentiles_of_nothing_are_none_rather_than_zero() -> None:
    assert percentiles_ms([], 50) == {"count": 0, "p50": None}
    assert percentiles_ms([0.001, 0.002, 0.003], 50) == {"count": 3, "p50": 2.0}


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [(["--only", "moon"], "no case is called like 'moon'"), (["--drive", "cruise,foot"], "can not be driven by foot")],
)
def test_lost_links_that_are_not_known_are_refused(arguments: list[str], complaint: str) -> None:
    with pytest.raises(InputError, match=complaint):
        bench_links.main(arguments)


def test_a_case_of_the_console_that_is_not_known_is_refused() -> None:
    with pytest.raises(InputError, match=r"no case is called like 'moon'; there are 1 page, .* one in Chromium"):
        bench_console.main(["--only", "moon"])
