"""A swinging foot that strikes something on its way up is led back a little, up along it and over it.

Without this, a foot that meets the face of a step presses against it, counts the touch as ground and stays behind.
"""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.walk_state import Array, Record

CLEAR, STRUCK, FREED = 0, 1, 2
"""Nothing struck in this swing; touching what was struck; clear of it again, on the way back to the path."""
BACK_SPEED = 0.25
"""m/s, at which a foot is drawn back, and comes back to its path."""


@kernel
def notice_trip(walk: Record, leg: int, progress: float) -> None:
    """Follow a swing's touches; `progress` is 0..1 of the swing."""
    feet, settings, touches = walk.feet, walk.settings.foothold, walk.senses.contact[leg] != 0
    if feet.tripped[leg] == STRUCK:
        if not touches or progress >= settings.trip_to:
            feet.tripped[leg] = FREED
    elif touches and settings.trip_from < progress <= settings.earliest_contact:
        feet.tripped[leg] = STRUCK


@kernel
def lead_around(walk: Record, leg: int, path: Array, foothold: Array) -> None:
    """Move a foot that struck something by one tick; `path` (3,) is where its swing would have it, m in body."""
    feet, settings, dt = walk.feet, walk.settings.foothold, walk.model.dt
    place, detour, largest = feet.place[leg], feet.detour[leg], BACK_SPEED * walk.model.dt
    if feet.tripped[leg] == STRUCK:
        x, y = foothold[0] - feet.lift_off[leg, 0], foothold[1] - feet.lift_off[leg, 1]
        length = max(np.sqrt(x * x + y * y), 1e-9)
        away_x = walk.senses.unposed_feet[leg, 0] - settings.trip_retreat * x / length - place[0]
        away_y = walk.senses.unposed_feet[leg, 1] - settings.trip_retreat * y / length - place[1]
        share = min(1.0, largest / max(np.sqrt(away_x * away_x + away_y * away_y), 1e-9))
        detour[0] = place[0] + share * away_x - path[0]
        detour[1] = place[1] + share * away_y - path[1]
        highest = feet.stance[leg, 2] + walk.model.headroom[leg]
        detour[2] = max(min(place[2] + settings.trip_rise * dt, highest), place[2]) - path[2]
    else:
        far = np.sqrt(detour[0] * detour[0] + detour[1] * detour[1])
        left = 1.0 - min(1.0, largest / max(far, 1e-9))
        detour[0], detour[1] = left * detour[0], left * detour[1]
        lower = settings.touchdown_speed * dt
        detour[2] -= min(max(detour[2], -lower), lower)
    for k in range(3):
        place[k] = path[k] + detour[k]
