"""The page for everybody: screen readers, keys alone, no graphics, small and quick, and no other host."""

from __future__ import annotations

import gzip
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from visitors import DESK, PHONE

from weaver_console import built_page

pytestmark = pytest.mark.browser

AXE = Path(__file__).parents[2] / "web" / "node_modules" / "axe-core" / "axe.min.js"
GRAVE = {"serious", "critical"}


def _faults(visitor: Any) -> list[str]:
    visitor.page.evaluate(AXE.read_text(encoding="utf-8"))
    found = visitor.page.evaluate("axe.run(document, {resultTypes: ['violations']})")
    return [
        f"{fault['id']}: {fault['help']} {[node['target'] for node in fault['nodes']][:3]}"
        for fault in found["violations"]
        if fault["impact"] in GRAVE
    ]


@pytest.mark.skipif(not AXE.exists(), reason="axe-core is not installed")
@pytest.mark.parametrize(("theme", "size"), [("light", DESK), ("dark", DESK), ("dark", PHONE)])
def test_axe_finds_nothing_serious(
    visit: Callable[..., Any], theme: str, size: tuple[int, int], picture: Callable[..., None]
) -> None:
    anna = visit(color_scheme=theme, size=size)
    anna.stand()
    assert _faults(anna) == []
    picture(anna, f"{theme}-{size[0]}")


def test_the_page_works_without_3d_and_is_driven_by_keys_alone(visit: Callable[..., Any], stage: Any) -> None:
    anna = visit(flags=("--disable-3d-apis",), scene=True)
    assert anna.page.locator("iframe.scene").count() == 0
    anna.page.get_by_text("This browser has no WebGL 2").wait_for()
    for name in ("Take control", "Stand"):
        anna.button(name).focus()
        anna.page.keyboard.press("Enter")
        anna.page.wait_for_timeout(600)
    anna.see_state("STAND")
    anna.page.get_by_role("application", name="Map", exact=True).focus()
    for key in ("ArrowRight", "Enter"):
        anna.page.keyboard.press(key)
    anna.waypoints.first.wait_for()
    anna.button("Start mission").focus()
    anna.page.keyboard.press("Enter")
    anna.see_state("WALK")
    anna.page.keyboard.press("Escape")
    anna.see_state("ESTOP")
    assert stage.robot.stopped


def test_the_page_is_small_quick_and_asks_nobody_else(visit: Callable[..., Any], stage: Any) -> None:
    folder = built_page.page_folder()
    assert folder is not None
    own = [path for path in folder.rglob("*") if path.suffix in (".js", ".css", ".html")]
    assert sum(len(gzip.compress(path.read_bytes(), 6)) for path in own) < 300_000
    anna = visit()
    # A busy computer is not the page's fault: what counts is the processor time that the page itself takes.
    browser = anna.page.context.new_cdp_session(anna.page)
    browser.send("Performance.enable", {"timeDomain": "threadTicks"})
    anna.page.reload()
    anna.see_state("SIT")
    assert anna.page.evaluate("performance.getEntriesByName('weaver.usable').length") == 1
    took = {metric["name"]: metric["value"] for metric in browser.send("Performance.getMetrics")["metrics"]}
    assert 0.0 < took["TaskDuration"] < 2.0
    hosts = {address.split("/")[2] for address in anna.requested if address.startswith(("http", "ws"))}
    assert hosts == {stage.address.split("/")[2]}
