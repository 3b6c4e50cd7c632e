"""Leads the servos by what they are known to lack: sag under load and lag in motion.

An MX servo is a spring: it holds a torque only with a position error of torque / stiffness, and follows a moving
target late by its back-EMF damping over stiffness. Both are added to the target, so that feet are where they belong.
"""

from robot_agent.kinematics.compiled import kernel
from robot_agent.locomotion.walk_state import Record


@kernel
def lead_servos(walk: Record) -> None:
    """Set each servo's target from its wanted angle, the rate of that and the expected load on the foot."""
    model, senses, joint, up = walk.model, walk.senses, walk.joint, walk.senses.up
    for leg in range(model.legs):
        jacobian, load = senses.jacobian[leg], walk.load.load[leg]
        for i in range(model.joints):
            lever = jacobian[0, i] * up[0] + jacobian[1, i] * up[1] + jacobian[2, i] * up[2]
            torque = senses.own_torque[leg, i] - lever * load
            rate = (joint.wanted[leg, i] - joint.previous[leg, i]) / model.dt
            value = joint.wanted[leg, i] + torque / model.servo_stiffness[i] + model.servo_lag[i] * rate
            joint.target[leg * model.joints + i] = min(max(value, model.limits[i, 0]), model.limits[i, 1])
