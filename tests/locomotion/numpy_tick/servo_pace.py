"""What the servos need of their speed, and the pace they can follow."""

import numpy as np

from numpy_tick.speed import speed_of
from robot_agent.locomotion import servo_pace as rules
from robot_agent.locomotion.walk_state import PEAKS


def forget_demand(walk):
    gait = walk.gait
    gait.demand, gait.freshest_peak, gait.stretch, gait.stride_pace = 0.0, 0.0, 0, 1.0
    gait.peaks, gait.fastest = 0.0, walk.settings.largest_speed


def learn_demand(walk, demanded):
    gait, settings = walk.gait, walk.settings
    gait.demand += rules.BLEND * (demanded / max(gait.pace, rules.SLOWEST_PACE) - gait.demand)
    stretch = min(int(gait.phase * PEAKS), PEAKS - 1)
    if stretch != gait.stretch:
        gait.peaks[gait.stretch] = gait.freshest_peak
        gait.stride_pace = pace_for(np.sort(gait.peaks)[-1 - rules.HARDEST])
        if stretch < gait.stretch and settings.spare_servos:
            fit_speed(walk)
        gait.stretch, gait.freshest_peak = stretch, 0.0
    gait.freshest_peak = max(gait.freshest_peak, gait.demand)


def fit_speed(walk):
    gait, largest = walk.gait, walk.settings.largest_speed
    pace = gait.stride_pace
    if pace < rules.LOW_PACE:
        slower = 0.5 * (1.0 + pace / rules.LOW_PACE) * speed_of(gait.commanded)
        gait.fastest = min(max(slower, rules.LEAST_SPEED * largest), gait.fastest)
    elif pace > rules.GOOD_PACE:
        gait.fastest = min(rules.FASTER * gait.fastest, largest)


def pace_for(demand):
    return max(1.0 / max(demand, 1.0), rules.SLOWEST_PACE)
