"""Leads the servos by what they are known to lack: sag under load and lag in motion.

An MX servo is a spring: it holds a torque only with a position error of torque / stiffness, and follows a moving
target late by its back-EMF damping over stiffness. Both are added to the target, so that feet are where they belong.
"""

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import foot_jacobian, link_gravity_torque
from robot_agent.kinematics.compiled import kernel

Array = NDArray[np.float64]


@kernel
def lead_servos(
    wanted: Array,
    rate: Array,
    origins: Array,
    axes: Array,
    link_mass: Array,
    up: Array,
    load: Array,
    stiffness: Array,
    lag: Array,
    limits: Array,
    target: Array,
) -> None:
    """Fill `target` (legs, n) from `wanted` angles, their `rate` rad/s and the expected `load` (legs,) N on each foot.

    `stiffness` (n,) N m/rad and `lag` (n,) s describe the servos; targets stay within `limits` (n, 2).
    """
    legs, n = wanted.shape
    jacobian, own = np.empty((3, n)), np.empty(n)
    for leg in range(legs):
        foot_jacobian(origins[leg], axes[leg], jacobian)
        link_gravity_torque(origins[leg], axes[leg], link_mass, -up, own)
        for i in range(n):
            lever = jacobian[0, i] * up[0] + jacobian[1, i] * up[1] + jacobian[2, i] * up[2]
            torque = own[i] - lever * load[leg]
            value = wanted[leg, i] + torque / stiffness[i] + lag[i] * rate[leg, i]
            target[leg, i] = min(max(value, limits[i, 0]), limits[i, 1])
