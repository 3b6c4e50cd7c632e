"""Where each foot belongs: it stands and is left behind by the body, or swings, reaches for the ground and lands.

A standing foot keeps the height it found. A swinging foot that touches early stops there; one that is late goes on
down, up to a limit, and then looks for ground beside, while the gait waits. All places are in the body as it would be
without posing.
"""

import numpy as np

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.ground_search import DOWN, begin_search, seek
from robot_agent.locomotion.reasons import FOOTHOLD
from robot_agent.locomotion.stride import foot_velocity, stride_of, swing_nodes, swing_point
from robot_agent.locomotion.trip import CLEAR, STRUCK, lead_around, notice_trip
from robot_agent.locomotion.walk_state import Array, Record
from robot_agent.locomotion.walkspace import radius_towards

STAND, SWING, REACH, HANG, HELD = 0, 1, 2, 3, 4
"""HANG: reached as far as it may, and found no ground beside either; carries nothing until its next swing.
HELD: in the operator's hands."""
FOOTHOLD_SPEED = 0.25
"""m/s, at which a foothold moves in the body while its foot is on the way there."""


@kernel
def stand_at(walk: Record, places: Array) -> None:
    """Put every foot down at `places` (legs, 3)."""
    feet = walk.feet
    for leg in range(walk.model.legs):
        feet.mode[leg] = STAND
        feet.lifted[leg] = False
        feet.place[leg, :] = places[leg]
        feet.anchor[leg, :] = places[leg]


@kernel
def carry_feet(walk: Record) -> None:
    """Leave the feet on the ground behind as the body moves, and with them the places that belong to the ground."""
    feet, body, dt = walk.feet, walk.body, walk.model.dt
    legs = walk.model.legs
    for leg in range(legs):
        if feet.mode[leg] == STAND or feet.mode[leg] == HANG:
            carry(feet.place[leg : leg + 1], body.whole_linear, body.whole_angular, dt)
    carry(feet.anchor[:legs], body.whole_linear, body.whole_angular, dt)
    carry(feet.lift_off[:legs], body.linear, body.angular, dt)


@kernel
def carry(points: Array, linear: Array, angular: Array, dt: float) -> None:
    """Move `points` (n, 3), fixed to the ground, as a body sees them that moves with a twist (m/s, rad/s in body).

    The turn is applied exactly, so long walks do not stretch the stance.
    """
    angle = np.sqrt(angular[0] ** 2 + angular[1] ** 2 + angular[2] ** 2) * dt
    sine, versine = 1.0, 0.5
    if angle > 1e-9:
        sine, versine = np.sin(angle) / angle, (1.0 - np.cos(angle)) / (angle * angle)
    wx, wy, wz = -angular[0] * dt, -angular[1] * dt, -angular[2] * dt
    for i in range(points.shape[0]):
        x, y, z = points[i, 0] - linear[0] * dt, points[i, 1] - linear[1] * dt, points[i, 2] - linear[2] * dt
        cx, cy, cz = wy * z - wz * y, wz * x - wx * z, wx * y - wy * x
        points[i, 0] = x + sine * cx + versine * (wy * cz - wz * cy)
        points[i, 1] = y + sine * cy + versine * (wz * cx - wx * cz)
        points[i, 2] = z + sine * cz + versine * (wx * cy - wy * cx)


@kernel
def count_mode(walk: Record, wanted: int) -> int:
    """How many feet are in a mode."""
    count = 0
    for leg in range(walk.model.legs):
        count += walk.feet.mode[leg] == wanted
    return count


@kernel
def until_next_lift(walk: Record) -> float:
    """Fraction of a stride until the next foot is due to lift off."""
    feet, gait = walk.feet, walk.gait
    least = 1.0
    for leg in range(walk.model.legs):
        due = not feet.lifted[leg] and (feet.mode[leg] == STAND or feet.mode[leg] == HANG)
        if due or gait.leg_phase[leg] >= 1.0 - gait.duty:
            least = min(least, 1.0 - gait.leg_phase[leg])
    return least


@kernel
def take_anchors(walk: Record) -> None:
    """Standing feet are where they are measured to be; without a sense of ground, where they are wanted."""
    feet, senses, feel_ground = walk.feet, walk.senses, walk.settings.feel_ground
    for leg in range(walk.model.legs):
        if feet.mode[leg] == STAND and (senses.contact[leg] or not feel_ground):
            for k in range(3):
                feet.anchor[leg, k] = senses.unposed_feet[leg, k] if feel_ground else feet.place[leg, k]


@kernel
def lift(walk: Record, leg: int) -> None:
    """Begin a swing where the foot really is: the impedance's offset goes into the path, and is cleared."""
    feet, offset, up = walk.feet, walk.load.offset, walk.senses.unposed_up
    for k in range(3):
        feet.place[leg, k] += offset[leg, 0] * up[k]
        feet.lift_off[leg, k] = feet.place[leg, k]
    offset[leg, 0], offset[leg, 1] = 0.0, 0.0
    feet.mode[leg] = SWING
    feet.swing_height[leg] = min(walk.gait.height, walk.model.headroom[leg])
    feet.planned[leg] = False
    feet.aimed[leg] = walk.orders.targeted[leg]
    feet.lifted[leg] = True
    feet.reached[leg], feet.seeking[leg], feet.tried[leg] = 0.0, DOWN, 0
    feet.tripped[leg] = CLEAR
    feet.detour[leg, :] = 0.0


@kernel
def move_swinging(walk: Record) -> None:
    """Move every foot in the air by one tick.

    The body moves with the gait's pace; paths are planned for full pace, since the gait slows with the body.
    """
    feet, gait, senses = walk.feet, walk.gait, walk.senses
    earliest, feel_ground = walk.settings.foothold.earliest_contact, walk.settings.feel_ground
    for leg in range(walk.model.legs):
        if feet.mode[leg] != SWING and feet.mode[leg] != REACH:
            continue
        progress = gait.leg_phase[leg] / (1.0 - gait.duty)
        touches = feel_ground and senses.contact[leg]
        if feet.mode[leg] == SWING and feel_ground:
            notice_trip(walk, leg, progress)
        if feet.mode[leg] == SWING and touches and earliest < progress and feet.tripped[leg] != STRUCK:
            feet.mode[leg] = STAND
        elif feet.mode[leg] == SWING and (progress < 1.0 or not feel_ground):
            _swing(walk, leg, progress)
        elif feet.mode[leg] == REACH and feet.seeking[leg] != DOWN:
            seek(walk, leg)
        elif touches:
            feet.mode[leg] = STAND
        else:
            _reach(walk, leg)


@kernel
def _swing(walk: Record, leg: int, progress: float) -> None:
    """Along the swing curves towards the foothold; without a sense of ground the foot lands when the swing ends."""
    feet, gait, model, plane = walk.feet, walk.gait, walk.model, walk.body.plane
    foothold, ground, stride, up = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    foot_velocity(gait.commanded, feet.stance[leg], ground)
    stride_of(gait.commanded, feet.stance[leg], gait.duty, gait.frequency, stride)
    for k in range(2):
        foothold[k] = feet.stance[leg, k] + 0.5 * stride[k]
    z = plane[0] * foothold[0] + plane[1] * foothold[1] + plane[2]
    foothold[2] = min(max(z, model.down_limit), model.up_limit)
    if feet.aimed[leg]:
        aim(walk, leg, foothold)
    else:
        draw_foothold(walk, leg, foothold)
    half_time = 0.5 * (1.0 - gait.duty) / gait.frequency
    if progress >= 1.0:
        for k in range(3):
            feet.place[leg, k] = foothold[k] + ground[k] * (progress - 1.0) * 2.0 * half_time
        feet.mode[leg] = STAND
        return
    first, second, outward = np.empty((5, 3)), np.empty((5, 3)), np.zeros(3)
    direction_of_swing(walk, up)
    outward[1] = walk.settings.foothold.swing_width * (1.0 if feet.stance[leg, 1] > 0.0 else -1.0)
    speed = walk.settings.foothold.touchdown_speed if walk.settings.feel_ground else 0.0
    swing_nodes(
        feet.lift_off[leg], foothold, up, feet.swing_height[leg], ground, speed, half_time,
        walk.settings.foothold.along_normal != 0, outward, first, second,
    )  # fmt: skip
    path = np.empty(3)
    swing_point(progress, first, second, path)
    if feet.tripped[leg]:
        lead_around(walk, leg, path, foothold)
    else:
        feet.place[leg, :] = path


@kernel
def draw_foothold(walk: Record, leg: int, foothold: Array) -> None:
    """Let a swing's foothold (3,) follow its plan at a bounded speed: a foot about to land is not snatched away."""
    feet, away, share = walk.feet, 0.0, 1.0
    if feet.planned[leg]:
        for k in range(3):
            away += (foothold[k] - feet.foothold[leg, k]) ** 2
        away, largest = np.sqrt(away), FOOTHOLD_SPEED * walk.model.dt
        if away > largest:
            share = largest / away
        for k in range(3):
            foothold[k] = feet.foothold[leg, k] + share * (foothold[k] - feet.foothold[leg, k])
    feet.planned[leg] = True
    feet.foothold[leg, :] = foothold


@kernel
def aim(walk: Record, leg: int, foothold: Array) -> None:
    """The place that was ordered, or the nearest to it that the leg can walk on."""
    target, stance, model = walk.orders.target[leg], walk.feet.stance[leg], walk.model
    x, y = target[0] - stance[0], target[1] - stance[1]
    far, share = np.sqrt(x * x + y * y), 1.0
    room = max(radius_towards(model.radius[leg], x, y) - walk.space.moved[leg], 0.0)
    if far > room:
        share = room / far
        walk.answer.reasons |= FOOTHOLD
    foothold[0], foothold[1] = stance[0] + share * x, stance[1] + share * y
    foothold[2] = min(max(target[2], model.down_limit), model.up_limit)


@kernel
def direction_of_swing(walk: Record, up: Array) -> None:
    """Fill `up` (3,) with the direction in which feet are lifted and put down: against gravity, or off the ground."""
    up[:] = walk.senses.unposed_up
    if walk.settings.foothold.along_normal:
        plane = walk.body.plane
        length = np.sqrt(plane[0] ** 2 + plane[1] ** 2 + 1.0)
        up[0], up[1], up[2] = -plane[0] / length, -plane[1] / length, 1.0 / length


@kernel
def _reach(walk: Record, leg: int) -> None:
    """On down, below the expected ground."""
    feet, gait, settings, dt = walk.feet, walk.gait, walk.settings.foothold, walk.model.dt
    up, ground = np.empty(3), np.empty(3)
    direction_of_swing(walk, up)
    foot_velocity(gait.commanded, feet.stance[leg], ground)
    feet.mode[leg] = REACH
    for k in range(3):
        feet.place[leg, k] += (gait.pace * ground[k] - settings.touchdown_speed * up[k]) * dt
    feet.reached[leg] += settings.touchdown_speed * dt
    too_deep = feet.reached[leg] > settings.reach_down or feet.place[leg, 2] < walk.model.down_limit
    if too_deep and not begin_search(walk, leg):
        feet.mode[leg] = HANG
