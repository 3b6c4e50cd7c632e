"""Standing up from packed and sitting down again, direct and in sequence, kinematically and in physics."""

import numpy as np
import pytest

from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.folding import Folding
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body

ROBOT = load_robot("weaver")
DT = 0.01
PARAMETERS = GaitParameters(
    stamp_ns=0, virtual_stiffness=2500.0, stride_frequency=0.8, stride_height=0.06, confidence=1.0
)


def order(joints, torque, contact, velocity, gravity, **wants):
    return WalkInput(
        stamp_ns=0, velocity=np.array(velocity), parameters=PARAMETERS, gait="tripod", joint_position=joints,
        joint_torque=torque, foot_contact=contact, gravity_in_body=gravity, **{"stand": True, **wants},
    )  # fmt: skip


class Ideal:
    """Joints that do as they are told."""

    def __init__(self, joints):
        self.walker = Walker(ROBOT, LocomotionConfig(feel_ground=False, compensate_servos=False), DT)
        self.joints = np.asarray(joints).ravel()
        self.walker.reset(self.joints)

    def run(self, seconds, velocity=(0.0, 0.0, 0.0), **wants):
        outs = []
        for _ in range(round(seconds / DT)):
            everything = np.ones(6, dtype=bool)
            down = np.array([0.0, 0.0, -1.0])
            outs.append(self.walker.step(order(self.joints, np.zeros(30), everything, velocity, down, **wants)))
            self.joints = outs[-1].joint_position
        return outs


@pytest.mark.parametrize("in_sequence", [False, True])
def test_from_packed_to_standing_and_back(in_sequence):
    ideal = Ideal(ROBOT.packed_joints)
    before, fastest = ideal.joints, 0.0
    for out in ideal.run(25.0, in_sequence=in_sequence):
        fastest = max(fastest, np.abs(out.joint_position - before).max() / DT)
        before = out.joint_position
    assert out.posture == "standing"
    np.testing.assert_allclose(feet_in_body(ROBOT, ideal.joints), ROBOT.stance_in_body, atol=1e-5)
    for out in ideal.run(30.0, stand=False, pack=True, in_sequence=in_sequence):
        fastest = max(fastest, np.abs(out.joint_position - before).max() / DT)
        before = out.joint_position
    assert out.posture == "sitting"
    np.testing.assert_allclose(ideal.joints.reshape(6, 5), ROBOT.packed_joints, atol=1e-9)
    assert fastest < 1.5


def test_in_sequence_only_every_second_leg_moves_at_a_time():
    ideal = Ideal(ROBOT.packed_joints)
    before, groups = ideal.joints.reshape(6, 5), []
    for out in ideal.run(4.0, in_sequence=True):
        angles = out.joint_position.reshape(6, 5)
        moving = np.abs(angles - before).max(axis=1) > 1e-9
        before = angles
        groups.append(tuple(moving))
        if out.foot_in_body[:, 2].max() < 0.0:
            break
    evens, odds = (True, False) * 3, (False, True) * 3
    assert evens in groups
    assert set(groups) <= {evens, odds, (False,) * 6}


def test_in_sequence_scattered_feet_step_back_before_the_robot_goes_down():
    scattered, direct = Ideal(ROBOT.packed_joints), Ideal(ROBOT.packed_joints)
    ends = []
    for ideal, in_sequence in ((scattered, True), (direct, False)):
        ideal.run(10.0)
        ideal.run(2.87, (0.25, 0.0, 0.1))
        swung = np.zeros(6, dtype=bool)
        previous = None
        for out in ideal.run(30.0, stand=False, in_sequence=in_sequence):
            swung |= out.swing
            if out.posture == "lowering" and previous is not None:  # no foot slides while it carries
                np.testing.assert_allclose(out.foot_in_body[:, :2], previous[:, :2], atol=1e-6)
            previous = out.foot_in_body if out.posture == "lowering" else None
        assert out.posture == "sitting"
        ends.append(np.hypot(*(out.foot_in_body - ROBOT.stance_in_body)[:, :2].T).max())
    assert ends[0] < 0.02
    assert ends[1] > 0.03


def test_an_order_to_stand_while_packing_is_followed_when_the_legs_are_folded():
    ideal = Ideal(ROBOT.packed_joints)
    ideal.run(10.0)
    ideal.run(4.5, stand=False, pack=True)
    assert ideal.run(20.0)[-1].posture == "standing"


@pytest.mark.parametrize("legs", [3, 4, 6, 8])
@pytest.mark.parametrize("joints", [3, 4, 5, 6])
def test_folding_ends_in_the_last_posture_whatever_the_legs(legs, joints):
    generator = np.random.default_rng(legs * 10 + joints)
    start, first, last = generator.uniform(-1.0, 1.0, (3, legs, joints))
    for in_groups in (False, True):
        folding, before = Folding(start, [first, last], 0.6, in_groups=in_groups), start
        for _ in range(4000):
            angles = folding.step(DT)
            assert np.abs(angles - before).max() <= 0.6 * 1.876 * DT  # the quintic's largest over its mean speed
            before = angles
        assert folding.done
        np.testing.assert_array_equal(angles, last)


@pytest.mark.parametrize("in_sequence", [False, True])
def test_in_physics_it_stands_up_from_packed_and_sits_down_again(in_sequence):
    pytest.importorskip("pybullet")
    from robot_agent.body import JointTargets
    from sim_agent.body import SimulatedBody
    from sim_agent.worlds import make_world
    from weaver_shared.transforms import Pose

    body = SimulatedBody(ROBOT, make_world("flat", 1), 1)
    walker = Walker(ROBOT)
    limit = np.tile([ROBOT.servos[joint.servo].stall_torque for joint in ROBOT.joints], 6)
    tilts, heights, postures, begun = [], [], [], False
    script = ((9.0, True), (28.0, False), (45.0, True))  # until when, s, and whether to stand
    tick, walked = 0, False
    for until, stand in script:
        while tick * DT < until:
            body.wait_next()
            sensed = body.read()
            if not begun:
                walker.reset(sensed.joint_position)
                begun = True
            truth = body.truth()
            rotation = Pose.of(truth.position_in_world, truth.wxyz).rotation
            velocity = (0.15, 0.0, 0.1) if 6.0 < tick * DT < 8.5 else (0.0, 0.0, 0.0)
            out = walker.step(
                order(sensed.joint_position, sensed.joint_torque, sensed.foot_contact, velocity, -rotation[2],
                      stand=stand, pack=True, in_sequence=in_sequence)
            )  # fmt: skip
            body.write(
                JointTargets(stamp_ns=sensed.stamp_ns, position=out.joint_position, torque_limit=limit, torque_on=True)
            )
            tilts.append(np.arccos(rotation[2, 2]))
            heights.append(truth.position_in_world[2])
            walked |= out.posture == "walking"
            tick += 1
        postures.append((out.posture, heights[-1]))
        if not stand:
            packed = np.abs(sensed.joint_position.reshape(6, 5) - ROBOT.packed_joints).max()
            assert packed < 0.1
    body.close()
    assert walked
    assert [posture for posture, _ in postures] == ["standing", "sitting", "standing"]
    assert postures[2][1] == pytest.approx(ROBOT.clearance, abs=0.005)
    assert abs(postures[1][1]) < 0.02
    assert np.degrees(max(tilts)) < 8.0
