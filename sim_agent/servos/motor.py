"""DC servos with the firmware's proportional law, all of a robot at once.

The model and its parameters follow the identification of MX servos by Rhoban (bam): duty = 0.158 P * error, at most
0.9625 of the supply; torque = k_t I with I = (duty V - k_t w) / R; friction has a Coulomb and a viscous part.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

DUTY_PER_GAIN = 0.158  # 1/rad and unit of P (bam)
MAX_DUTY = 0.9625  # (bam)
TICKS_PER_TURN = 4096
RAD_PER_TICK = 2.0 * np.pi / TICKS_PER_TURN
BRISTLE_STIFFNESS = 60.0  # N m/rad, gear wind-up before friction lets go (chosen: 2 mrad)

# Columns of the parameter table, one row per joint.
TORQUE_CONSTANT, RESISTANCE, SUPPLY, GAIN, STALL, COULOMB, VISCOUS = range(7)


@njit(cache=True)
def servo_torque(
    goal: Array,
    position: Array,
    velocity: Array,
    torque_limit: Array,
    torque_on: bool,
    parameters: Array,
    bristle: Array,
    dt: float,
    torque: Array,
    current: Array,
    power: Array,
) -> None:
    """One step of n servos. Reads goal and position (rad), velocity (rad/s), torque_limit (N m).

    `bristle` (n,) is the state of the friction: how far the gears are wound up (rad). Writes torque on the joint
    (N m), current (A) and electrical power drawn from the rail (W, never negative: nothing is recuperated).
    """
    for i in range(goal.shape[0]):
        p = parameters[i]
        w = velocity[i]
        if torque_on:
            error = (round(goal[i] / RAD_PER_TICK) - round(position[i] / RAD_PER_TICK)) * RAD_PER_TICK
            duty = min(max(p[GAIN] * DUTY_PER_GAIN * error, -MAX_DUTY), MAX_DUTY)
            amperes = (duty * p[SUPPLY] - p[TORQUE_CONSTANT] * w) / p[RESISTANCE]
            limit = max(min(torque_limit[i], p[STALL]), 0.0) / p[TORQUE_CONSTANT]
            amperes = min(max(amperes, -limit), limit)
            volts = amperes * p[RESISTANCE] + p[TORQUE_CONSTANT] * w
            current[i] = amperes
            power[i] = max(amperes * volts, 0.0)
        else:
            current[i] = 0.0
            power[i] = 0.0
        # Dahl friction: sticks like a spring, slides at the Coulomb torque. A function of speed alone would creep.
        slip = abs(w) * dt * BRISTLE_STIFFNESS / p[COULOMB] if p[COULOMB] > 0.0 else 0.0
        bristle[i] = (bristle[i] + w * dt) / (1.0 + slip) if p[COULOMB] > 0.0 else 0.0
        friction = BRISTLE_STIFFNESS * bristle[i] + p[VISCOUS] * w
        torque[i] = p[TORQUE_CONSTANT] * current[i] - friction
