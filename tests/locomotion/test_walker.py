"""The walker stands up, walks, stops and sits on perfect ground, keeps every limit and survives any reading."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.kinematics import LegModel
from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.soak.robots import random_robot
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body

ROBOT = load_robot("weaver")
MODEL = LegModel.of_robot(ROBOT)
KINEMATIC = LocomotionConfig(feel_ground=False, compensate_servos=False)
DT = 0.01
DOWN = np.array([0.0, 0.0, -1.0])
STOP = (0.0, 0.0, 0.0)


def parameters(frequency=1.0, height=0.05, stiffness=2500.0):
    return GaitParameters(
        stamp_ns=0, virtual_stiffness=stiffness, stride_frequency=frequency, stride_height=height, confidence=1.0
    )


class Ideal:
    """Joints that do as they are told, and feet that touch where the walker expects it."""

    def __init__(self, config=KINEMATIC, *, standing=True):
        self.walker = Walker(ROBOT, config, DT)
        self.joints = self.walker.begin_standing() if standing else np.zeros(30)
        if not standing:
            self.walker.reset(self.joints)

    def tick(self, velocity=STOP, **changes):
        given_values = {
            "stamp_ns": 0,
            "velocity": np.array(velocity, dtype=float),
            "parameters": parameters(),
            "gait": "tripod",
            "stand": True,
            "joint_position": self.joints,
            "joint_torque": np.zeros(30),
            "foot_contact": np.ones(6, dtype=bool),
            "gravity_in_body": DOWN,
        }
        self.out = self.walker.step(WalkInput(**{**given_values, **changes}))
        self.joints = self.out.joint_position
        return self.out

    def run(self, seconds, velocity=STOP, **changes):
        return [self.tick(velocity, **changes) for _ in range(round(seconds / DT))]


def test_it_stands_up_from_anywhere_and_sits_down_again():
    ideal = Ideal(standing=False)
    rates, before = [], ideal.joints
    for out in ideal.run(8.0):
        rates.append(np.abs(out.joint_position - before).max() / DT)
        before = out.joint_position
    assert ideal.out.posture == "standing"
    np.testing.assert_allclose(feet_in_body(ROBOT, ideal.joints), ROBOT.stance_in_body, atol=1e-6)
    assert max(rates) < 1.5
    postures = {out.posture for out in ideal.run(5.0, stand=False)}
    assert postures == {"lowering", "sitting"}
    assert (feet_in_body(ROBOT, ideal.joints)[:, 2] > 0.0).all()


def test_standing_is_at_rest():
    ideal = Ideal()
    start = ideal.joints.copy()
    ideal.run(15.0)
    assert np.abs(ideal.joints - start).max() < 1e-3


@pytest.mark.parametrize("velocity", [(0.2, 0.0, 0.0), (0.0, 0.12, 0.0), (0.0, 0.0, 0.4), (0.1, -0.05, 0.2)])
@pytest.mark.parametrize("gait", ["tripod", "ripple"])
def test_feet_on_the_ground_move_exactly_as_the_body(velocity, gait):
    ideal = Ideal()
    limits = MODEL.limits
    ideal.run(4.0, velocity, gait=gait)
    before, swung = ideal.out, ideal.out.swing
    for out in ideal.run(3.0, velocity, gait=gait):
        standing = ~out.swing & ~swung & ~before.swing
        vx, vy, wz = out.velocity
        turn = np.array([[np.cos(wz * DT), np.sin(wz * DT)], [-np.sin(wz * DT), np.cos(wz * DT)]])
        expected = (before.foot_in_body[standing, :2] - np.array([vx, vy]) * DT) @ turn.T
        np.testing.assert_allclose(out.foot_in_body[standing, :2], expected, atol=2e-6)
        np.testing.assert_allclose(out.foot_in_body[standing, 2], ROBOT.stance_in_body[0, 2], atol=1e-6)
        angles = out.joint_position.reshape(6, 5)
        assert (angles >= limits[:, 0]).all()
        assert (angles <= limits[:, 1]).all()
        before, swung = out, before.swing


def test_the_fastest_walk_keeps_its_stride_and_its_servos():
    ideal = Ideal()
    ideal.run(4.0, (1.0, 0.0, 0.0))
    before, fastest, reach = ideal.joints, 0.0, []
    for out in ideal.run(4.0, (1.0, 0.0, 0.0)):
        fastest = max(fastest, (np.abs(out.joint_position - before).reshape(6, 5) / DT / MODEL.speed_limit).max())
        before = out.joint_position
        reach.append(out.foot_in_body[~out.swing, 0] - ROBOT.stance_in_body[~out.swing, 0])
    assert fastest <= 1.0 + 1e-9
    assert ideal.out.velocity[0] <= KINEMATIC.largest_speed
    assert max(np.abs(r).max() for r in reach) < 0.6 * KINEMATIC.largest_stride


@pytest.mark.parametrize(("frequency", "gait"), [(1.0, "tripod"), (0.3, "tripod"), (0.5, "wave")])
@pytest.mark.parametrize("after", [3.0, 3.37, 3.61])
def test_a_stop_ends_the_motion_in_half_a_second_and_lands_within_one_swing(frequency, gait, after):
    ideal = Ideal()
    ideal.run(after, (0.3, 0.0, 0.1), gait=gait, parameters=parameters(frequency))
    swing_time = (0.44 if gait == "tripod" else 1.0 / 6.0) / frequency
    outs = ideal.run(max(0.5, swing_time) + 0.05, gait=gait, parameters=parameters(frequency))
    assert not any(out.velocity.any() for out in outs[50:])
    assert not outs[-1].swing.any()
    assert outs[-1].posture == "standing"


def test_it_walks_on_after_a_stop_wherever_the_feet_are():
    ideal = Ideal(KINEMATIC.model_copy(update={"spare_servos": False}))
    for pause in (0.3, 0.71, 1.13, 0.05):
        ideal.run(1.7, (0.3, 0.0, 0.0))
        ideal.run(pause)
    outs = ideal.run(4.0, (0.3, 0.0, 0.0))
    strides = [out.foot_in_body[~out.swing, 0] - ROBOT.stance_in_body[~out.swing, 0] for out in outs[200:]]
    assert max(np.abs(s).max() for s in strides) < 0.6 * KINEMATIC.largest_stride
    assert outs[-1].velocity[0] > 0.25


def test_frequency_and_gait_change_while_walking_without_jumps():
    ideal = Ideal()
    ideal.run(3.0, (0.08, 0.0, 0.0))
    feet, largest = ideal.out.foot_in_body, 0.0
    for gait, frequency in (("wave", 0.5), ("ripple", 0.7), ("tripod", 0.3), ("tripod", 1.0)):
        for out in ideal.run(6.0, (0.08, 0.0, 0.0), gait=gait, parameters=parameters(frequency)):
            largest = max(largest, np.linalg.norm(out.foot_in_body - feet, axis=1).max() / DT)
            feet = out.foot_in_body
    assert largest < 1.5
    assert ideal.out.posture == "walking"


def test_the_stability_margin_stays_positive_in_every_gait():
    for gait in ("tripod", "ripple", "amble", "wave"):
        ideal = Ideal()
        outs = ideal.run(8.0, (0.06, 0.0, 0.0), gait=gait)
        assert min(out.stability_margin for out in outs) > 0.02


BAD = st.sampled_from([np.nan, np.inf, -np.inf, 1e12, 0.0])


@settings(max_examples=25)
@given(st.lists(st.tuples(st.sampled_from(["velocity", "joint_position", "joint_torque", "gravity_in_body",
    "frequency", "height", "stiffness"]), BAD, st.integers(0, 29), st.booleans()), min_size=1, max_size=8))  # fmt: skip
def test_no_reading_makes_it_raise_or_answer_anything_but_angles_within_limits(faults):
    ideal = Ideal(LocomotionConfig())
    ideal.run(0.3, (0.2, 0.0, 0.0))
    for field, value, place, stand in faults:
        changes = {}
        if field in ("frequency", "height", "stiffness"):
            changes["parameters"] = parameters(**{field: value})
        else:
            size = 30 if field.startswith("joint") else 3
            array = np.array({"velocity": [0.2, 0, 0], "gravity_in_body": DOWN}.get(field, ideal.joints), dtype=float)
            array[place % size] = value
            changes[field] = array
        for _ in range(10):
            out = ideal.tick(**{"velocity": (0.2, 0.0, 0.0), "stand": stand, **changes})
            angles = out.joint_position.reshape(6, 5)
            assert np.isfinite(angles).all()
            assert (angles >= MODEL.limits[:, 0] - 1e-12).all()
            assert (angles <= MODEL.limits[:, 1] + 1e-12).all()
            assert np.isfinite(out.velocity).all()


def test_the_same_inputs_give_the_same_outputs():
    first, second = Ideal(), Ideal()
    for a, b in zip(first.run(2.0, (0.2, 0.05, 0.1)), second.run(2.0, (0.2, 0.05, 0.1)), strict=True):
        np.testing.assert_array_equal(a.joint_position, b.joint_position)


def test_an_answer_never_changes_after_it_was_given():
    ideal = Ideal()
    out = ideal.run(1.0, (0.2, 0.0, 0.0))[-1]
    names = ("joint_position", "foot_in_body", "foot_force", "phase", "swing", "velocity", "ground_plane", "slipping")
    before = {name: getattr(out, name).copy() for name in names}
    ideal.run(0.5, (0.0, 0.1, 0.2))
    for name, values in before.items():
        np.testing.assert_array_equal(getattr(out, name), values)
        with pytest.raises(ValueError, match="read-only"):
            getattr(out, name)[0] = 0


def test_the_angles_to_begin_standing_with_are_no_view_of_the_walker():
    """With as many joints as the memory has room for, the walker's own array is in one piece."""
    robots = (random_robot(np.random.default_rng(seed), seed) for seed in range(50))
    robot = next(robot for robot in robots if robot.joints_per_leg == 6)
    walker = Walker(robot, KINEMATIC, DT)
    joints = walker.begin_standing()
    before = joints.copy()
    walker.reset(joints + 0.1)
    np.testing.assert_array_equal(joints, before)


def test_a_velocity_that_is_no_number_stops_and_is_said():
    ideal = Ideal()
    ideal.run(2.0, (0.2, 0.0, 0.0))
    outs = ideal.run(1.0, (np.nan, 0.0, 0.0))
    assert not outs[-1].velocity.any()
    assert "the velocity order is not a number" in outs[-1].reasons


def test_a_foot_that_finds_no_ground_reaches_down_and_the_gait_waits():
    ideal = Ideal(LocomotionConfig())
    pit = np.array([False, True, True, True, True, True])
    contact = np.ones(6, dtype=bool)
    lowest, waited = 0.0, False
    for _ in range(600):
        contact = np.where(ideal.out.swing & ~pit, False, True) if hasattr(ideal, "out") else contact
        out = ideal.tick((0.1, 0.0, 0.0), foot_contact=contact)
        lowest = min(lowest, out.foot_in_body[0, 2])
        waited |= "waiting for a foot to find ground" in out.reasons
    assert waited
    assert lowest < ROBOT.stance_in_body[0, 2] - 0.04


def test_an_early_contact_keeps_the_foot_where_it_is():
    ideal = Ideal(LocomotionConfig())
    for _ in range(400):
        early = hasattr(ideal, "out") and ideal.out.swing[0] and ideal.out.phase[0] > 0.33
        swing = ideal.out.swing if hasattr(ideal, "out") else np.zeros(6, dtype=bool)
        contact = ~swing
        contact[0] |= early
        before = ideal.out if hasattr(ideal, "out") else None
        out = ideal.tick((0.1, 0.0, 0.0), foot_contact=contact)
        if early:
            assert not out.swing[0]
            assert out.foot_in_body[0, 2] >= before.foot_in_body[0, 2] - 2e-3
            break
    else:
        pytest.fail("leg 0 never swung")
