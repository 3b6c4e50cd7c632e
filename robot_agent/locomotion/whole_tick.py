"""The whole tick in one kernel: of a robot on its legs, stable, with nothing in hand; as it is or with a pose."""

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.legs_tick import place_tick, sense_tick, step_tick, walk_tick
from robot_agent.locomotion.posing.pose_tick import pose_body
from robot_agent.locomotion.walk_state import Array, Record

STAND, WALK, UNSTABLE = 0, 1, 2
"""What became of a usual tick; one that is `UNSTABLE` has only taken its readings."""


@kernel
def usual_tick(memory: Array, static_margin: float, energy_margin: float) -> int:
    """From readings to servo targets and answer, if both margins (m) are kept; the body is not posed."""
    sense_tick(memory, True)
    if not keeps(memory, static_margin, energy_margin):
        return UNSTABLE
    walking = walk_tick(memory)
    answer(memory[0])
    return WALK if walking else STAND


@kernel
def keeps(memory: Array, static_margin: float, energy_margin: float) -> bool:
    """Whether the margins are at least these; one that is not a number is not."""
    margins = memory[0].answer
    return bool(margins.static_margin >= static_margin and margins.energy_margin >= energy_margin)


@kernel
def posed_walk_tick(memory: Array, slews: Array) -> bool:
    """`walk_tick` with the body posed, see `pose_tick`."""
    walking = step_tick(memory)
    pose_body(memory[0], slews)
    place_tick(memory)
    return walking


@kernel
def posed_tick(memory: Array, static_margin: float, energy_margin: float, slews: Array) -> int:
    """`usual_tick` with the body posed."""
    sense_tick(memory, True)
    if not keeps(memory, static_margin, energy_margin):
        return UNSTABLE
    walking = posed_walk_tick(memory, slews)
    answer(memory[0])
    return WALK if walking else STAND


@kernel
def answer_tick(memory: Array) -> None:
    """Write the answer of a tick that was made of several kernels."""
    answer(memory[0])


@kernel
def answer(walk: Record) -> None:
    """Copy what others are told, so that it is one piece of memory."""
    told, legs = walk.answer, walk.model.legs
    for k in range(3):
        told.velocity[k] = walk.gait.velocity[k]
        told.plane[k] = walk.body.plane[k]
        told.posing_position[k] = walk.orders.posing_position[k]
        for i in range(3):
            told.posing_rotation[k, i] = walk.orders.posing_rotation[k, i]
    for leg in range(legs):
        told.force[leg] = walk.senses.force[leg]
        told.phase[leg] = walk.gait.leg_phase[leg]
        told.swing[leg] = walk.feet.in_air[leg]
        for k in range(3):
            told.foot[leg, k] = walk.joint.foot[leg, k]
    for i in range(legs * walk.model.joints):
        told.joint_position[i] = walk.joint.target[i]
