"""The console's page in a real Chromium without a screen: from the address to the first values, from a click to its
answer, from a change to the picture.
"""

from __future__ import annotations

import importlib
import importlib.util
import shutil
import tempfile
import time
from typing import Any

from weaver_console.measuring.crowd import Crowd
from weaver_console.measuring.percentiles import percentiles_ms
from weaver_console.measuring.processes import MeasuredProcess, console_process
from weaver_shared.bus import free_port
from weaver_shared.errors import ResourceError
from weaver_shared.quiet_chromium import FLAGS

ROBOT = "made-1"
VISITS = 5
USABLE = "performance.getEntriesByName('weaver.usable').map((mark) => mark.startTime)"
"""ms from asking for the page until it showed values of a robot, by the page's own mark."""

WATCH = """
window.measured = { answers: [], drawn: [] };
let clicked = 0, waiting = [];
document.addEventListener("click", () => (clicked = performance.now()), true);
const RealSocket = window.WebSocket;
window.WebSocket = class extends RealSocket {
  constructor(...given) {
    super(...given);
    this.addEventListener("message", ({ data }) => {
      if (typeof data !== "string") return;
      if (clicked && data.includes('"type":"answer"')) {
        window.measured.answers.push(performance.now() - clicked);
        clicked = 0;
      }
      for (const found of data.matchAll(/"key":"tele\\/map\\/tile\\/[^"]*","kind":"\\w+","stamp_ns":(\\d+)/g)) {
        waiting.push(Number(found[1]));
      }
    });
  }
};
const draw = CanvasRenderingContext2D.prototype.putImageData;
CanvasRenderingContext2D.prototype.putImageData = function (...given) {
  draw.apply(this, given);
  if (waiting.length === 0) return;
  const stamps = waiting;
  waiting = [];
  requestAnimationFrame(() => requestAnimationFrame(() => {
    const now = performance.timeOrigin + performance.now();
    for (const stamp of stamps) window.measured.drawn.push([stamp, now]);
  }));
};
"""
"""Delays are taken where the page itself would notice: the click's own event, the socket's message, and the picture
after the one in which a new tile was painted onto the 2-D map."""


def measure_real_page(clicks: int, others: int, *, narrow_rate: float) -> dict[str, Any]:
    """Figures in ms beside so many other pages, one of them behind `narrow_rate` bytes/s; or why there are none."""
    chromium = shutil.which("chromium")
    if chromium is None:
        return {"skipped": "Chromium is not installed"}
    if importlib.util.find_spec("playwright") is None:
        return {"skipped": "playwright is not installed"}
    port, endpoint = free_port(), f"tcp/127.0.0.1:{free_port()}"
    made = ["--robot-id", ROBOT, "--connect", endpoint, "--extent", "10", "--map-rate", "10"]
    with (
        tempfile.TemporaryDirectory() as data,
        console_process(port, data, "--listen", endpoint) as console,
        MeasuredProcess("weaver_console.measuring.made_robot", *made),
        Crowd(others, port, ROBOT, narrow_rate=narrow_rate),
    ):
        before, begun = console.cpu_seconds(), time.monotonic()
        measured = _drive(chromium, f"http://127.0.0.1:{port}/", clicks)
        cpu = (console.cpu_seconds() - before) / (time.monotonic() - begun)
    return measured | {"console_cpu_percent": round(100.0 * cpu, 1), "drawn_on": "2-D map, no WebGL"}


def _drive(chromium: str, address: str, clicks: int) -> dict[str, Any]:
    playwright = importlib.import_module("playwright.sync_api")  # only who measures a real page needs it
    with playwright.sync_playwright() as machine:
        browser = machine.chromium.launch(executable_path=chromium, args=[*FLAGS, "--disable-3d-apis"])
        page = browser.new_page(viewport={"width": 1440, "height": 900})
        page.add_init_script(WATCH)
        page.goto(address)
        taking, releasing = (page.get_by_role("button", name=f"{verb} control") for verb in ("Take", "Release"))
        taking.wait_for(timeout=20_000)
        for _ in range(clicks // 2):
            taking.click(timeout=10_000)
            releasing.click(timeout=10_000)
            page.wait_for_timeout(50)
        measured = page.evaluate("window.measured")
        browser.close()
        # With the 3-D view, as usual, and nothing kept from the visit before.
        browser = machine.chromium.launch(executable_path=chromium, args=[*FLAGS])
        usable = [_visit(browser, address) for _ in range(VISITS)]
        browser.close()
    # The page counts in unix time, the robot on the monotonic clock.
    unix_ahead = time.time() - time.monotonic()
    drawn = [now * 1e-3 - unix_ahead - stamp * 1e-9 for stamp, now in measured["drawn"]]
    whole_map = 300  # tiles that were there before the page, of 256
    return {
        "usable_ms": percentiles_ms([delay * 1e-3 for delay in usable], 50, 100),
        "click_to_answer_ms": percentiles_ms([delay * 1e-3 for delay in measured["answers"]], 50, 95),
        "change_to_drawn_ms": percentiles_ms(drawn[whole_map:], 50, 95),
    }


def _visit(browser: Any, address: str) -> float:
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    page.goto(address, wait_until="commit")
    until = time.monotonic() + 30.0
    while not (marks := page.evaluate(USABLE)) and time.monotonic() < until:
        page.wait_for_timeout(50)
    page.close()
    if not marks:
        raise ResourceError("the page showed no robot for 30 s")
    return float(marks[0])
