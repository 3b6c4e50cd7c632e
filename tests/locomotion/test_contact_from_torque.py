"""The servos' torques tell which feet stand: fast legs in the air do not seem to touch, and the answer is steady."""

import numpy as np
import pytest

from robot_agent.kinematics import LegModel, foot_jacobian, leg_frames
from robot_agent.locomotion import Walker, WalkInput
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot

ROBOT = load_robot("weaver")
MODEL = LegModel.of_robot(ROBOT)
DT = 0.01
GRAVITY = 9.80665


def geometry(leg, joints):
    """Link middles (n, 3), how they move with the joints (n, n, 3), and the foot's Jacobian (3, n)."""
    origins, axes, jacobian = np.zeros((6, 3)), np.zeros((5, 3)), np.zeros((3, 5))
    leg_frames(MODEL.dh, MODEL.hips[leg], MODEL.hip_axes[leg], joints, origins, axes)
    foot_jacobian(origins, axes, jacobian)
    middles = 0.5 * (origins[:-1] + origins[1:])
    lever = middles[None] - origins[:-1, None]
    moves = np.cross(axes[:, None], lever) * (np.arange(5)[:, None] <= np.arange(5))[..., None]
    return moves, jacobian


def torque_of(leg, joints, acceleration, carried):
    """N m of a leg that accelerates its links, holds them and carries `carried` N."""
    moves, jacobian = geometry(leg, joints)
    mass = np.einsum("ilk,jlk,l->ij", moves, moves, MODEL.link_mass)
    weight = GRAVITY * np.einsum("il,l->i", moves[..., 2], MODEL.link_mass)
    return mass @ acceleration + weight - carried * jacobian[2]


def walked(*, from_torque, frequency=1.0, seconds=6.0):
    """Of every tick after a second: forces felt (legs,), contacts, and which feet are well in the air, or down."""
    foothold = ROBOT.locomotion.foothold.model_copy(update={"contact_from_torque": from_torque})
    config = ROBOT.locomotion.model_copy(
        update={"foothold": foothold, "feel_ground": False, "compensate_servos": False}
    )
    walker = Walker(ROBOT, config, DT)
    joints = walker.begin_standing()
    before = older = joints.copy()
    for tick in range(round(seconds / DT)):
        acceleration = ((joints - before) - (before - older)).reshape(6, 5) / DT**2
        swing, phase = walker._in_air, walker._phase
        carried = np.where(swing, 0.0, ROBOT.mass * GRAVITY / max((~swing).sum(), 1))
        angles = joints.reshape(6, 5)
        torque = np.concatenate([torque_of(leg, angles[leg], acceleration[leg], carried[leg]) for leg in range(6)])
        older, before = before, joints
        aloft = swing & (phase > 0.1) & (phase < 0.4)
        standing = ~swing & (phase > 0.65) & (phase < 0.95)
        out = walker.step(
            WalkInput(
                stamp_ns=0,
                velocity=np.array([0.15, 0.0, 0.0]),
                parameters=GaitParameters(
                    stamp_ns=0, virtual_stiffness=2000.0, stride_frequency=frequency, stride_height=0.06, confidence=1.0
                ),
                gait="tripod",
                stand=True,
                joint_position=joints,
                joint_torque=torque,
                foot_contact=np.zeros(6, dtype=np.bool_),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
            )
        )
        joints = out.joint_position
        if tick * DT > 1.0:
            contact = walker._state.cut("senses", "contact").astype(bool)
            yield out.foot_force.copy(), contact, aloft, standing


def test_legs_in_the_air_do_not_touch_and_standing_ones_do():
    seen = 0
    for _, contact, aloft, standing in walked(from_torque=True):
        assert not contact[aloft].any()
        assert contact[standing].all()
        seen += aloft.sum()
    assert seen > 300


def test_taking_off_the_links_inertia_matters():
    felt = {}
    for from_torque in (True, False):
        felt[from_torque] = max(np.abs(f[a]).max(initial=0.0) for f, _, a, _ in walked(from_torque=from_torque))
    assert felt[True] < 0.7 * felt[False]


def test_a_contact_ends_at_a_lower_force_than_it_began_with():
    foothold = ROBOT.locomotion.foothold.model_copy(update={"contact_from_torque": True, "contact_hold": 1e-6})
    config = ROBOT.locomotion.model_copy(update={"foothold": foothold, "compensate_servos": False})
    walker = Walker(ROBOT, config, DT)
    joints, told = walker.begin_standing(), {}
    angles = joints.reshape(6, 5)
    loads = [20.0] * 40 + [7.0] * 40 + [1.0] * 40 + [7.0] * 40 + [20.0] * 40
    for tick, load in enumerate(loads):
        torque = np.concatenate([torque_of(leg, angles[leg], np.zeros(5), load) for leg in range(6)])
        walker.step(
            WalkInput(
                stamp_ns=0,
                velocity=np.zeros(3),
                parameters=GaitParameters(
                    stamp_ns=0, virtual_stiffness=2000.0, stride_frequency=1.0, stride_height=0.05, confidence=1.0
                ),
                gait="tripod",
                stand=True,
                joint_position=joints,
                joint_torque=torque,
                foot_contact=np.zeros(6, dtype=np.bool_),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
            )
        )
        told[tick] = walker._state.cut("senses", "contact").astype(bool)
    assert [bool(told[tick].all()) for tick in (39, 79, 119, 159, 199)] == [True, True, False, False, True]
    assert not told[119].any()
    assert not told[159].any()


@pytest.mark.parametrize("reading", [True, False])
def test_without_the_setting_the_feet_themselves_are_asked(reading):
    walker = Walker(ROBOT, ROBOT.locomotion, DT)
    joints = walker.begin_standing()
    for _ in range(20):
        walker.step(
            WalkInput(
                stamp_ns=0,
                velocity=np.zeros(3),
                parameters=GaitParameters(
                    stamp_ns=0, virtual_stiffness=2000.0, stride_frequency=1.0, stride_height=0.05, confidence=1.0
                ),
                gait="tripod",
                stand=True,
                joint_position=joints,
                joint_torque=np.zeros(30),
                foot_contact=np.full(6, reading),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
            )
        )
    assert (walker._state.cut("senses", "contact").astype(bool) == reading).all()
