"""What the walker is given and what it answers, once a control tick."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from weaver_shared.messages import GaitParameters
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkInput:
    """Joint and leg order as in the robot description."""

    stamp_ns: int
    velocity: Array  # (3,) vx, vy m/s and turn rad/s wanted of the body, in body
    parameters: GaitParameters
    gait: str
    stand: bool  # False: sit
    joint_position: Array  # (joints,) rad, measured
    joint_torque: Array  # (joints,) N m, measured
    foot_contact: NDArray[np.bool_]  # (legs,)
    gravity_in_body: Array  # (3,) unit vector, downwards
    posing: PosingOrder = NO_POSING
    legs: tuple[LegOrder, ...] = ()  # to be held off the ground
    in_sequence: bool = False  # stand up and sit down with legs in alternating groups; False: all at once
    pack: bool = False  # fold the legs away when sitting


@dataclass(frozen=True, slots=True, kw_only=True)
class WalkOutput:
    """`posture` is one of sitting, rising, standing, walking, lowering."""

    joint_position: Array  # (joints,) rad, for the servos
    foot_in_body: Array  # (legs, 3) m, wanted foot centres
    foot_force: Array  # (legs,) N, vertical, from the joint torques
    phase: Array  # (legs,) 0..1 of the stride, 0 at lift-off
    swing: NDArray[np.bool_]  # (legs,) True while a foot is in the air
    velocity: Array  # (3,) really walked after all limits
    stability_margin: float  # m, static
    energy_margin: float  # m, height to tip over
    stability: str  # what the margins allow: good, warn, slow, refuse
    ground_plane: Array  # (3,) a, b, c of z = a x + b y + c through the feet, in the un-posed body
    ground_residual: float  # m rms of the feet about it
    unposed_from_body: Pose  # how the body is posed
    slipping: NDArray[np.bool_]  # (legs,)
    events: tuple[str, ...]  # slips and stumbles of this tick
    leg_stages: tuple[str, ...]  # supporting, lifting, held or lowering
    lift_margins: tuple[float, ...]  # m of static margin without each leg; empty while the robot does not stand
    posture: str
    reasons: tuple[str, ...]  # what limits the walking just now
