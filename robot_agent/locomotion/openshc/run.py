"""A run of OpenSHC from a script, tick by tick, as its recordings were made."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from robot_agent.locomotion.openshc.configuration import Configuration
from robot_agent.locomotion.openshc.controller import Controller
from robot_agent.locomotion.openshc.script import Event
from robot_agent.locomotion.openshc.steps import MOVING, RUNNING, STOPPED
from weaver_shared.errors import ConfigurationError

IDLE_TICKS = 5
"""Before a command is given once."""
TICKS_AFTER_STOP = 10
MOST_START_TICKS = 100_000


def run(
    description: Configuration,
    events: Sequence[Event],
    *,
    ticks: int | None,
    from_rest: bool,
) -> Iterator[tuple[int, Controller]]:
    """Tick 0, what was before, and the ticks after it.

    Without `ticks` the run ends ten ticks after the robot has stopped again. `from_rest` begins before the start-up,
    whose states the script then asks for; else the robot is running when tick 0 is shown.
    """
    controller = Controller(description)
    if not from_rest:
        _start(controller)
    waiting, walked, stood = _tell(controller, list(events), 0), False, 0
    yield 0, controller
    tick = 0
    while tick < ticks if ticks is not None else stood <= TICKS_AFTER_STOP:
        tick += 1
        waiting = _tell(controller, waiting, tick)
        controller.tick()
        yield tick, controller
        walked = walked or controller.walk.state == MOVING
        stood += int(walked and not waiting and controller.walk.state == STOPPED)


def _start(controller: Controller) -> None:
    for _ in range(MOST_START_TICKS):
        if controller.robot_state == RUNNING:
            return
        controller.asked_state = RUNNING
        controller.tick()
    raise ConfigurationError(f"{controller.description.syropod_type}: the start-up did not end")


def _tell(controller: Controller, waiting: list[Event], tick: int) -> list[Event]:
    for event in waiting:
        if event.tick <= tick:
            event.tell(controller)
    return [event for event in waiting if event.tick > tick]
