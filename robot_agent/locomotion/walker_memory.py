"""A walker's memory, written from the robot's description and settings."""

from __future__ import annotations

import numpy as np

from robot_agent.kinematics import LegModel
from robot_agent.locomotion.walk_state import WalkState, write
from robot_agent.locomotion.walkspace import fill_walkspace
from robot_agent.locomotion.workspace import LIMIT_MARGIN, headroom, workspace
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import RobotDescription

GROUND_HEIGHTS = (-0.12, 0.0, 0.12)
"""Above the stance, of the leg's length, at which a stride has to be within reach."""
LOWEST_FOOTHOLD, HIGHEST_FOOTHOLD = 0.265, 0.47
"""Below and above the stance, of the leg's length."""
SPARE = 0.06
"""Of the leg's length, beyond half the largest stride up to which the reach is searched."""


def walker_memory(robot: RobotDescription, model: LegModel, config: LocomotionConfig, dt: float) -> WalkState:
    """Memory of a walker that ticks every `dt` s; sitting, joints at zero, level, without orders."""
    state = WalkState(model.leg_count, model.joints_per_leg)
    write(state.record["settings"], config)
    _write_model(state, robot, model)
    record, stance = state.record["model"], robot.stance_in_body
    record["dt"] = dt
    record["force_blend"] = 1.0 - np.exp(-dt / config.admittance.force_time)
    record["plane_blend"] = 1.0 - np.exp(-dt / config.posture.plane_time)
    record["layers"] = model.reach * np.array(GROUND_HEIGHTS)
    record["headroom"][: model.leg_count] = headroom(model, stance, config.height_bounds[1])
    record["farthest"] = 0.5 * config.largest_stride + SPARE * model.reach
    _write_space(state, model)
    record["servo_lag"][: model.joints_per_leg] += dt  # the bus brings a target one tick later
    record["target_step"][: model.joints_per_leg] = [robot.servos[j.servo].no_load_speed * dt for j in robot.joints]
    record["foot_depth"] = -stance[:, 2].mean()
    record["down_limit"] = stance[:, 2].min() - LOWEST_FOOTHOLD * model.reach
    record["up_limit"] = stance[:, 2].max() + HIGHEST_FOOTHOLD * model.reach
    state.record["orders"]["posing_rotation"] = state.record["orders"]["still_rotation"] = np.eye(3)
    state.record["senses"]["up"] = state.record["senses"]["unposed_up"] = (0.0, 0.0, 1.0)
    gait = state.record["gait"]
    gait["frequency"] = config.frequency_bounds[1]
    gait["height"] = config.height_bounds[0]
    gait["fastest"] = config.largest_speed
    gait["stiffness"] = config.admittance.stiffness_bounds[1]
    return state


def _write_space(state: WalkState, model: LegModel) -> None:
    """Workspaces and walkspaces about the stances."""
    record, stance = state.record["space"], state.cut("model", "stance")
    layers, farthest = state.record["model"]["layers"], float(state.record["model"]["farthest"])
    state.cut("space", "reach")[:] = workspace(model, stance, layers, farthest)
    state.cut("space", "middle")[:] = state.cut("feet", "stance")[:] = stance
    record["leg"] = -1
    overlapping = bool(state.record["settings"]["overlapping_walkspaces"])
    for leg, radius in enumerate(state.cut("model", "radius")):
        fill_walkspace(state.cut("space", "reach")[leg], stance, leg, overlapping, radius)


def _write_model(state: WalkState, robot: RobotDescription, model: LegModel) -> None:
    record = state.record["model"]
    record["legs"], record["joints"] = model.leg_count, model.joints_per_leg
    record["closed_form"], record["reach"] = model.closed_form, model.reach
    record["trunk_mass"], record["trunk_centre"] = robot.body.mass, robot.body.centre_of_mass_in_body
    record["weight"] = robot.mass * GRAVITY
    arrays = {
        "dh": model.dh,
        "limits": model.limits,
        "safe_limits": model.limits_less(LIMIT_MARGIN),
        "standing": model.standing,
        "hips": model.hips,
        "hip_axes": model.hip_axes,
        "link_mass": model.link_mass,
        "speed_limit": model.speed_limit,
        "servo_stiffness": model.servo_stiffness,
        "servo_lag": model.servo_lag,
        "stance": robot.stance_in_body,
    }
    for name, values in arrays.items():
        record[name][: len(values)] = values
