"""Emulated buses on pseudo-terminals in a process of their own."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.synchronize import Event

from robot_agent.hardware.wiring import Wiring
from sim_agent.model import sitting_joints
from sim_agent.servo_bus.joints import FirstOrderJoints
from sim_agent.servo_bus.twin import TwinServos, TwinTerminals
from weaver_shared.errors import ResourceError

STARTING = 300.0  # s for the process to come up, on however busy a computer


@contextmanager
def served(wiring: Wiring) -> Iterator[None]:
    """Simple joints behind the buses of a wiring, sitting, with the wire's own timing, while in the `with` block."""
    context = multiprocessing.get_context("spawn")
    ready, ending = context.Event(), context.Event()
    process = context.Process(target=_serve, args=(wiring, ready, ending), daemon=True)
    process.start()
    try:
        if not ready.wait(STARTING):
            raise ResourceError("the emulated buses did not come up")
        yield
    finally:
        ending.set()
        process.join(10.0)
        if process.is_alive():
            process.kill()


def _serve(wiring: Wiring, ready: Event, ending: Event) -> None:
    start = wiring.shaft(sitting_joints(wiring.robot))
    servos = TwinServos(wiring, lambda servos: FirstOrderJoints(servos, start=start, most_steps=2))
    with TwinTerminals(servos):
        ready.set()
        ending.wait()
