"""What the operator wants of the robot at this moment; written by the command desk, read by the walk pipeline."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.footholds import FootholdOrder
from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from robot_agent.locomotion.posture_order import NO_POSTURE_ORDER, PostureOrder
from robot_agent.navigation.keep_out import Area
from weaver_shared.messages import Waypoint


@dataclass(frozen=True, slots=True, kw_only=True)
class Orders:
    stop_level: str  # "", "settle", "cut"
    stand: bool
    operator_silence: float  # s since the holder of the lease was last heard; infinite when nobody holds it
    attended: bool  # some operator has been in control since the start
    gait: str
    mission_active: bool
    waypoints: tuple[Waypoint, ...]
    mission_serial: int  # rises when the follower must begin anew
    teleop_velocity: NDArray[np.float64] | None  # (3,) m/s and rad/s; None: nobody steers
    posing: PosingOrder = NO_POSING
    legs: tuple[LegOrder, ...] = ()  # in the operator's hands
    footholds: tuple[FootholdOrder, ...] = ()  # where the next swings of single legs are to end
    in_sequence: bool = False  # stand up and sit down with legs in alternating groups
    pack: bool = False  # fold the legs away when sitting
    posture: PostureOrder = NO_POSTURE_ORDER  # of the legs
    areas: tuple[Area, ...] = ()  # forbidden ground, to be walked around
    find_way: bool = False  # the waypoints are goals to which the robot finds its own way


def idle_orders(gait: str = "tripod") -> Orders:
    """Nobody wants anything: sit with torque off."""
    return Orders(
        stop_level="",
        stand=False,
        operator_silence=float("inf"),
        attended=False,
        gait=gait,
        mission_active=False,
        waypoints=(),
        mission_serial=0,
        teleop_velocity=None,
    )
