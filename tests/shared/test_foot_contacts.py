"""The ground under a robot is where its touching feet are, or its lowest ones."""

import numpy as np
import pytest

from weaver_shared.foot_contacts import FootContacts
from weaver_shared.transforms import Pose, rotation_from_rpy

POSE = Pose(rotation=rotation_from_rpy(0.1, -0.2, 0.5), position=np.array([1.0, 2.0, 0.2]))


def feet_at(world_z, touching):
    """One reading of six feet whose centres lie at these world heights, m."""
    x, y = np.array([[0.3, 0.0, -0.3, 0.3, 0.0, -0.3], [-0.3, -0.4, -0.3, 0.3, 0.4, 0.3]])
    in_world = np.column_stack([x + 1.0, y + 2.0, world_z])
    return FootContacts(
        stamp_ns=np.array([0]),
        foot_in_body=np.array([[POSE.inverse().transform(point) for point in in_world]]),
        touching=np.array([touching], dtype=bool),
    )


def test_touching_feet_tell_the_ground_and_swinging_ones_do_not():
    contacts = feet_at([0.02, 0.12, 0.03, 0.12, 0.04, 0.12], [1, 0, 1, 0, 1, 0])
    assert contacts.ground_height(POSE, 0.02) == pytest.approx(0.01)


def test_without_three_contacts_the_three_lowest_feet_tell_it():
    contacts = feet_at([0.02, 0.12, 0.03, 0.12, 0.04, 0.12], [0, 0, 0, 1, 0, 0])
    assert contacts.ground_height(POSE, 0.02) == pytest.approx(0.01)
