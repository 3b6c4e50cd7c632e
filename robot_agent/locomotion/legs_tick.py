"""What a tick of the walker is made of, each a kernel over its whole memory: sense, walk, follow the feet, hold."""

import numpy as np

from robot_agent.kinematics import limit_joint_speed, solve_leg
from robot_agent.kinematics.compiled import kernel
from robot_agent.kinematics.inverse import ITERATIVE, TOLERANCE
from robot_agent.kinematics.within_speed import is_too_fast, solve_within_speed
from robot_agent.locomotion.body_velocity import clean_velocity
from robot_agent.locomotion.energy_margin import energy_margin
from robot_agent.locomotion.feet import REACH, STAND, SWING
from robot_agent.locomotion.gait_parameters import follow_parameters
from robot_agent.locomotion.reasons import SERVO_SPEED
from robot_agent.locomotion.senses import measure, sense
from robot_agent.locomotion.servo_lead import target_servos
from robot_agent.locomotion.servo_pace import demanded_speed, learn_demand
from robot_agent.locomotion.stability import static_margin
from robot_agent.locomotion.stepper import step
from robot_agent.locomotion.walk_state import Array, Record

LARGEST_LEAN = 0.4
"""Tangent of the last link's lean, beyond which a foot that is far away is not leant after."""


@kernel
def sense_tick(memory: Array, upright: bool) -> None:
    """Take readings and orders, and judge how firmly the robot stands: on all its feet unless it is `upright`."""
    walk = memory[0]
    walk.answer.reasons = 0
    sense(walk)
    clean_velocity(walk)
    follow_parameters(walk)
    legs, n, senses = walk.model.legs, walk.model.joints, walk.senses
    carrying, feet = np.empty(legs, dtype=np.bool_), np.empty((legs, 3))
    for leg in range(legs):
        carrying[leg] = walk.feet.mode[leg] == STAND or not upright
        feet[leg] = senses.origins[leg, n]
    walk.answer.static_margin = static_margin(feet, carrying, senses.centre_of_mass, senses.up)
    walk.answer.energy_margin = energy_margin(feet, carrying, senses.centre_of_mass, senses.up)
    walk.answer.may_lift = upright and not walk.gait.walking
    if walk.answer.may_lift:
        for leg in range(legs):
            carries = carrying[leg]
            carrying[leg] = False
            walk.answer.lift_margin[leg] = static_margin(feet, carrying, senses.centre_of_mass, senses.up)
            carrying[leg] = carries


@kernel
def believe(memory: Array) -> None:
    """Take the joints to be where they are wanted, and every foot to touch the ground."""
    walk = memory[0]
    for leg in range(walk.model.legs):
        for i in range(walk.model.joints):
            angle = walk.joint.wanted[leg, i]
            walk.joint.previous[leg, i] = walk.senses.joint_position[leg, i] = angle
            walk.joint.target[leg * walk.model.joints + i] = angle
        walk.senses.contact_left[leg] = walk.settings.foothold.contact_hold
        walk.senses.contact[leg] = True
    measure(walk)


@kernel
def walk_tick(memory: Array) -> bool:
    """Stand or walk: from the ordered velocity to the servos' targets. Returns whether the robot walks."""
    walking = step_tick(memory)
    place_tick(memory)
    return walking


@kernel
def step_tick(memory: Array) -> bool:
    """The first part of `walk_tick`: where the feet belong in the body as it would be without posing."""
    walk = memory[0]
    hold_angles(walk)
    step(walk)
    mode = walk.feet.mode
    for leg in range(walk.model.legs):
        walk.feet.in_air[leg] = mode[leg] == SWING or mode[leg] == REACH
    return bool(walk.gait.walking)


@kernel
def place_tick(memory: Array) -> None:
    """The second part of `walk_tick`: from there to the servos' targets of the posed body."""
    walk = memory[0]
    place_feet(walk)
    reach_feet(walk)
    follow_angles(walk, True)


@kernel
def foot_tick(memory: Array) -> None:
    """Follow feet that something else than walking has placed."""
    walk = memory[0]
    hold_angles(walk)
    reach_feet(walk)
    follow_angles(walk, True)


@kernel
def joint_tick(memory: Array, angles: Array, lead: bool) -> None:
    """Follow joint `angles` (legs, n), with or without leading the servos."""
    walk = memory[0]
    hold_angles(walk)
    for leg in range(angles.shape[0]):
        for i in range(angles.shape[1]):
            walk.joint.wanted[leg, i] = angles[leg, i]
    follow_angles(walk, lead)


@kernel
def solve_feet(memory: Array, feet: Array) -> None:
    """Set the wanted angles for `feet` (legs, 3) in body at once, whatever the speed that needs."""
    walk = memory[0]
    for leg in range(walk.model.legs):
        walk.joint.foot[leg, :] = feet[leg]
    reach_feet(walk)


@kernel
def hold_tick(memory: Array) -> None:
    """Begin a search for joint angles at those wanted now."""
    hold_angles(memory[0])


@kernel
def hold_angles(walk: Record) -> None:
    """What was wanted becomes what the joints come from."""
    for leg in range(walk.model.legs):
        for i in range(walk.model.joints):
            walk.joint.previous[leg, i] = walk.joint.wanted[leg, i]


@kernel
def place_feet(walk: Record) -> None:
    """Feet in body: where they belong, with the impedance's offset, seen from the posed body."""
    feet, offset, up = walk.feet, walk.load.offset, walk.senses.unposed_up
    turn, shift = walk.orders.posing_rotation, walk.orders.posing_position
    for leg in range(walk.model.legs):
        x = feet.place[leg, 0] + offset[leg, 0] * up[0] - shift[0]
        y = feet.place[leg, 1] + offset[leg, 0] * up[1] - shift[1]
        z = feet.place[leg, 2] + offset[leg, 0] * up[2] - shift[2]
        for k in range(3):
            walk.joint.foot[leg, k] = turn[0, k] * x + turn[1, k] * y + turn[2, k] * z


@kernel
def reach_feet(walk: Record) -> None:
    """Joint angles for the wanted feet; last links along gravity, or nearly, if no joint is too fast then."""
    model, joint = walk.model, walk.joint
    n, direction = model.joints, np.empty(3)
    has_choice = n > 3 and model.closed_form == ITERATIVE
    largest_step = model.speed_limit[:n] * model.dt
    for leg in range(model.legs):
        _aim_last_link(walk, leg, direction)
        joint.distance_left[leg] = solve_leg(
            model.dh[:n],
            model.limits[:n],
            model.closed_form,
            model.hips[leg],
            model.hip_axes[leg],
            joint.foot[leg],
            direction,
            joint.previous[leg, :n],
            joint.wanted[leg, :n],
        )
        if has_choice and is_too_fast(joint.previous[leg, :n], joint.wanted[leg, :n], largest_step):
            solve_within_speed(
                model.dh[:n],
                model.limits[:n],
                model.hips[leg],
                model.hip_axes[leg],
                joint.foot[leg],
                direction,
                TOLERANCE,
                largest_step,
                joint.previous[leg, :n],
                joint.wanted[leg, :n],
            )


@kernel
def _aim_last_link(walk: Record, leg: int, direction: Array) -> None:
    """Fill `direction` (3,): along gravity, leaning after a foot that is away from the middle of its stance.

    So the last joint takes its part in the stride, which the knee alone would be too slow for. All feet lean alike, so
    that what they roll by on the ground moves the whole body, and none of them slips.
    """
    up, foot, stance = walk.senses.up, walk.joint.foot[leg], walk.model.stance[leg]
    away_x, away_y = foot[0] - stance[0], foot[1] - stance[1]
    lean = walk.settings.last_link_lean
    lean = min(lean, LARGEST_LEAN / max(np.sqrt(away_x * away_x + away_y * away_y), 1e-9))
    direction[0] = lean * away_x - up[0]
    direction[1] = lean * away_y - up[1]
    direction[2] = -up[2]


@kernel
def follow_angles(walk: Record, lead: bool) -> None:
    """Keep the speed limits, legs on the ground together, and pass the angles on to the servos."""
    demanded = demanded_speed(walk)
    if walk.gait.walking:
        learn_demand(walk, demanded)
    if demanded >= 1.0 - 1e-9:
        walk.answer.reasons |= SERVO_SPEED
        _shorten(walk)
    target_servos(walk, lead)


@kernel
def _shorten(walk: Record) -> None:
    model, joint, together = walk.model, walk.joint, np.empty(walk.model.legs, dtype=np.bool_)
    for leg in range(model.legs):
        together[leg] = walk.feet.mode[leg] == STAND
    limit_joint_speed(joint.previous, joint.wanted, model.speed_limit[: model.joints], together, model.dt)
