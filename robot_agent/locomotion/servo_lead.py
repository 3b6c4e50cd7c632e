"""Leads the servos by what they are known to lack: sag under load and lag in motion.

An MX servo is a spring: it holds a torque only with a position error of torque / stiffness, and follows a moving
target late by its back-EMF damping over stiffness. Both are added to the target, so that feet are where they belong.
"""

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.walk_state import Record


@kernel
def target_servos(walk: Record, lead: bool) -> None:
    """Set each servo's target: the wanted angle, led where asked, no faster than the servo turns without load.

    The lead comes and goes with load and rate, which may change in a tick; the target then takes a few ticks.
    """
    model, joint, n = walk.model, walk.joint, walk.model.joints
    lead = lead and walk.settings.compensate_servos != 0
    for leg in range(model.legs):
        for i in range(n):
            value = joint.wanted[leg, i]
            if lead:
                value = min(max(value + servo_lead(walk, leg, i), model.limits[i, 0]), model.limits[i, 1])
            last, step = joint.target[leg * n + i], model.target_step[i]
            joint.target[leg * n + i] = min(max(value, last - step), last + step)


@kernel
def servo_lead(walk: Record, leg: int, i: int) -> float:
    """Radians that a servo's target goes ahead of its wanted angle: torque over stiffness, and lag times rate."""
    model, senses, joint, up = walk.model, walk.senses, walk.joint, walk.senses.up
    jacobian = senses.jacobian[leg]
    lever = jacobian[0, i] * up[0] + jacobian[1, i] * up[1] + jacobian[2, i] * up[2]
    torque = senses.own_torque[leg, i] - lever * walk.load.load[leg]
    rate = (joint.wanted[leg, i] - joint.previous[leg, i]) / model.dt
    lead: float = torque / model.servo_stiffness[i] + model.servo_lag[i] * rate
    return lead
