"""Static and energy margins by the edges of the support polygon."""

import itertools

import numpy as np

STAND = 0


def judge(walk):
    feet, senses, told = walk.senses.origins[:, -1], walk.senses, walk.answer
    carrying = walk.feet.mode == STAND
    told.static_margin = static_margin(feet[carrying], senses.centre_of_mass, senses.up)
    told.energy_margin = energy_margin(feet[carrying], senses.centre_of_mass, senses.up)
    told.may_lift = not walk.gait.walking
    if told.may_lift:
        others = [carrying & (np.arange(len(feet)) != leg) for leg in range(len(feet))]
        told.lift_margin = [static_margin(feet[left], senses.centre_of_mass, senses.up) for left in others]


def beside(feet, centre, up):
    """(n, 2): where the feet are from the centre of mass, sheared so that gravity falls along z."""
    away = feet - centre
    return away[:, :2] - np.outer(away[:, 2] / up[2], up[:2])


def edges(points):
    """Pairs of points (n, 2) with all others on the left of the line through them."""
    for i, j in itertools.permutations(range(len(points)), 2):
        along = points[j] - points[i]
        left = along[0] * (points[:, 1] - points[i, 1]) - along[1] * (points[:, 0] - points[i, 0])
        if along @ along >= 1e-18 and left.min() >= -1e-9:
            yield i, j


def distance(points, i, j):
    """From the origin to the line through two points, positive on its left."""
    along = points[j] - points[i]
    return (along[1] * points[i, 0] - along[0] * points[i, 1]) / np.linalg.norm(along)


def static_margin(feet, centre, up):
    if len(feet) == 0:
        return -1.0
    points = beside(feet, centre, up)
    distances = [distance(points, i, j) for i, j in edges(points)]
    return min(distances) if len(distances) >= 3 else -np.linalg.norm(points, axis=1).min()


def energy_margin(feet, centre, up):
    points, heights = beside(feet, centre, up), []
    for i, j in edges(points):
        edge = (feet[j] - feet[i]) / np.linalg.norm(feet[j] - feet[i])
        arm = centre - feet[i]
        arm = arm - (arm @ edge) * edge
        highest = np.linalg.norm(arm) * np.sqrt(max(1.0 - (up @ edge) ** 2, 0.0))
        sign = 1.0 if distance(points, i, j) >= 0.0 else -1.0
        heights.append(sign * (highest - arm @ up))
    return min(heights) if len(heights) >= 3 else 0.0
