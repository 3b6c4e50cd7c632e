"""`weaver router`: a fixed address on the bus at which the processes of robots and consoles find each other.

Processes that meet here connect to each other directly, so they stay in touch when this one ends.
"""

import argparse
import signal
import threading

from weaver_shared.bus import ZenohBus


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    bus = ZenohBus(listen=[options.listen])
    try:
        print(f"the bus meets at {options.listen}", flush=True)
        ended.wait()
    finally:
        bus.close()
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver router", description=__doc__)
    parser.add_argument("--listen", default="tcp/127.0.0.1:7447", help="bus endpoint to listen on (%(default)s)")
    return parser
