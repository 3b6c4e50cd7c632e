"""What is told to OpenSHC and when: lines of `TICK COMMAND VALUES`, taken before that tick."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from robot_agent.locomotion.openshc.controller import Controller
from robot_agent.locomotion.openshc.posing import PoseReset
from robot_agent.locomotion.openshc.steps import MANUAL, PACKED, READY, RUNNING, WALKING
from weaver_shared.errors import InputError
from weaver_shared.transforms import rotation_from_rpy

STATES = {"packed": PACKED, "ready": READY, "running": RUNNING}
RESETS = {reset.name.lower(): reset for reset in PoseReset}
SIDES = {"manual": MANUAL, "walking": WALKING}


@dataclass(frozen=True, slots=True, kw_only=True)
class Event:
    """Told before `tick`."""

    tick: int
    command: str
    values: tuple[str, ...]

    def tell(self, controller: Controller) -> None:
        """Raises InputError that says what the command takes."""
        told, count, _ = COMMANDS[self.command]
        if count is not None and len(self.values) != count:
            raise InputError(f"{self}: {len(self.values)} values were found; valid is {COMMANDS[self.command][2]}")
        told(controller, self)

    def numbers(self, values: Sequence[str] | None = None) -> list[float]:
        texts = self.values if values is None else values
        try:
            numbers = [float(text) for text in texts]
        except ValueError as error:
            raise InputError(f"{self}: valid is {COMMANDS[self.command][2]}") from error
        if not np.isfinite(numbers).all():
            raise InputError(f"{self}: numbers have to be finite")
        return numbers

    def choice(self, known: Iterable[str], text: str) -> str:
        if text not in known:
            raise InputError(f"{self}: {text!r} is unknown; known are {', '.join(known)}")
        return text

    def __str__(self) -> str:
        return f"{self.tick} {self.command} {' '.join(self.values)}".rstrip()


def events_of(text: str) -> list[Event]:
    """Of a script's lines; what follows a # is a remark."""
    events = []
    for number, line in enumerate(text.splitlines(), start=1):
        words = line.partition("#")[0].split()
        if not words:
            continue
        if not words[0].isdecimal() or len(words) < 2:
            raise InputError(f"line {number}: {line.strip()!r} is not valid; use TICK COMMAND VALUES")
        if words[1] not in COMMANDS:
            raise InputError(f"line {number}: {words[1]!r} is unknown; known are {', '.join(COMMANDS)}")
        events.append(Event(tick=int(words[0]), command=words[1], values=tuple(words[2:])))
    return sorted(events, key=lambda event: event.tick)


def _state(controller: Controller, event: Event) -> None:
    controller.asked_state = STATES[event.choice(STATES, event.values[0])]


def _velocity(controller: Controller, event: Event) -> None:
    x, y, turn = event.numbers()
    controller.command(np.array([x, y]), turn)


def _pose(controller: Controller, event: Event) -> None:
    controller.posing.input = np.array(event.numbers())


def _reset(controller: Controller, event: Event) -> None:
    controller.posing.reset = RESETS[event.choice(RESETS, event.values[0])]


def _imu(controller: Controller, event: Event) -> None:
    roll, pitch, yaw, *rate = event.numbers()
    controller.posing.imu_rotation, controller.posing.imu_rate = rotation_from_rpy(roll, pitch, yaw), np.array(rate)


def _force(controller: Controller, event: Event) -> None:
    legs = controller.description.leg_id
    name = event.choice((*legs, "all"), event.values[0])
    forces = controller.tip_forces.copy()
    forces[slice(None) if name == "all" else legs.index(name)] = event.numbers(event.values[1:])
    controller.feel(forces)


def _gait(controller: Controller, event: Event) -> None:
    controller.asked_gait = event.choice(controller.description.gaits, event.values[0])


def _adjust(controller: Controller, event: Event) -> None:
    name, change = event.values[0], event.numbers(event.values[1:])[0]
    controller.asked_parameters[name] = controller.settings.adjusted(name, change)


def _leg(controller: Controller, event: Event) -> None:
    leg = controller.description.leg_id.index(event.choice(controller.description.leg_id, event.values[0]))
    if controller.manipulation.states[leg] != SIDES[event.choice(SIDES, event.values[1])]:
        controller.manipulation.toggled = leg


def _tip(controller: Controller, event: Event) -> None:
    leg = controller.description.leg_id.index(event.choice(controller.description.leg_id, event.values[0]))
    controller.manipulation.tip_velocity[leg] = np.array(event.numbers(event.values[1:]))


COMMANDS: dict[str, tuple[Callable[[Controller, Event], None], int | None, str]] = {
    "state": (_state, 1, f"one of {', '.join(STATES)}"),
    "velocity": (_velocity, 3, "vx vy wz, fractions of the largest or m/s and rad/s by velocity_input_mode"),
    "pose": (_pose, 6, "x y z roll pitch yaw, rates as fractions of the largest"),
    "reset": (_reset, 1, f"one of {', '.join(RESETS)}"),
    "imu": (_imu, 6, "roll pitch yaw in rad and the angular rate in rad/s, x y z"),
    "force": (_force, 4, "a leg or all, and the force at its foot in N, x y z"),
    "gait": (_gait, 1, "a gait's name"),
    "adjust": (_adjust, 2, "a parameter's name and its change"),
    "leg": (_leg, 2, "a leg and one of manual, walking"),
    "tip": (_tip, 4, "a leg and its foot's rate, x y z, as fractions of the largest"),
}
"""What each does, how many values it takes, and what they are."""
