"""The two things a robot is made of, whether simulated, emulated or real."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from weaver_shared.messages import Proprioception, SafetyAction, StereoFrame
from weaver_shared.robots import RobotDescription


@dataclass(frozen=True, slots=True, kw_only=True)
class JointTargets:
    """One tick's order to the servos; joint order is `RobotDescription.joint_names`."""

    stamp_ns: int
    position: NDArray[np.float64]  # (joints,) rad
    torque_limit: NDArray[np.float64]  # (joints,) N m, caps the servo's current
    torque_on: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Trouble:
    """Something that a body knows to be wrong with itself, and what it asks of safety; ALLOW: only said."""

    text: str
    action: SafetyAction


class Body(Protocol):
    """Servos, IMU and power of one robot, one control tick at a time."""

    robot: RobotDescription
    kind: str  # "SIM", "EMULATED BUS" or "REAL"

    def wait_next(self) -> int:
        """Return at the next control tick with its stamp in ns; a simulated body advances its physics."""
        ...

    def read(self) -> Proprioception:
        """This tick's readings; a part that did not answer is marked, never invented, and nothing is raised."""
        ...

    def write(self, targets: JointTargets) -> None: ...

    def findings(self) -> Sequence[Trouble]:
        """What is wrong with it now."""
        ...

    def joint_faults(self) -> Sequence[str]:
        """What is wrong with each joint's servo, empty where it is well; nothing at all if the servos do not tell."""
        ...

    @property
    def holding(self) -> bool:
        """Whether its servos bear it with torque, as those of a robot whose program has died do."""
        ...

    def close(self) -> None: ...


class StereoCamera(Protocol):
    def read(self, timeout: float) -> StereoFrame | None:
        """The newest pair not read yet, or None when none came within `timeout` s."""
        ...

    def close(self) -> None: ...
