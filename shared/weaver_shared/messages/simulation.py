"""What a simulated robot hands to its renderer."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weaver_shared.transforms import Pose

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneState:
    """Everything that moves in a picture, at the instant of its exposure. Read by the renderer alone."""

    stamp_ns: int
    position_in_world: Array  # (3,) m
    wxyz: Array  # (4,) world_from_body
    joint_position: Array  # (joints,) rad, unquantised

    @property
    def world_from_body(self) -> Pose:
        return Pose.of(self.position_in_world, self.wxyz)
