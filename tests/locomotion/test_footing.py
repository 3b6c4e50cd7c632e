"""Slips and stumbles are told from walking, once each, with the leg's name."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.kinematics import LegModel
from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.feet import STAND, SWING
from robot_agent.locomotion.footing import EVERY, Footing, slide
from robot_agent.locomotion.walker_memory import walker_memory
from weaver_shared.config.locomotion import FootingConfig, LocomotionConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose, rotation_z

ROBOT = load_robot("weaver")
FEET = ROBOT.stance_in_body
CONFIG = FootingConfig()
ALL = np.ones(6, dtype=bool)
DT = 0.01
small = st.floats(-0.02, 0.02)


@given(small, small, st.floats(-0.1, 0.1), st.sets(st.integers(0, 5), min_size=3))
def test_feet_that_move_as_one_do_not_slip(x, y, turn, standing):
    moved = FEET @ rotation_z(turn).T + [x, y, 0.0]
    mask, slipped = np.isin(np.arange(6), list(standing)), np.zeros((6, 2))
    slide(moved, FEET, mask, 1.0, slipped)
    np.testing.assert_allclose(slipped, 0.0, atol=1e-12)


@given(small, small, st.integers(0, 5))
def test_the_foot_that_moves_alone_slips_most(x, y, leg):
    moved, slipped = FEET.copy(), np.zeros((6, 2))
    moved[leg, :2] += x, y
    slide(moved, FEET, ALL, 1.0, slipped)
    size = np.hypot(*slipped.T)
    if np.hypot(x, y) > 1e-3:
        assert int(np.argmax(size)) == leg
        assert size[leg] > 0.5 * np.hypot(x, y)
    np.testing.assert_allclose(slipped.sum(axis=0), 0.0, atol=1e-12)


@pytest.fixture
def memory():
    state = walker_memory(ROBOT, LegModel.of_robot(ROBOT), LocomotionConfig(), DT)
    state.cut("senses", "unposed_feet")[:] = FEET
    state.cut("senses", "contact")[:] = True
    state.cut("feet", "mode")[:] = STAND
    state.record["gait"]["duty"] = 0.5
    return state


def look(footing, seconds):
    return [event for _ in range(round(seconds / DT)) for event in footing.step()]


def test_a_slip_is_said_once_and_ends(memory):
    footing, feet = Footing(ROBOT.leg_names, memory, CONFIG, DT), memory.cut("senses", "unposed_feet")
    assert look(footing, 0.3) == []
    events = []
    for _ in range(20):
        feet[2, 0] += 0.002
        events += look(footing, EVERY * DT)
    assert events == ["leg CR slips"]
    np.testing.assert_array_equal(footing.slipping, np.arange(6) == 2)
    assert look(footing, 3.0) == []
    assert not footing.slipping.any()


def test_a_foot_that_has_just_landed_may_settle(memory):
    footing, feet = Footing(ROBOT.leg_names, memory, CONFIG, DT), memory.cut("senses", "unposed_feet")
    look(footing, 0.5)
    contact = memory.cut("senses", "contact")
    contact[2] = False
    look(footing, 0.1)
    contact[2] = True
    feet[2, 0] += 0.02
    assert look(footing, 1.0) == []


def test_a_contact_in_mid_swing_is_a_stumble_and_a_late_one_is_not(memory):
    footing = Footing(ROBOT.leg_names, memory, CONFIG, DT)
    mode, phase, contact = memory.cut("feet", "mode"), memory.cut("gait", "leg_phase"), memory.cut("senses", "contact")
    for progress, expected in ((0.1, []), (0.35, ["leg AL stumbles"]), (0.4, []), (0.8, [])):
        mode[5], contact[5], phase[5] = SWING, True, 0.5 * progress
        assert look(footing, EVERY * DT) == expected
    mode[5] = STAND
    look(footing, EVERY * DT)
    mode[5], phase[5] = SWING, 0.5 * 0.35  # the next swing
    assert look(footing, EVERY * DT) == ["leg AL stumbles"]


def walk(world, height, seconds):
    from robot_agent.body import JointTargets
    from sim_agent.body import SimulatedBody
    from sim_agent.worlds import make_world

    body, walker, events = SimulatedBody(ROBOT, make_world(world, 1), 1), Walker(ROBOT), []
    limit = np.tile([ROBOT.servos[joint.servo].stall_torque for joint in ROBOT.joints], 6)
    parameters = GaitParameters(
        stamp_ns=0, virtual_stiffness=1500.0, stride_frequency=0.8, stride_height=height, confidence=1.0
    )
    for tick in range(round(seconds / DT)):
        stamp_ns = body.wait_next()
        sensed, truth = body.read(), body.truth()
        if tick == 0:
            walker.reset(sensed.joint_position)
        out = walker.step(
            WalkInput(
                stamp_ns=stamp_ns,
                velocity=np.array([0.15, 0.0, 0.0]) if tick > 350 else np.zeros(3),
                parameters=parameters,
                gait="tripod",
                stand=True,
                joint_position=sensed.joint_position,
                joint_torque=sensed.joint_torque,
                foot_contact=sensed.foot_contact,
                gravity_in_body=-Pose.of(truth.position_in_world, truth.wxyz).rotation[2],
            )
        )
        events += out.events
        body.write(JointTargets(stamp_ns=stamp_ns, position=out.joint_position, torque_limit=limit, torque_on=True))
    body.close()
    return events


def test_in_physics_feet_stumble_over_stairs_and_not_on_flat_ground():
    pytest.importorskip("pybullet")
    assert walk("flat", 0.06, 8.0) == []
    assert any(event.endswith("stumbles") for event in walk("stairs", 0.03, 14.0))
