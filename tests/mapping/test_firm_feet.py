"""A foot counts once it has borne for a while, and once each time it is put down."""

import numpy as np
import pytest

from robot_agent.mapping import FirmFeet
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.transforms import Pose, rotation_from_rpy

TICK_NS = 10_000_000
ROBOT = load_robot()
JOINTS = np.linspace(-0.3, 0.4, ROBOT.joint_count)
POSE = Pose(rotation=rotation_from_rpy(0.1, -0.05, 0.4), position=np.array([2.0, -1.0, 0.17]))


def readings(first, contacts):
    """Ticks from number `first` on with these contacts (n, legs)."""
    contacts = np.asarray(contacts, dtype=bool)
    n = len(contacts)
    return FootContacts(
        stamp_ns=(first + np.arange(n)) * TICK_NS,
        foot_in_body=np.tile(feet_in_body(ROBOT, JOINTS), (n, 1, 1)),
        sole_in_body=np.tile(feet_in_body(ROBOT, JOINTS), (n, 1, 1)),
        touching=contacts,
    )


def only(leg, ticks):
    contact = np.zeros((ticks, ROBOT.leg_count), dtype=bool)
    contact[:, leg] = True
    return contact


def test_a_standing_foot_is_told_once_and_where_its_sole_is():
    feet = FirmFeet(ROBOT)
    assert len(feet.step(readings(0, only(2, 8)), POSE)) == 0
    points = feet.step(readings(8, only(2, 8)), POSE)
    sole = POSE.transform(feet_in_body(ROBOT, JOINTS)[2]) - [0.0, 0.0, ROBOT.foot_radius]
    assert points == pytest.approx(sole[None, :])
    for k in range(2, 9):
        assert len(feet.step(readings(8 * k, only(2, 8)), POSE)) == 0
        assert feet.standing[2] == pytest.approx(sole)
        assert np.isnan(np.delete(feet.standing, 2, axis=0)).all()
    feet.step(readings(80, only(2, 8) & False), POSE)
    assert np.isnan(feet.standing).all()


def test_a_foot_put_down_again_is_told_again():
    feet, told = FirmFeet(ROBOT), 0
    for k in range(6):
        told += len(feet.step(readings(40 * k, only(1, 20)), POSE))
        told += len(feet.step(readings(40 * k + 20, only(1, 20) & False), POSE))
    assert told == 6


def test_a_trembling_contact_is_never_firm():
    feet = FirmFeet(ROBOT)
    contact = only(0, 100)
    contact[::5] = False
    assert len(feet.step(readings(0, contact), POSE)) == 0


def test_no_readings_are_no_feet():
    assert FirmFeet(ROBOT).step(None, POSE).shape == (0, 3)
