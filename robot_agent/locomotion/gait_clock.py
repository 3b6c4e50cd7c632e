"""The gait's phase as an exact float: frequency and gait may change under way without a jump.

A common phase 0..1 plus one offset a leg. A leg's phase only ever runs forwards, and its offset glides to that of a
newly chosen gait by at most `GLIDE` strides per stride, so a gait change neither repeats nor skips part of a stride.
The glide begins gently, or feet in the air would be jerked by it.
"""

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.walk_state import Record

GLIDE = 0.25
GLIDE_BEGINS = 0.06
"""Strides in which the glide comes to its full speed."""


@kernel
def restart_clock(walk: Record, phase: float) -> None:
    """Begin anew at a common phase, with the ordered gait's offsets."""
    gait, orders = walk.gait, walk.orders
    gait.phase = phase % 1.0
    gait.duty, gait.gliding = orders.duty, 0.0
    for leg in range(walk.model.legs):
        gait.offset[leg] = orders.offset[leg]
        gait.leg_phase[leg] = (gait.phase + gait.offset[leg]) % 1.0


@kernel
def advance_clock(walk: Record, strides: float) -> None:
    """Move on by a number of strides, frequency times dt."""
    gait, orders = walk.gait, walk.orders
    changes = abs(orders.duty - gait.duty)
    for leg in range(walk.model.legs):
        changes = max(changes, abs(offset_gap(walk, leg)))
    gait.gliding = min(gait.gliding + strides / GLIDE_BEGINS, 1.0) if changes > 1e-9 else 0.0
    step = gait.gliding * GLIDE * strides
    gait.phase = (gait.phase + strides) % 1.0
    for leg in range(walk.model.legs):
        gait.offset[leg] = (gait.offset[leg] + min(max(offset_gap(walk, leg), -step), step)) % 1.0
        gait.leg_phase[leg] = (gait.phase + gait.offset[leg]) % 1.0
    gait.duty += min(max(orders.duty - gait.duty, -step), step)


@kernel
def offset_gap(walk: Record, leg: int) -> float:
    """Strides, -0.5 to 0.5, that a leg's offset is behind that of the ordered gait."""
    gap: float = (walk.orders.offset[leg] - walk.gait.offset[leg] + 0.5) % 1.0 - 0.5
    return gap
