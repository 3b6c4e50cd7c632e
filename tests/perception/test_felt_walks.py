"""Blind walks in the simulator: feet, joints and body feel level ground as level, and blocks as rough."""

from dataclasses import replace

import numpy as np

from robot_agent.mapping import FirmFeet
from robot_agent.perception import BodySense, FeltGround
from sim_agent.fit_study.grounds import GROUNDS, RUN_UP
from sim_agent.study.climb import climbing_order
from sim_agent.study.posture import rise
from sim_agent.study.rig import Rig
from sim_agent.worlds import make_world
from weaver_shared.config.perception import PerceptionConfig
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.leg_batch import LegBatch
from weaver_shared.robots import load_robot

ROBOT = load_robot()
LOOK = 5  # control ticks from one picture to the next
STANDING = 5  # looks before it sets off
LAG = 0.4  # m into a ground from which on the feet have left the one before


def feel(world, distance, stiffness, frequency, height, seed=1):
    """Rows of place along the course, felt roughness and its sigma, of a walk at one gait. The pose is the true one."""
    rig = Rig(ROBOT, world, seed)
    rig.parameters = replace(
        rig.parameters, virtual_stiffness=stiffness, stride_frequency=frequency, stride_height=height
    )
    felt, feet = FeltGround(PerceptionConfig().felt, PerceptionConfig().features), FirmFeet(ROBOT)
    rows, batch = [], []
    try:
        assert rise(rig, "tripod")
        while (x := float(rig.truth().position[0])) < distance:
            velocity = climbing_order(rig, 0.3) if len(rows) > STANDING else np.zeros(3)
            batch.append(rig.step(gait="tripod", velocity=velocity))
            if len(batch) < LOOK:
                continue
            legs, pose, stamp_ns = LegBatch.of(batch), rig.truth(), batch[-1].stamp_ns
            feet.step(FootContacts.of(ROBOT, legs), pose)
            ground = felt.step(BodySense.of(ROBOT, legs, stamp_ns, pose, feet.standing, placed=True))
            rows.append((x, ground.roughness, ground.roughness_sigma))
            batch = []
    finally:
        rig.close()
    return np.array(rows)


def test_level_ground_feels_flat_at_a_quick_gait():
    rows = feel(make_world("flat", 1), 1.0, 2500.0, 1.4, 0.03)
    known = rows[np.isfinite(rows[:, 1])]
    assert len(known) > 0.8 * len(rows)
    assert np.quantile(known[:, 1], 0.9) < 0.05


def test_blocks_feel_rough():
    ground = next(ground for ground in GROUNDS if ground.name == "broken")
    rows = feel(ground.world(ROBOT, 1), 1.3, 1500.0, 0.9, 0.08)
    inside = rows[:, 0] > RUN_UP + LAG
    assert np.nanmean(rows[inside, 1]) > 0.4
    assert np.nanmean(rows[rows[:, 0] < 0.1, 1]) < 0.05
