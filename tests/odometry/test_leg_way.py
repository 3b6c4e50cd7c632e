"""Standing feet tell the way: exactly if they stand, without those that slip, less well while there are too few."""

from dataclasses import replace

import numpy as np
import pytest

from robot_agent.odometry.contacts import ContactStream
from robot_agent.odometry.leg_way import Way, joined, way_of
from weaver_shared.config.odometry import FeetConfig
from weaver_shared.foot_contacts import FootContacts
from weaver_shared.transforms import Pose, rotation_exp

FEET = FeetConfig()
TICK_NS, TICKS = 10_000_000, 8
RATE = np.array([0.1, -0.2, 0.4])
SPEED = np.array([0.2, 0.05, -0.02])
FOOTHOLDS = np.array([[0.3, 0.2, -0.15], [0.0, 0.3, -0.14], [-0.3, 0.2, -0.16], [0.3, -0.2, -0.15]])
IMU_FROM_BODY = Pose.of([-0.28, 0.0, -0.15])
SAMPLES = np.array([[0.005, *RATE, 0.0, 0.0, 9.8]] * (2 * TICKS))


def _imu(stamp_ns: int) -> Pose:
    """World_from_imu of a body that turns and moves steadily from the origin."""
    t = stamp_ns * 1e-9
    return Pose(rotation=rotation_exp(RATE * t), position=SPEED * t)


def _contacts(footholds: np.ndarray = FOOTHOLDS) -> FootContacts:
    stamps = np.arange(TICKS + 1, dtype=np.int64) * TICK_NS
    body = [(_imu(int(stamp)) @ IMU_FROM_BODY).inverse() for stamp in stamps]
    feet = np.array([pose.transform(footholds) for pose in body])
    return FootContacts(
        stamp_ns=stamps,
        foot_in_body=feet,
        sole_in_body=feet.copy(),
        touching=np.ones((len(stamps), len(footholds)), dtype=np.bool_),
    )


def _way(contacts: FootContacts | None) -> Way | None:
    return way_of(contacts, SAMPLES, TICKS * TICK_NS, np.zeros(3), IMU_FROM_BODY, FEET)


def test_feet_that_stand_give_the_way_and_the_turn() -> None:
    way, truth = _way(_contacts()), _imu(TICKS * TICK_NS)
    assert way is not None
    assert way.displacement == pytest.approx(truth.position, abs=1e-9)
    assert way.turn == pytest.approx(truth.rotation, abs=1e-9)
    assert not way.slipping


def test_a_foot_that_slips_is_left_out() -> None:
    contacts = _contacts()
    contacts.sole_in_body[5:, 2] = _contacts(FOOTHOLDS + np.array([0.03, 0.0, 0.0])).sole_in_body[5:, 2]
    way = _way(contacts)
    assert way is not None
    assert way.slipping
    assert way.displacement == pytest.approx(_imu(TICKS * TICK_NS).position, abs=1e-9)


def test_feet_that_roll_carry_the_body_by_radius_times_angle() -> None:
    """Links lean from 0.25 rad ahead to 0.25 rad behind while the body passes over feet of 16 mm."""
    radius, contacts = 0.016, _contacts()
    angles = np.linspace(0.25, -0.25, TICKS + 1)
    for n, angle in enumerate(angles):
        world_from_body = _imu(n * TICK_NS) @ IMU_FROM_BODY
        rolled = np.array([radius * (angles[0] - angle), 0.0, 0.0])
        link = np.array([np.sin(angle), 0.0, -np.cos(angle)])
        body_from_world = world_from_body.inverse()
        contacts.foot_in_body[n] = body_from_world.transform(FOOTHOLDS + rolled)
        contacts.sole_in_body[n] = body_from_world.transform(FOOTHOLDS + rolled + radius * link)
    way = _way(contacts)
    assert way is not None
    assert way.displacement == pytest.approx(_imu(TICKS * TICK_NS).position, abs=1e-4)
    centres = _way(replace(contacts, sole_in_body=contacts.foot_in_body))
    assert centres is not None
    assert abs(centres.displacement - way.displacement).max() > 0.9 * radius * 0.5


def test_a_moment_without_two_feet_makes_the_way_less_sure_and_a_long_one_unknown() -> None:
    contacts, sure = _contacts(), _way(_contacts())
    contacts.touching[4, 1:] = False
    way = _way(contacts)
    assert way is not None
    assert sure is not None
    assert way.variance > 2.0 * sure.variance
    assert way.displacement == pytest.approx(_imu(TICKS * TICK_NS).position, abs=2e-3)
    contacts.touching[:] = False
    assert _way(contacts) is None
    assert _way(None) is None


def test_two_ways_joined_are_the_whole_one() -> None:
    contacts, middle = _contacts(), TICKS // 2
    first = replace(
        contacts, stamp_ns=contacts.stamp_ns[: middle + 1], sole_in_body=contacts.sole_in_body[: middle + 1]
    )
    second = replace(contacts, stamp_ns=contacts.stamp_ns[middle:], sole_in_body=contacts.sole_in_body[middle:])
    halves = [
        way_of(part, SAMPLES[:TICKS], end, np.zeros(3), IMU_FROM_BODY, FEET)
        for part, end in ((first, middle * TICK_NS), (second, TICKS * TICK_NS))
    ]
    way, whole = joined(halves[0], halves[1], FEET), _way(contacts)
    assert way is not None
    assert whole is not None
    assert way.displacement == pytest.approx(whole.displacement, abs=1e-9)
    assert way.variance == pytest.approx(whole.variance)
    assert joined(halves[0], None, FEET) is None


def test_a_foot_counts_once_it_has_stood() -> None:
    stream, contacts = ContactStream(FEET), _contacts()
    contacts.touching[:3, 0] = False
    stream.add(contacts)
    taken = stream.take_until(TICKS * TICK_NS)
    assert taken is not None
    assert taken.touching[:, 0].tolist() == [False] * 6 + [True] * 3


def test_every_stretch_begins_where_the_last_one_ended_and_nonsense_is_left_out() -> None:
    stream, contacts = ContactStream(FEET), _contacts()
    contacts.foot_in_body[6] = np.nan
    stream.add(contacts)
    stream.add(contacts)  # comes twice
    first, second = stream.take_until(3 * TICK_NS), stream.take_until(TICKS * TICK_NS)
    assert first is not None
    assert second is not None
    assert first.stamp_ns[-1] == second.stamp_ns[0] == 3 * TICK_NS
    assert (second.stamp_ns // TICK_NS).tolist() == [3, 4, 5, 7, 8]
    assert stream.take_until(TICKS * TICK_NS) is None
