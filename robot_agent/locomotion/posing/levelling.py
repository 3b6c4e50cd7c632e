"""Levelling by the IMU: a PID on the body's tilt whose answer turns the body over its feet (OpenSHC'20 IV-B)."""

from math import atan2, sqrt

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.walk_state import Array, Record
from weaver_shared.config.locomotion import LevellingConfig


def tune_levelling(posing: Record, config: LevellingConfig, dt: float) -> None:
    """Write gains and limits into the memory of the posing."""
    posing["gains"] = config.proportional, config.integral, config.derivative
    posing["largest"] = config.largest
    posing["rate_blend"] = dt / (config.rate_time + dt)


@kernel
def clear_levelling(posing: Record) -> None:
    posing.measured = False
    for k in range(2):
        posing.integral[k] = posing.tilt_rate[k] = posing.turn[k] = 0.0


@kernel
def hold_levelling(posing: Record) -> None:
    """Keep the answer while the tilt is unknown; the next one known says nothing of its rate."""
    posing.measured = False


@kernel
def step_levelling(posing: Record, error: Array, dt: float) -> None:
    """Set `turn` (2,) rad about x and y for a tilt `error` (2,) rad still to be undone.

    The integral stops where the answer is at its limit and would be pushed further.
    """
    proportional, integral, derivative = posing.gains
    for k in range(2):
        if posing.measured:
            rate = (error[k] - posing.tilt[k]) / dt
            posing.tilt_rate[k] += posing.rate_blend * (rate - posing.tilt_rate[k])
        posing.tilt[k] = error[k]
        free = proportional * error[k] + posing.integral[k] + derivative * posing.tilt_rate[k]
        grown = posing.integral[k] + integral * error[k] * dt
        if abs(free) < posing.largest or abs(grown) <= abs(posing.integral[k]):
            posing.integral[k] = min(max(grown, -posing.largest), posing.largest)
        posing.turn[k] = min(max(free, -posing.largest), posing.largest)
    posing.measured = True


@kernel
def tilt_error(up: Array, error: Array) -> None:
    """Fill `error` (2,) with the turn, rad about x and y, that brings z onto `up` (3,), as the wanted body feels it."""
    sine = sqrt(up[0] * up[0] + up[1] * up[1])
    scale = atan2(sine, up[2]) / sine if sine > 1e-12 else 0.0
    error[0], error[1] = -up[1] * scale, up[0] * scale
