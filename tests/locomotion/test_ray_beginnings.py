"""Rays of a workspace begin wherever the leg reaches, however far from where the search for joints sets out."""

from itertools import product

import numpy as np
import pytest

from robot_agent.kinematics import LegModel
from robot_agent.locomotion.workspace import FIRST_ITERATIONS, ITERATIONS, LIMIT_MARGIN, reaches
from weaver_shared.robots import load_robot
from weaver_shared.transforms import rotation_from_rpy

PATIENT = 400  # iterations


@pytest.mark.parametrize("name", ["bullet_mammalian", "bullet_b_mammalian", "weaver"])
def test_what_is_found_with_patience_is_found_at_the_beginning_of_a_ray(name):
    robot = load_robot(name)
    model = LegModel.of_robot(robot)
    limits = model.limits_less(LIMIT_MARGIN)

    def found(leg, foot, iterations):
        joints = np.empty(len(model.standing))
        return reaches(model.dh, limits, model.closed_form, model.hips[leg], model.hip_axes[leg], foot, iterations,
                       model.standing, joints)  # fmt: skip

    hasty = []
    for leg, pitch, ahead, height in product(
        range(model.leg_count), np.linspace(-0.15, 0.15, 5), np.linspace(-0.06, 0.06, 5), (-0.04, 0.0, 0.04)
    ):
        foot = rotation_from_rpy(0.0, pitch, 0.0).T @ (robot.stance_in_body[leg] + [ahead, 0.0, height])
        if found(leg, foot, PATIENT):
            assert found(leg, foot, FIRST_ITERATIONS), (leg, pitch, ahead, height)
            hasty.append(found(leg, foot, ITERATIONS))
    assert len(hasty) > 400
    if name == "bullet_mammalian":
        assert not all(hasty)  # or the test would say nothing
