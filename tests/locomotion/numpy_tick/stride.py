"""A foot's stride and swing."""

import numpy as np


def ground_velocity(velocity, foot):
    """Of the ground under `foot`, (3,) m/s seen from a body that moves with (vx, vy, turn)."""
    vx, vy, turn = velocity
    return -np.array([vx, vy, 0.0]) - np.cross([0.0, 0.0, turn], foot) * [1.0, 1.0, 0.0]


def stride_of(velocity, foot, duty, frequency):
    return -ground_velocity(velocity, foot) * duty / frequency


def swing_nodes(lift_off, foothold, up, height, ground, touchdown_speed, half_time, along_up, outward):
    """Both curves' nodes, (5, 3) each: they leave and meet the ground at its own velocity and pass the apex level."""
    rise = (foothold - lift_off) @ up
    leaving = 0.25 * half_time * ground
    arriving = leaving - 0.25 * half_time * touchdown_speed * up
    way = foothold - lift_off - rise * up
    apex = lift_off + (way - 4.0 * leaving if along_up else 0.5 * way) + (max(rise, 0.0) + height) * up
    before = apex - leaving if along_up else 0.5 * (apex + lift_off + 2.0 * leaving)
    before = before + ((apex - before) @ up) * up + outward
    apex = apex + outward
    first = np.array([lift_off, lift_off + leaving, lift_off + 2.0 * leaving, before, apex])
    second = np.array([apex, 2.0 * apex - before, foothold - 2.0 * arriving, foothold - arriving, foothold])
    return first, second


def bezier(nodes, t):
    """De Casteljau's construction."""
    while len(nodes) > 1:
        nodes = (1.0 - t) * nodes[:-1] + t * nodes[1:]
    return nodes[0]
