"""How the body moves over its feet."""

import numpy as np

from robot_agent.locomotion.body_motion import HANGING_WEIGHT

HANG = 3


def move_body(walk):
    body, config, dt = walk.body, walk.settings.posture, walk.model.dt
    up = walk.senses.unposed_up
    follow_plane(walk)
    normal = np.array([-body.plane[0], -body.plane[1], 1.0])
    wanted = (1.0 - config.follow_ground) * up + config.follow_ground * normal / np.linalg.norm(normal)
    wanted = wanted / np.linalg.norm(wanted)
    tilt = np.array([-wanted[1], wanted[0]])
    turn = beyond(tilt, config.attitude_dead_band) * config.attitude_gain
    missing = walk.model.foot_depth + body.plane[2] / np.linalg.norm(normal)
    rise = beyond(np.array([missing]), config.height_dead_band)[0] * config.height_gain
    shift = -config.shift_fraction * (walk.model.foot_depth + walk.senses.unposed_centre[2]) / max(up[2], 0.5) * up[:2]
    step = np.clip(at_most(shift, config.largest_shift) - body.shift, -config.shift_rate * dt, config.shift_rate * dt)
    body.shift += step
    body.linear = [*(-step / dt), np.clip(rise, -config.height_rate, config.height_rate)]
    body.angular[:2] = at_most(turn, config.attitude_rate)
    vx, vy, spin = walk.gait.velocity
    body.whole_linear = body.linear + np.array([vx, vy, body.plane[0] * vx + body.plane[1] * vy])
    body.whole_angular = [*body.angular[:2], spin]


def beyond(vector, dead_band):
    """What of a vector is longer than its dead band."""
    size = np.linalg.norm(vector)
    return vector * 0.0 if size <= dead_band else vector * (size - dead_band) / size


def at_most(vector, size):
    length = np.linalg.norm(vector)
    return vector if length <= size else vector * size / length


def follow_plane(walk):
    weight = np.where(walk.feet.mode == HANG, HANGING_WEIGHT, 1.0)
    fresh, walk.answer.residual = fit_plane(walk.feet.anchor, weight)
    walk.body.plane += walk.model.plane_blend * (fresh - walk.body.plane)


def fit_plane(points, weight):
    """a, b, c of z = a x + b y + c, and the rms residual, by weighted least squares about the mean."""
    middle = weight @ points / weight.sum()
    away = points - middle
    normal = (away[:, :2] * weight[:, None]).T @ away[:, :2]
    right = (away[:, :2] * weight[:, None]).T @ away[:, 2]
    slope = np.linalg.solve(normal, right) if np.diag(normal).min() > 1e-6 else np.zeros(2)
    residual = away[:, 2] - away[:, :2] @ slope
    return np.array([*slope, middle[2] - slope @ middle[:2]]), np.sqrt(weight @ residual**2 / weight.sum())
