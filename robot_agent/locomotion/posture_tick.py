"""What a tick of changing the posture is made of: a foot's joint angles, and standing on all legs but one."""

from robot_agent.kinematics import solve_leg
from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.feet import HELD, STAND
from robot_agent.locomotion.legs_tick import follow_angles, hold_angles
from robot_agent.locomotion.load import share_load
from robot_agent.locomotion.walk_state import Array

SHARE_TIME = 0.25
"""s in which a leg gives off its load to the others, and takes it up again."""


@kernel
def reach_foot(memory: Array, limits: Array, leg: int, foot: Array, direction: Array, angles: Array) -> float:
    """Turn one leg's `angles` (n,) so that its foot is at `foot` (3,) in body; returns the distance left, m.

    `limits` (n, 2) are those of the posture that the leg is in; its last link is wanted along `direction` (3,).
    """
    walk = memory[0]
    n, previous = walk.model.joints, angles.copy()
    left: float = solve_leg(
        walk.model.dh[:n],
        limits,
        walk.model.closed_form,
        walk.model.hips[leg],
        walk.model.hip_axes[leg],
        foot,
        direction,
        previous,
        angles,
    )
    return left


@kernel
def change_tick(memory: Array, angles: Array, relieved: int, in_air: bool, carried: float) -> None:
    """Follow joint `angles` (legs, n), the feet carrying the part `carried` of the weight.

    One leg, `relieved` (-1: none), gives off its load; `in_air` tells that its foot is off the ground.
    """
    walk = memory[0]
    hold_angles(walk)
    legs, n, feet, load = walk.model.legs, walk.model.joints, walk.feet, walk.load
    for leg in range(legs):
        for i in range(n):
            walk.joint.wanted[leg, i] = angles[leg, i]
        lifted = leg == relieved and in_air
        feet.mode[leg], feet.in_air[leg] = HELD if lifted else STAND, lifted
        wanted, most = 0.0 if leg == relieved else 1.0, walk.model.dt / SHARE_TIME
        load.share[leg] += min(max(wanted - load.share[leg], -most), most)
    share_load(
        walk.senses.origins[:legs, n],
        walk.senses.centre_of_mass,
        walk.senses.up,
        load.share[:legs],
        carried * walk.model.weight,
        load.load[:legs],
    )
    follow_angles(walk, True)
