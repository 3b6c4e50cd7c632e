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
  }, new URL(window.location.href).origin);
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
  // The frame is sandboxed, so that it gets a process of its own. There no module worker may come from a blob; viser's
  // is a module only for the sake of giving its address back, so it becomes a plain one that does not.
  const RealBlob = window.Blob, RealWorker = window.Worker;
  const plain = (part) => (typeof part === "string" ? part.replace("URL.revokeObjectURL(import.meta.url);", "") : part);
  window.Blob = function (parts = [], options) {
    return new RealBlob(/javascript/.test(options?.type) ? Array.from(parts, plain) : parts, options);
  };
  window.Blob.prototype = RealBlob.prototype;
  window.Worker = function (address, options) {
    return new RealWorker(address, String(address).startsWith("blob:") ? { ...options, type: "classic" } : options);
  };
  // Without a graphics card every picture is drawn by the processor, which robot and page need more: fewer and smaller.
  const real = HTMLCanvasElement.prototype.getContext;
  const probe = real.call(document.createElement("canvas"), "webgl2");
  const named = probe?.getExtension("WEBGL_debug_renderer_info");
  const drawnBy = named ? probe.getParameter(named.UNMASKED_RENDERER_WEBGL) : "";
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  if (/swiftshader|llvmpipe|softpipe|software|basic render/i.test(drawnBy)) {
    const views = [];
    HTMLCanvasElement.prototype.getContext = function (kind, options) {
      if (!kind.startsWith("webgl")) return real.call(this, kind, options);
      const made = real.call(this, kind, { ...options, antialias: false });
      if (made && !views.includes(made)) views.push(made);
      return made;
    };
    const size = ({ canvas }) => (canvas.isConnected ? canvas.width * canvas.height : 0);
    const largest = () => views.reduce((best, one) => (best && size(best) >= size(one) ? best : one), null);
    fetch("thrift", { method: "POST", mode: "no-cors" });
    // After each picture a rest three times as long as its drawing took; while the view is turned, as long.
    const shortestRest = 70, longestRest = 1200;
    let cost = 0, touched = -Infinity;
    for (const kind of ["pointerdown", "pointermove", "wheel"]) {
      window.addEventListener(kind, (event) => {
        if (kind !== "pointermove" || event.buttons) touched = performance.now();
      }, { capture: true, passive: true });
    }
    const rest = () =>
      Math.min(longestRest, Math.max(shortestRest, cost * (performance.now() - touched < 1000 ? 1 : 3)));
    const measure = (began, view, fence) => {
      const took = performance.now() - began;
      const drawn = !fence || took > 2000 || view.getSyncParameter(fence, view.SYNC_STATUS) === view.SIGNALED;
      if (!drawn) return void window.setTimeout(measure, 12, began, view, fence);
      if (fence) view.deleteSync(fence);
      cost = Math.max(0.8 * cost, took);
    };
    const soon = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (draw) => window.setTimeout(() => soon((now) => {
      const began = performance.now();
      draw(now);
      const view = largest();
      const fence = view?.fenceSync?.(view.SYNC_GPU_COMMANDS_COMPLETE, 0) ?? null;
      if (fence) view.flush();
      measure(began, view, fence);
    }), rest());
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
