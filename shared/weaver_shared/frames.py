"""Names and conventions every package shares.

Frames follow REP-103: x forward, y left, z up. `world` is gravity aligned; its origin lies on the ground under the
body at start and its x axis is the initial heading. `body` has its origin at the centre of the hip plane. A camera's
optical frame is x right, y down, z forward. A pose `world_from_body` maps coordinates in body to coordinates in world.
"""

from typing import Final

GRAVITY: Final = 9.80665
"""Standard gravity, m/s^2. Gravity points along -z of world."""

WORLD: Final = "world"
BODY: Final = "body"
