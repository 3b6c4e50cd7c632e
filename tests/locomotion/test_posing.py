"""Posing: exact composition, bounded motion, what the legs reach, levelling, and a walk that does not notice it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.kinematics import LegModel
from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.ideal_walk import IdealWalk
from robot_agent.locomotion.posing.automatic import bump, leg_amplitudes, steepest_slope, sway
from robot_agent.locomotion.posing.levelling import step_levelling, tilt_error, tune_levelling
from robot_agent.locomotion.posing.order import PosingOrder, bounded
from robot_agent.locomotion.posing.reach import PoseReach, pose_of
from robot_agent.locomotion.posing.slew import Slew
from robot_agent.locomotion.walk_state import POSING as LAYOUT
from weaver_shared.config.locomotion import AutomaticPose, LevellingConfig, LocomotionConfig, PosingConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.transforms import Pose, rotation_from_rpy, rpy_from_rotation

ROBOT = load_robot("weaver")
GAITS = ROBOT.gait_table
MODEL = LegModel.of_robot(ROBOT)
KINEMATIC = LocomotionConfig(feel_ground=False, compensate_servos=False)
POSING = PosingConfig()
DT = 0.01

values = st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6).map(np.array)


@given(values, values, values)
def test_composition_and_its_inverse_are_exact(first, second, third):
    a, b, c = pose_of(first), pose_of(second), pose_of(third)
    whole = a @ b @ c
    for left in (whole @ whole.inverse(), whole.inverse() @ whole, c.inverse() @ b.inverse() @ a.inverse() @ whole):
        np.testing.assert_allclose(left.matrix, np.eye(4), atol=1e-12)
    points = ROBOT.stance_in_body
    np.testing.assert_allclose(whole.inverse().transform(whole.transform(points)), points, atol=1e-12)
    np.testing.assert_allclose((a.inverse() @ whole).matrix, (b @ c).matrix, atol=1e-12)


orders = st.lists(st.tuples(values, st.integers(1, 60)), min_size=1, max_size=6)


@settings(max_examples=25)
@given(orders)
def test_a_slewed_pose_keeps_rate_acceleration_and_jerk(sequence):
    times = POSING.smoothing
    slew = Slew((POSING.position_rate, POSING.rotation_rate), times, DT)
    track = [slew.value.copy()] * 3
    for wanted, ticks in sequence:
        for _ in range(ticks):
            track.append(slew.step(wanted).copy())
    path = np.array(track)
    for part, rate in ((slice(0, 3), POSING.position_rate), (slice(3, 6), POSING.rotation_rate)):
        speed = np.linalg.norm(np.diff(path[:, part], axis=0), axis=1) / DT
        acceleration = np.linalg.norm(np.diff(path[:, part], 2, axis=0), axis=1) / DT**2
        jerk = np.linalg.norm(np.diff(path[:, part], 3, axis=0), axis=1) / DT**3
        assert speed.max() <= rate * (1 + 1e-9)
        assert acceleration.max() <= 2 * rate / times[0] * (1 + 1e-9)
        assert jerk.max() <= 4 * rate / (times[0] * times[1]) * (1 + 1e-6) + 1e-6


@given(values)
def test_a_slewed_pose_arrives_exactly_and_never_overshoots(wanted):
    slew = Slew((POSING.position_rate, POSING.rotation_rate), POSING.smoothing, DT)
    longest = max(np.linalg.norm(wanted[:3]) / POSING.position_rate, np.linalg.norm(wanted[3:]) / POSING.rotation_rate)
    for _ in range(round((longest + sum(POSING.smoothing)) / DT) + 3):
        value = slew.step(wanted)
        assert (value * np.sign(wanted) <= np.abs(wanted) + 1e-12).all()
    np.testing.assert_array_equal(slew.value, wanted)
    for _ in range(50):
        slew.step(wanted)
    assert slew.at_rest


def test_an_order_that_is_no_number_asks_for_nothing():
    asked = bounded((np.nan, np.inf, 9.0, -9.0, 0.1, 0.0), POSING)
    np.testing.assert_array_equal(asked, [0.0, 0.0, 0.05, -0.25, 0.1, 0.0])


def test_the_bump_begins_and_ends_without_speed_or_acceleration():
    s = np.linspace(0.0, 1.0, 20001)
    height, step = bump(s), s[1]
    assert height.max() == pytest.approx(1.0, abs=1e-9)
    slope = np.diff(height) / step
    for end in (0, -1):
        assert abs(slope[end]) < 1e-6
        assert abs(np.diff(slope)[end] / step) < 0.1  # of 75 in the middle
    assert bump(np.array([-0.5, 1.5])).any() == 0


@given(st.sampled_from(sorted(GAITS)), st.floats(0.05, 5.0), st.floats(0.0, 1.0), st.floats(0.0, 0.3))
def test_the_automatic_pose_never_exceeds_its_rate(name, frequency, phase, ahead):
    gait = GAITS[name]
    amplitude = leg_amplitudes(ROBOT.stance_in_body, AutomaticPose(shift=0.05, lift=0.05, roll=0.2, pitch=0.2))
    rate = np.repeat([POSING.position_rate, POSING.rotation_rate], 3)
    slope = steepest_slope(gait.offsets, gait.swing, ahead, amplitude)
    step = 1e-4

    def pose(at):
        result = np.zeros(6)
        sway((at + gait.offsets) % 1.0, gait.swing, ahead, amplitude, slope, rate, frequency, result)
        return result

    speed = (pose(phase + step * frequency) - pose(phase)) / step
    assert (np.abs(speed) <= rate * 1.01 + 1e-9).all()


def test_the_body_leans_away_from_the_feet_in_the_air():
    amplitude = leg_amplitudes(ROBOT.stance_in_body, AutomaticPose(shift=0.02, roll=0.05, pitch=0.05))
    phases = np.ones(6)
    phases[5] = 0.15  # the front left foot in mid swing
    pose = np.zeros(6)
    sway(phases, 0.3, 0.0, amplitude, np.ones(6), np.full(6, 9.0), 1.0, pose)
    x, y, _, roll, pitch, _ = pose
    assert x < 0.0
    assert y < 0.0
    assert roll > 0.0  # left side up
    assert pitch < 0.0  # nose up


class Levelling:
    """The walker's levelling alone."""

    def __init__(self):
        self.memory = np.zeros(1, LAYOUT)[0]
        tune_levelling(self.memory, LevellingConfig(), DT)

    def step(self, error):
        step_levelling(self.memory, np.asarray(error), DT)
        return self.memory["turn"].copy()


def tilt_of(up):
    error = np.zeros(2)
    tilt_error(np.asarray(up), error)
    return error


@pytest.mark.parametrize("tilt", [(0.1, -0.05), (-0.2, 0.0), (0.0, 0.15)])
def test_levelling_undoes_a_steady_tilt(tilt):
    levelling, turn = Levelling(), np.zeros(2)
    ground = rotation_from_rpy(*tilt, 0.0)
    delay = [np.zeros(2)] * 8  # the legs answer later
    for _ in range(600):
        level = rotation_from_rpy(*delay[0], 0.0)
        up = (ground @ level).T @ [0.0, 0.0, 1.0]
        turn = levelling.step(tilt_of(up))
        delay = [*delay[1:], turn.copy()]
    assert np.degrees(np.abs(tilt_of((ground @ level).T @ [0.0, 0.0, 1.0]))).max() < 0.1


def test_a_levelling_that_was_at_its_limit_lets_go_at_once():
    config = LevellingConfig()
    levelling = Levelling()
    for _ in range(2000):  # far beyond what it may do
        turn = levelling.step(np.array([0.6, 0.0]))
    assert turn[0] == config.largest
    ticks = 0
    while turn[0] >= config.largest and ticks < 1000:
        turn = levelling.step(np.array([-0.05, 0.0]))
        ticks += 1
    assert ticks * DT < 0.1


@given(values)
def test_a_pose_said_to_be_within_reach_is_reached(asked):
    reach = PoseReach(MODEL, ROBOT.stance_in_body, np.zeros(3), 0.02)
    wanted = bounded(tuple(0.5 * asked), POSING)
    for _ in range(10):
        fitted = reach.fit(wanted, 0.0)
    assert reach.within(fitted, 0.0)
    if not reach.shortened:
        np.testing.assert_array_equal(fitted, wanted)
    else:
        assert not reach.within(wanted, 0.0)


class Ideal:
    """Joints that do as they are told, on level ground that never yields."""

    def __init__(self):
        self.walker = Walker(ROBOT, KINEMATIC, DT)
        self.joints = self.walker.begin_standing()
        self.pose = Pose.identity()
        self.ground = np.eye(3)  # gravity's up is z of ground @ unposed
        self.blind = False  # the attitude is unknown

    def tick(self, velocity=(0.0, 0.0, 0.0), *, gait="tripod", stand=True, **order):
        up = (self.ground @ self.pose.rotation).T @ [0.0, 0.0, 1.0]
        self.out = self.walker.step(
            WalkInput(
                stamp_ns=0,
                velocity=np.array(velocity),
                parameters=GaitParameters(
                    stamp_ns=0, virtual_stiffness=2500.0, stride_frequency=1.0, stride_height=0.05, confidence=1.0
                ),
                gait=gait,
                stand=stand,
                joint_position=self.joints,
                joint_torque=np.zeros(30),
                foot_contact=np.ones(6, dtype=bool),
                gravity_in_body=np.full(3, np.nan) if self.blind else -up,
                posing=PosingOrder(**order),
            )
        )
        self.joints, self.pose = self.out.joint_position, self.out.unposed_from_body
        return self.out

    def run(self, seconds, *arguments, **order):
        return [self.tick(*arguments, **order) for _ in range(round(seconds / DT))]


@pytest.mark.parametrize(
    "manual",
    [(0.03, -0.02, 0.02, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.12, -0.1, 0.0), (0.02, 0.01, -0.02, 0.05, 0.05, 0.15)],
)
def test_a_posed_robot_stands_with_its_feet_where_they_were(manual):
    ideal = Ideal()
    ideal.run(4.0, manual=manual)
    expected = pose_of(np.array(manual)).inverse().transform(ROBOT.stance_in_body)
    np.testing.assert_allclose(feet_in_body(ROBOT, ideal.joints), expected, atol=1e-5)
    np.testing.assert_allclose(ideal.pose.position, manual[:3], atol=1e-12)
    np.testing.assert_allclose(rpy_from_rotation(ideal.pose.rotation), manual[3:], atol=1e-12)
    ideal.run(4.0)
    np.testing.assert_allclose(feet_in_body(ROBOT, ideal.joints), ROBOT.stance_in_body, atol=1e-5)


def test_an_order_beyond_the_legs_is_cut_short_and_said():
    ideal = Ideal()
    outs = ideal.run(4.0, manual=(0.06, 0.06, 0.05, 0.25, 0.25, 0.3))
    assert "the legs reach no further for the pose" in outs[-1].reasons
    assert (np.abs(ideal.pose.position) > 0.005).all()  # but as far as it goes
    places = ideal.pose.transform(feet_in_body(ROBOT, ideal.joints))
    np.testing.assert_allclose(places, ROBOT.stance_in_body, atol=1e-4)


def test_posing_does_not_change_the_walk_over_the_ground():
    plain, posed = Ideal(), Ideal()
    for order in ({"manual": (0.01, 0.0, 0.01, 0.04, -0.03, 0.05)}, {"automatic": True}):
        for _ in range(500):
            one, two = plain.tick((0.12, 0.02, 0.1)), posed.tick((0.12, 0.02, 0.1), **order)
            np.testing.assert_allclose(two.velocity, one.velocity, atol=1e-9)
            np.testing.assert_array_equal(two.swing, one.swing)
            over_ground = two.unposed_from_body.transform(two.foot_in_body)
            np.testing.assert_allclose(over_ground, one.foot_in_body, atol=2e-4)
        assert (
            np.abs(np.r_[two.unposed_from_body.position, rpy_from_rotation(two.unposed_from_body.rotation)]).max() > 0
        )


def test_the_automatic_pose_comes_with_the_walk_and_goes_with_it():
    ideal = Ideal()
    ideal.run(1.0, automatic=True)
    np.testing.assert_array_equal(ideal.pose.matrix, np.eye(4))
    rolls = [
        rpy_from_rotation(out.unposed_from_body.rotation)[0] for out in ideal.run(4.0, (0.1, 0.0, 0.0), automatic=True)
    ]
    assert max(rolls[200:]) == pytest.approx(0.015, rel=0.15)
    assert min(rolls[200:]) == pytest.approx(-0.015, rel=0.15)
    ideal.run(3.0, automatic=True)
    np.testing.assert_allclose(ideal.pose.matrix, np.eye(4), atol=1e-12)


@pytest.mark.parametrize("velocity", [(0.03, 0.0, 0.0), (0.0, 0.03, 0.0), (0.0, -0.03, 0.0), (0.0, 0.0, 0.08)])
def test_a_robot_on_four_feet_leans_before_it_lifts_one(velocity):
    robot = load_robot("magneto")
    config = robot.locomotion.model_copy(update={"spare_servos": False})
    tick = IdealWalk(robot, config, velocity=np.array(velocity), frequency=0.5).replay(1000)
    outs = [tick() for _ in range(1000)]
    assert min(out.stability_margin for out in outs) > 0.005
    np.testing.assert_allclose(
        np.mean([out.velocity for out in outs[400:]], axis=0), velocity, atol=0.05 * max(velocity)
    )
    swings = np.array([out.swing for out in outs])
    assert swings.any(axis=0).all()
    assert swings.sum(axis=1).max() == 1


def test_a_walk_taken_up_again_before_the_body_is_upright_does_not_throw_it():
    robot = load_robot("magneto")
    walker = Walker(robot, robot.locomotion.model_copy(update={"feel_ground": False, "compensate_servos": False}), DT)
    joints, before, fastest, margins = walker.begin_standing(), None, 0.0, []
    for tick in range(900):
        moving = not 400 <= tick < 700 or tick % 100 > 60
        out = walker.step(
            WalkInput(
                stamp_ns=0,
                velocity=np.array([0.03, 0.0, 0.0]) * moving,
                parameters=GaitParameters(
                    stamp_ns=0, virtual_stiffness=1000.0, stride_frequency=0.5, stride_height=0.03, confidence=1.0
                ),
                gait="wave",
                stand=True,
                joint_position=joints,
                joint_torque=np.zeros_like(joints),
                foot_contact=np.ones(4, dtype=np.bool_),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
            )
        )
        joints, place = out.joint_position, out.unposed_from_body.position
        fastest = max(fastest, 0.0 if before is None else float(np.linalg.norm(place - before)) / DT)
        before = place
        margins.append(out.stability_margin)
    assert fastest < 0.3
    assert min(margins) > 0.005


def test_levelling_makes_the_body_level_on_a_slope_that_posture_would_follow():
    ideal = Ideal()
    ideal.ground = rotation_from_rpy(0.0, -0.12, 0.0)
    ideal.run(8.0, levelling=True)
    up = (ideal.ground @ ideal.pose.rotation).T @ [0.0, 0.0, 1.0]
    assert np.degrees(np.hypot(up[0], up[1])) < 0.5


def test_levelling_keeps_its_answer_while_the_attitude_is_unknown():
    ideal = Ideal()
    ideal.run(8.0, levelling=True)
    ideal.ground = rotation_from_rpy(0.0, -0.12, 0.0)
    ideal.run(0.3, levelling=True)  # on its way to level
    ideal.blind = True
    ideal.run(1.0, levelling=True)  # the slew comes to its end
    held = ideal.pose.matrix.copy()
    for out in ideal.run(2.0, levelling=True):
        np.testing.assert_allclose(out.unposed_from_body.matrix, held, atol=1e-4)
    assert "the direction of gravity is missing" in ideal.out.reasons
    up = (ideal.ground @ ideal.pose.rotation).T @ [0.0, 0.0, 1.0]
    assert np.degrees(np.hypot(up[0], up[1])) > 1.0
    ideal.blind, before, fastest = False, ideal.pose.rotation, 0.0
    for out in ideal.run(8.0, levelling=True):
        after = out.unposed_from_body.rotation
        fastest = max(fastest, float(np.linalg.norm(after - before)) / DT)
        before = after
    assert fastest < 0.5
    up = (ideal.ground @ ideal.pose.rotation).T @ [0.0, 0.0, 1.0]
    assert np.degrees(np.hypot(up[0], up[1])) < 0.5


def test_sitting_down_ends_the_pose():
    ideal = Ideal()
    ideal.run(2.0, manual=(0.0, 0.0, 0.02, 0.1, 0.0, 0.0))
    before, fastest = ideal.joints, 0.0
    for out in ideal.run(6.0, stand=False, manual=(0.0, 0.0, 0.02, 0.1, 0.0, 0.0)):
        fastest = max(fastest, np.abs(out.joint_position - before).max() / DT)
        before = out.joint_position
    assert out.posture == "sitting"
    assert fastest < 1.5
    np.testing.assert_array_equal(ideal.pose.matrix, np.eye(4))
