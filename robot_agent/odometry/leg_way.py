"""How far the IMU went over its standing feet: what the joints say, turned by the gyro (Bloesch et al., RSS 2012).

A foot that stands has a point that is fixed in the world, so the body's way is that point's, backwards. It is the far
end of its sole: a round foot whose link leans over rolls, and its centre goes on by radius times angle. Feet that slip
do not agree with the others and are left out; while fewer than two agree, the way goes on as before and is known less
well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.compiled import compiled
from robot_agent.odometry.rotations import exponential, orthonormal
from weaver_shared.config.odometry import FeetConfig
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

LONGEST_OVERHANG = 0.03
"""s between the last instant of the feet and the picture's that the same speed may bridge."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """The IMU's displacement over an interval, in its axes at the beginning."""

    displacement: Array  # (3,) m
    variance: float  # m^2 of each component
    turn: Array  # (3, 3) first_from_last, by the gyro
    slipping: bool  # some foot disagreed with the others


def way_of(
    contacts: FootContacts | None,
    samples: Array,
    end_ns: int,
    gyro_bias: Array,
    imu_from_body: Pose,
    config: FeetConfig,
) -> Way | None:
    """The way during `samples` (n, 7), which end at `end_ns`; None where the feet do not cover them."""
    duration = float(samples[:, 0].sum()) if len(samples) else 0.0
    if contacts is None or duration <= 0.0:
        return None
    since: Array = np.asarray(
        duration - (end_ns - contacts.stamp_ns) * 1e-9, dtype=np.float64
    )  # of each instant, s after the interval's beginning
    covered = float(since[-1] - since[0])
    if covered <= 0.0 or abs(since[0]) > LONGEST_OVERHANG or abs(duration - since[-1]) > LONGEST_OVERHANG:
        return None
    feet: Array = contacts.sole_in_body @ imu_from_body.rotation.T + imu_from_body.position
    turns = _turns_at(samples, gyro_bias, np.asarray(np.maximum(since, 0.0), dtype=np.float64))
    displacement, guessed, slips = _displacement(
        feet, contacts.touching, turns, since, config.slip_way, config.slip_speed
    )
    if guessed > config.longest_guess or guessed >= covered - 1e-9:
        return None
    whole = np.array([duration])
    return Way(
        displacement=displacement * (duration / covered),
        variance=config.reading_sigma**2 + config.slip_density**2 * duration + (config.guess_speed * guessed) ** 2,
        turn=_turns_at(samples, gyro_bias, whole)[0],
        slipping=slips > 0,
    )


def guessed_way(velocity_in_imu: Array, samples: Array, gyro_bias: Array, config: FeetConfig) -> Way:
    """On at the same speed through a moment without feet, so that the ways before and after it stay joined."""
    duration = float(samples[:, 0].sum())
    return Way(
        displacement=velocity_in_imu * duration,
        variance=config.reading_sigma**2 + (config.guess_speed * duration) ** 2,
        turn=_turns_at(samples, gyro_bias, np.array([duration]))[0],
        slipping=False,
    )


def joined(first: Way | None, second: Way | None, config: FeetConfig) -> Way | None:
    """One way after the other: what the readings in the middle were wrong by cancels."""
    if first is None or second is None:
        return None
    return Way(
        displacement=first.displacement + first.turn @ second.displacement,
        variance=first.variance + second.variance - config.reading_sigma**2,
        turn=first.turn @ second.turn,
        slipping=first.slipping or second.slipping,
    )


@compiled
def _turns_at(samples: Array, gyro_bias: Array, since: Array) -> Array:
    """Rotation (n, 3, 3) to the beginning's axes from those at the instants `since` (n,) s after it, in order."""
    turns = np.empty((len(since), 3, 3))
    turn = np.eye(3)
    time, n = 0.0, 0
    for i in range(samples.shape[0]):
        dt = samples[i, 0]
        rate = samples[i, 1:4] - gyro_bias
        while n < len(since) and since[n] <= time + dt:
            turns[n] = turn @ exponential(rate * (since[n] - time))
            n += 1
        turn = orthonormal(turn @ exponential(rate * dt))
        time += dt
    while n < len(since):
        turns[n] = turn
        n += 1
    return turns


@compiled
def _displacement(
    feet: Array, standing: NDArray[np.bool_], turns: Array, since: Array, slip_way: float, slip_speed: float
) -> tuple[Array, float, int]:
    """Sum of the mean way over the feet (n, legs, 3) that stand and agree; seconds without two; slips counted."""
    legs = feet.shape[1]
    total, speed = np.zeros(3), np.zeros(3)
    ways = np.empty((legs, 3))
    guessed, slips, seen = 0.0, 0, 0.0
    for i in range(feet.shape[0] - 1):
        dt = since[i + 1] - since[i]
        number = 0
        for leg in range(legs):
            if standing[i, leg] and standing[i + 1, leg]:
                ways[number] = turns[i] @ feet[i, leg] - turns[i + 1] @ feet[i + 1, leg]
                number += 1
        middle = np.zeros(3)
        for a in range(3):
            if number:
                middle[a] = np.median(ways[:number, a])
        way, agreeing = np.zeros(3), 0
        for n in range(number):
            if np.sqrt(np.sum((ways[n] - middle) ** 2)) < slip_way + slip_speed * dt:
                way += ways[n]
                agreeing += 1
        slips += number - agreeing
        if agreeing >= 2:
            way /= agreeing
            total += way
            speed = way / dt
            seen += dt
        else:
            guessed += dt
            total += speed * dt
    if seen > 0.0 and guessed > 0.0 and not standing[0].any():
        total *= (seen + guessed) / seen  # the beginning had no speed to go on with
    return total, guessed, slips
