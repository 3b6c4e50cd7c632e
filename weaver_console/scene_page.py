"""viser's own page with what an iframe needs: keys for the page around it, reconnection, taps as clicks, and thrift."""

from __future__ import annotations

import gzip
from functools import cache
from pathlib import Path

import viser

SHIM = """<script>
(() => {
  "use strict";
  // Keys pressed in the 3-D view never reach the page around it, and with them Escape and Space, which stop the robot.
  const forward = (event) => window.parent.postMessage({
    source: "weaver-scene", type: "key", event: event.type, key: event.key, code: event.code, repeat: event.repeat,
    ctrlKey: event.ctrlKey, shiftKey: event.shiftKey, altKey: event.altKey, metaKey: event.metaKey,
  }, window.location.origin);
  window.addEventListener("keydown", forward, true);
  window.addEventListener("keyup", forward, true);
  // viser reconnects only while its document has the focus, which inside an iframe it seldom has.
  document.hasFocus = () => true;
  // A touch is captured by what it began on, and viser then takes a tap for no click.
  window.addEventListener("pointerdown", (event) => {
    if (event.pointerType === "touch" && event.target.hasPointerCapture?.(event.pointerId)) {
      event.target.releasePointerCapture(event.pointerId);
    }
  }, true);
  // Without a graphics card every picture is drawn by the processor, which robot and page need more: fewer and smaller.
  const real = HTMLCanvasElement.prototype.getContext;
  const probe = real.call(document.createElement("canvas"), "webgl2");
  const named = probe?.getExtension("WEBGL_debug_renderer_info");
  const drawnBy = named ? probe.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  if (/swiftshader|llvmpipe|softpipe|software|basic render/i.test(drawnBy)) {
    HTMLCanvasElement.prototype.getContext = function (kind, options) {
      return real.call(this, kind, kind.startsWith("webgl") ? { ...options, antialias: false } : options);
    };
    fetch("thrift", { method: "POST" });
    const soon = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (draw) => window.setTimeout(() => soon(draw), 70);
    window.cancelAnimationFrame = (number) => window.clearTimeout(number);
    const address = new URL(window.location.href);
    address.searchParams.set("fixedDpr", "0.6");
    window.history.replaceState(null, "", address);
  }
})();
</script>"""

STYLE = """<style>
html, body { background: #14171b; }
/* viser's own panels: everything they offer is on the page around this one, with names for screen readers. */
[data-floating-window], [data-dock-region], .mantine-Notifications-root,
[style*="position: fixed"][style*="min-height: 3.5em"] { display: none !important; }
</style>"""


@cache
def scene_page() -> bytes:
    """The page as gzip."""
    built = Path(viser.__file__).parent / "client" / "build" / "index.html"
    text = built.read_text(encoding="utf-8")
    head = text.index("<head>") + len("<head>")
    return gzip.compress((text[:head] + SHIM + STYLE + text[head:]).encode(), compresslevel=6)
