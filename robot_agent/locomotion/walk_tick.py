"""What the walker is given and what it answers, once a control tick.

Both are named tuples: they cannot change once made, as everywhere, and are made in half the time that frozen
dataclasses of so many fields need.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.footholds import FootholdOrder
from robot_agent.locomotion.leg_order import LegOrder
from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from robot_agent.locomotion.posture_order import NO_POSTURE_ORDER, PostureOrder
from robot_agent.locomotion.reasons import sentences
from robot_agent.locomotion.walk_state import ANSWER
from weaver_shared.messages import GaitParameters
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
FLOAT, INT, BOOL = np.dtype(np.float64), np.dtype(np.int64), np.dtype(np.bool_)


class WalkInput(NamedTuple):
    """Joint and leg order as in the robot description."""

    stamp_ns: int
    velocity: Array  # (3,) vx, vy m/s and turn rad/s wanted of the body, in body
    parameters: GaitParameters
    gait: str
    stand: bool  # False: sit
    joint_position: Array  # (joints,) rad, measured
    joint_torque: Array  # (joints,) N m, measured
    foot_contact: Flags  # (legs,)
    gravity_in_body: Array  # (3,) unit vector, downwards
    posing: PosingOrder = NO_POSING
    legs: tuple[LegOrder, ...] = ()  # to be held off the ground
    footholds: tuple[FootholdOrder, ...] = ()  # in body, of the next swings of single legs
    in_sequence: bool = False  # stand up and sit down with legs in alternating groups; False: all at once
    pack: bool = False  # fold the legs away when sitting
    posture_order: PostureOrder = NO_POSTURE_ORDER  # of the legs


class WalkOutput(NamedTuple):
    """The numbers are a copy of the walker's `ANSWER`, read when they are asked for; arrays are read-only."""

    answer: bytes
    leg_count: int
    joint_count: int
    posture: str  # sitting, rising, standing, walking, lowering, changing (the posture of the legs)
    stability: str  # what the margins allow: good, warn, slow, refuse
    leg_stages: tuple[str, ...]  # supporting, lifting, held or lowering
    events: tuple[str, ...]  # slips and stumbles of this tick
    further_reasons: tuple[str, ...]
    leg_posture: str = ""  # that the legs are in, or leave; empty for a robot with one only
    change_refusal: str = ""  # why the legs can not go into another posture now; empty when they can

    @property
    def joint_position(self) -> Array:
        """(joints,) rad, for the servos."""
        return np.frombuffer(self.answer, FLOAT, self.joint_count, JOINT_POSITION)

    @property
    def foot_in_body(self) -> Array:
        """(legs, 3) m, wanted foot centres."""
        return self._part("foot", 3 * self.leg_count).reshape(-1, 3)

    @property
    def foot_force(self) -> Array:
        """(legs,) N, vertical, from the joint torques."""
        return self._part("force", self.leg_count)

    @property
    def phase(self) -> Array:
        """(legs,) 0..1 of the stride, 0 at lift-off."""
        return self._part("phase", self.leg_count)

    @property
    def swing(self) -> Flags:
        """(legs,) True while a foot is in the air."""
        return self._part("swing", self.leg_count, BOOL)

    @property
    def velocity(self) -> Array:
        """(3,) vx, vy m/s and turn rad/s really walked after all limits."""
        return self._part("velocity", 3)

    @property
    def stability_margin(self) -> float:
        """m, static."""
        return self._number("static_margin")

    @property
    def energy_margin(self) -> float:
        """m, height to tip over."""
        return self._number("energy_margin")

    @property
    def lift_margins(self) -> tuple[float, ...]:
        """m of static margin without each leg; empty while the robot does not stand."""
        may_lift = self._part("may_lift", 1, INT)[0]
        return tuple(self._part("lift_margin", self.leg_count).tolist()) if may_lift else ()

    @property
    def ground_plane(self) -> Array:
        """(3,) a, b, c of z = a x + b y + c through the feet, in the un-posed body."""
        return self._part("plane", 3)

    @property
    def unposed_from_body(self) -> Pose:
        """How the body is posed."""
        return Pose(
            rotation=self._part("posing_rotation", 9).reshape(3, 3), position=self._part("posing_position", 3)
        )  # fmt: skip

    @property
    def ground_residual(self) -> float:
        """m rms of the feet about the ground plane."""
        return self._number("residual")

    @property
    def slipping(self) -> Flags:
        """(legs,) feet that slide on the ground."""
        return self._part("slipping", self.leg_count, BOOL)

    @property
    def reasons(self) -> tuple[str, ...]:
        """What limits the walking just now."""
        return sentences(int(self._part("reasons", 1, INT)[0])) + self.further_reasons

    def _part(self, field: str, count: int, kind: np.dtype[Any] = FLOAT) -> NDArray[Any]:
        return np.frombuffer(self.answer, kind, count, OFFSETS[field])

    def _number(self, field: str) -> float:
        return float(self._part(field, 1)[0])


OFFSETS = {name: field[1] for name, field in (ANSWER.fields or {}).items()}
"""Of every field of an answer, in bytes."""
JOINT_POSITION = OFFSETS["joint_position"]
