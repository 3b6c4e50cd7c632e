"""Inverse kinematics of one leg: closed forms by geometry, damped least squares with matrices."""

import numpy as np

from numpy_tick.senses import frames, jacobian_of
from robot_agent.kinematics import closed_form, damped, yaw_pitch
from robot_agent.kinematics.inverse import ITERATIVE, TOLERANCE, YAW_PITCH, YAW_ROLL_PITCH


def solve_leg(model, hip, hip_axes, foot, direction, previous, tolerance=TOLERANCE, iterations=damped.ITERATIONS):
    """Joints (n,) and the distance left, m."""
    joints = None
    if model.closed_form == YAW_ROLL_PITCH:
        joints = yaw_roll_pitch(model, hip_axes.T @ (foot - hip), hip_axes.T @ direction)
    elif model.closed_form == YAW_PITCH:
        joints = yaw_pitch_pitch(model, hip_axes.T @ (foot - hip), previous)
    if joints is not None:
        return joints, 0.0
    joints, left = damped_least_squares(
        model.dh, model.limits, hip, hip_axes, foot, direction, previous, tolerance, iterations
    )
    step = model.speed_limit * model.dt
    if model.closed_form == ITERATIVE and len(joints) > 3 and (np.abs(joints - previous) > step).any():
        box = np.column_stack(
            [np.maximum(model.limits[:, 0], previous - step), np.minimum(model.limits[:, 1], previous + step)]
        )
        slower, missed = damped_least_squares(
            model.dh, box, hip, hip_axes, foot, direction, previous, tolerance, iterations
        )
        joints = joints if missed > tolerance else slower
    return joints, left


def within(joints, limits):
    return ((joints >= limits[:, 0]) & (joints <= limits[:, 1])).all()


def wrapped(angle):
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


def yaw_roll_pitch(model, foot, direction):
    """`foot` and `direction` in the hip's frame, x outwards; None where there is no such posture."""
    normal = np.cross(foot, direction)  # of the plane in which the three pitch links move
    if not (np.linalg.norm(normal) > 1e-6 and np.hypot(*normal[:2]) > 1e-3 * np.linalg.norm(normal)):
        return None
    normal = normal / np.linalg.norm(normal)
    normal = -normal if normal[1] < 0.0 else normal
    flat = np.hypot(*normal[:2])
    out = np.array([normal[1], -normal[0], 0.0]) / flat
    down = np.cross(normal, out)
    turned = np.array([np.arctan2(out[1], out[0]), np.arctan2(normal[2], flat)])
    if not within(turned, model.limits[:2]):
        return None
    place = np.array([foot @ out - model.dh[1, 1], foot @ down])
    heading = np.arctan2(direction @ down, direction @ out)
    bent = least_tilted(model, place, heading)
    return None if bent is None else np.array([*turned, *bent])


def least_tilted(model, place, heading):
    """Femur, tibia, tarsus with the last link at `heading` in the plane, or tilted as little as the limits allow."""
    bent = two_links(model, place, heading)
    tilts = np.arange(1, int(closed_form.LARGEST_TILT / closed_form.TILT_STEP) + 2) * closed_form.TILT_STEP
    for tilt in tilts[tilts < closed_form.LARGEST_TILT] if bent is None else ():
        for side in (-1.0, 1.0):
            if two_links(model, place, heading + side * tilt) is None:
                continue
            bad, good = tilt - closed_form.TILT_STEP, tilt
            for _ in range(14):
                middle = 0.5 * (bad + good)
                bad, good = (
                    (bad, middle) if two_links(model, place, heading + side * middle) is not None else (middle, good)
                )
            return two_links(model, place, heading + side * good)
    return bent


def two_links(model, place, heading):
    upper, lower, last = model.dh[2:, 2]
    ankle = place - last * np.array([np.cos(heading), np.sin(heading)])
    far = np.linalg.norm(ankle)
    bend = (far**2 - upper**2 - lower**2) / (2.0 * upper * lower)
    if far > closed_form.STRAIGHT * (upper + lower) or abs(bend) > 1.0:
        return None
    tibia = np.arccos(bend)
    femur = np.arctan2(ankle[1], ankle[0]) - np.arctan2(lower * np.sin(tibia), upper + lower * np.cos(tibia))
    joints = np.array([wrapped(femur), tibia, wrapped(heading - femur - tibia)])
    return joints if within(joints, model.limits[2:]) else None


def yaw_pitch_pitch(model, foot, previous):
    """The posture nearest to `previous` of the up to four that reach `foot` in the hip's frame; None without one."""
    (theta0, d0, r0, alpha0), (theta1, d1, upper, _), (theta2, d2, lower, _) = model.dh[:, :4]
    turned = np.sign(alpha0)
    beside = -turned * (d1 + d2)
    squared = foot[0] ** 2 + foot[1] ** 2 - beside**2
    postures = []
    for side in (1.0, -1.0) if squared > 0.0 else ():
        out = side * np.sqrt(squared)
        yaw = wrapped(np.arctan2(foot[1], foot[0]) - np.arctan2(beside, out) - theta0)
        u, v = out - r0, turned * (foot[2] - d0)
        far = np.hypot(u, v)
        if far > yaw_pitch.STRAIGHT * (upper + lower) or far < abs(upper - lower):
            continue
        bend = np.arccos((far**2 - upper**2 - lower**2) / (2.0 * upper * lower))
        lean = np.arctan2(lower * np.sin(bend), upper + lower * np.cos(bend))
        for knee in (1.0, -1.0):
            femur = wrapped(np.arctan2(v, u) - knee * lean - theta1)
            postures.append(np.array([yaw, femur, wrapped(knee * bend - theta2)]))
    postures = [posture for posture in postures if within(posture, model.limits)]
    return min(postures, key=lambda posture: np.abs(posture - previous).max(), default=None)


def damped_least_squares(dh, limits, hip, hip_axes, foot, direction, previous, tolerance, iterations):
    n, joints = len(dh), previous.copy()
    reach = np.abs(dh[:, 1:3]).sum()
    best, best_left, start_left = previous.copy(), np.inf, np.inf
    stopped = np.zeros(n, dtype=bool)
    for iteration in range(iterations):
        origins, axes = frames(dh, hip, hip_axes, joints)
        error = foot - origins[-1]
        left = np.linalg.norm(error)
        glides = n > 3 and iteration == 0
        if glides:
            start_left = left
        elif left < best_left:
            best, best_left = joints.copy(), left
        if left < tolerance and not glides:
            break
        error = error * min(1.0, damped.LARGEST_ERROR * reach / left) if left > 0.0 else error
        jacobian = jacobian_of(origins, axes)
        room = np.minimum(limits[:, 1] - joints, joints - limits[:, 0])
        weight = np.clip(room / (damped.MARGIN * (limits[:, 1] - limits[:, 0])), damped.LEAST_WEIGHT, 1.0) * ~stopped
        free = weight * (comfortable_step(limits, joints, origins, axes, direction) if glides else 0.0)
        normal = jacobian @ np.diag(weight) @ jacobian.T + (damped.DAMPING * reach) ** 2 * np.eye(3)
        step = free + weight * (jacobian.T @ np.linalg.solve(normal, error - jacobian @ free))
        wanted, joints = joints + step, np.clip(joints + step, limits[:, 0], limits[:, 1])
        stopped = wanted != joints
    if start_left < tolerance <= best_left:
        return previous.copy(), start_left
    return best, best_left


def comfortable_step(limits, joints, origins, axes, direction):
    """Towards the last link's direction, and away from joint limits."""
    link = (origins[-1] - origins[-2]) / np.linalg.norm(origins[-1] - origins[-2])
    away = np.cross(link, direction)
    away = away * damped.ALIGNMENT_GAIN / max(1.0, np.linalg.norm(away) / damped.LARGEST_MISALIGNMENT)
    middle, half = limits.mean(axis=1), 0.5 * (limits[:, 1] - limits[:, 0])
    beyond = np.maximum(np.abs(joints - middle) - damped.COMFORT * half, 0.0)
    return axes @ away - damped.AVOIDANCE_GAIN * beyond * np.sign(joints - middle)
