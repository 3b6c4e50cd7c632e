"""Every reading reaches vision once, with the picture it precedes."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.felt_queue import FeltQueue
from weaver_shared.messages import ImuBatch, Proprioception

TICK_NS, SAMPLE_NS = 10_000_000, 2_000_000


def tick(k, joints=3, legs=2):
    stamps = k * TICK_NS + SAMPLE_NS * np.arange(1, 6)
    return Proprioception(
        stamp_ns=(k + 1) * TICK_NS,
        joint_position=np.full(joints, float(k)),
        joint_velocity=np.zeros(joints),
        joint_torque=np.zeros(joints),
        joint_valid=np.ones(joints, dtype=bool),
        joint_temperature=np.zeros(joints),
        foot_contact=np.array([k % 2 == 0, True]),
        imu=ImuBatch(
            stamp_ns=stamps, angular_velocity_in_imu=np.zeros((5, 3)), specific_force_in_imu=np.tile(stamps, (3, 1)).T
        ),
        battery_voltage=25.0,
        supply_current=1.0,
        motor_power=10.0,
    )


@given(st.lists(st.integers(0, 400_000_000), max_size=6))
def test_every_reading_is_handed_over_once_and_in_order(pictures):
    queue, imu, legs = FeltQueue(), [], []
    for k in range(30):
        queue.add(tick(k))
    for stamp_ns in [*sorted(pictures), 10**12]:
        felt = queue.up_to(stamp_ns)
        assert (felt.imu.stamp_ns <= stamp_ns).all()
        assert (felt.legs.stamp_ns <= stamp_ns).all()
        imu.extend(felt.imu.stamp_ns)
        legs.extend(felt.legs.stamp_ns)
    assert imu == [SAMPLE_NS * k for k in range(1, 151)]
    assert legs == [TICK_NS * k for k in range(1, 31)]


def test_a_batch_holds_what_the_legs_felt():
    queue = FeltQueue()
    assert queue.newest_imu_ns() == -1
    for k in range(3):
        queue.add(tick(k))
    legs = queue.up_to(10**9).legs
    assert legs.joint_position.tolist() == [[0.0] * 3, [1.0] * 3, [2.0] * 3]
    assert legs.foot_contact.tolist() == [[True, True], [False, True], [True, True]]
    assert len(queue.up_to(10**9).legs.stamp_ns) == 0
