"""A pose that moves with the gait: the body leans and shifts away from the feet in the air, and rises over them.

OpenSHC's automatic pose gives each gait phases and amplitudes; here each leg adds one bump during its own swing, in the
direction its foot stands in, so that the same few amplitudes serve any gait and number of legs. The bump
64 s^3 (1 - s)^3 begins and ends without speed or acceleration; it may begin before the foot lifts, so that the body
already leans when it does, and end as long after the landing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics.compiled import kernel
from weaver_shared.config.locomotion import AutomaticPose

Array = NDArray[np.float64]

SAMPLES = 600


def bump(progress: Array) -> Array:
    """Height 0..1 over the progress 0..1 of a swing; zero outside."""
    s = np.clip(progress, 0.0, 1.0)
    result: Array = 64.0 * (s * (1.0 - s)) ** 3
    return result


def leg_amplitudes(stance_in_body: Array, amplitudes: AutomaticPose) -> Array:
    """What each leg's swing adds at its height to x, y, z, roll, pitch, yaw, (legs, 6) m and rad.

    `amplitudes` are those of all legs on one side swinging together, which is why they are shared among the legs.
    """
    away = stance_in_body[:, :2] - stance_in_body[:, :2].mean(axis=0)
    size = np.linalg.norm(away, axis=1)
    forward, left = (away / np.where(size > 1e-9, size, 1.0)[:, None]).T
    share = 2.0 / len(stance_in_body)
    result = np.zeros((len(stance_in_body), 6))
    result[:, 0], result[:, 1] = -amplitudes.shift * forward, -amplitudes.shift * left
    result[:, 2] = amplitudes.lift
    result[:, 3], result[:, 4] = amplitudes.roll * left, -amplitudes.pitch * forward
    return result * share


def steepest_slope(offset: Array, swing: float, ahead: float, amplitude: Array) -> Array:
    """Largest change, (6,) per stride, of the sum over legs whose phases lie `offset` (legs,) apart."""
    phases = np.linspace(0.0, 1.0, SAMPLES + 1)
    path = bump((phases[:, None] + offset + ahead) % 1.0 / (swing + 2.0 * ahead)) @ amplitude
    result: Array = np.abs(np.diff(path, axis=0)).max(axis=0) * SAMPLES
    return result


@kernel
def sway(
    leg_phase: Array, swing: float, ahead: float, amplitude: Array, slope: Array, rates: Array, frequency: float,
    values: Array,
) -> None:  # fmt: skip
    """Fill `values` (6,) with the sum over the legs, made smaller where a fast gait would exceed `rates` (6,) per s.

    `leg_phase` (legs,) is 0 at lift-off; `swing` the fraction of a stride in the air, `ahead` that of which the bumps
    are longer on either side; `amplitude` (legs, 6); `slope` (6,) that of `steepest_slope`; `frequency` Hz.
    """
    values[:] = 0.0
    for leg in range(leg_phase.size):
        s = (leg_phase[leg] + ahead) % 1.0 / (swing + 2.0 * ahead)
        if s < 1.0:
            height = 64.0 * (s * (1.0 - s)) ** 3
            for k in range(6):
                values[k] += height * amplitude[leg, k]
    for k in range(6):
        values[k] *= min(1.0, rates[k] / max(slope[k] * frequency, 1e-12))
