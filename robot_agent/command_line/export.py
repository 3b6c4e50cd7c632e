"""`weaver export`: a recording as a file of Rerun's viewer."""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

from robot_agent.recording.playback import Playback
from weaver_shared.errors import ResourceError


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    target: Path = options.output or options.file.with_suffix(".rrd")
    playback = Playback(options.file)
    try:
        from robot_agent.evaluation.rerun_file import RerunFile  # takes a second, and only this program needs it
    except ImportError as error:
        raise ResourceError("Rerun is not installed; `pip install rerun-sdk` brings it") from error
    began = time.perf_counter()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        file = RerunFile(target, playback)
        messages = file.write_all(playback)
        file.close()
    except OSError as error:
        raise ResourceError(f"{target} can not be written: {error.strerror}") from error
    finally:
        playback.close()
    report = {"file": str(target), "messages": messages, "recorded_s": round(playback.seconds, 3),
              "size_b": target.stat().st_size, "took_s": round(time.perf_counter() - began, 3)}  # fmt: skip
    if options.json:
        print(json.dumps(report))
    else:
        print(f"{target}: {messages} messages of {playback.seconds:.1f} s", file=sys.stderr)
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver export", description="Write a recording as a Rerun file (.rrd).")
    parser.add_argument("file", metavar="FILE", type=Path, help=".mcap of `weaver record` or of the console")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help=".rrd to write (beside the recording)")
    parser.add_argument("--json", action="store_true", help="print one JSON object: messages, recorded s, B, s taken")
    return parser
