"""Takes Rerun's web viewer out of its wheel: `python -m weaver_console.rerun_assets FOLDER`.

The viewer lies inside the library's binary, which hands it out over HTTP alone; the library takes 200 MB of memory, so
this is a program of its own that ends when it is done.
"""

from __future__ import annotations

import gzip
import re
import sys
import urllib.request
from pathlib import Path

from weaver_shared.bus import free_port

FILES = ("index.html", "re_viewer.js", "re_viewer_bg.wasm", "sw.js", "favicon.ico")
_ELSEWHERE = re.compile(rb"<link[^>]*https://[^>]*>")


def main(arguments: list[str]) -> int:
    import rerun

    (folder,) = arguments
    port = free_port()
    rerun.serve_web_viewer(web_port=port, open_browser=False)
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    for name in FILES:
        with opener.open(f"http://127.0.0.1:{port}/{'' if name == 'index.html' else name}", timeout=30.0) as answer:
            content = answer.read()
        if name == "index.html":
            content = _ELSEWHERE.sub(b"", content)  # fonts of another host
        path = Path(folder) / f"{name}.gz"
        path.with_suffix(".part").write_bytes(gzip.compress(content, compresslevel=5))
        path.with_suffix(".part").rename(path)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
