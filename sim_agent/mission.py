"""How every headless run begins: control taken, robot up, mission under way."""

from __future__ import annotations

from collections.abc import Mapping

from robot_agent.loops import CONTROL_RATE
from sim_agent.lock_step import LockStep
from weaver_shared.errors import InputError
from weaver_shared.messages import Answer, CommandName, Waypoint

STAND_SECONDS = 30.0


def begin_mission(
    run: LockStep,
    waypoints: tuple[Waypoint, ...],
    *,
    constant: Mapping[str, float] | None = None,
    gait: str = "tripod",
    find_way: bool = False,
) -> None:
    """Stand up and start walking to `waypoints`, m in the robot's own world.

    `constant` gait parameters by their names are held all the way, as in the paper's non-adaptive set; None: adapted.
    `find_way`: to the last waypoint by a way found over the map. Raises InputError when the robot refuses an order.
    """
    run.step()
    _must(run.operator.send(CommandName.TAKE_CONTROL))
    _must(run.operator.send(CommandName.STAND))
    for name, value in (constant or {}).items():
        _must(run.operator.send(CommandName.SET_OVERRIDE, name=name, value=value))
    _must(run.operator.send(CommandName.SET_GAIT, name=gait))
    _must(run.operator.send(CommandName.SET_MISSION, name="auto" if find_way else "", waypoints=waypoints))
    for _ in range(round(STAND_SECONDS * CONTROL_RATE)):
        if run.step().walk.walk.posture == "standing":
            break
    _must(run.operator.send(CommandName.START_MISSION))


def _must(answer: Answer) -> None:
    if not answer.accepted:
        raise InputError(f"the robot refused: {answer.reason}")
