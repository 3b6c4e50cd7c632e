"""Walkspaces lie within reach, do not overlap, and no velocity in any direction takes a foot out of its own."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_agent.kinematics import LegModel
from robot_agent.kinematics.inverse import solve_leg
from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.feet import STAND
from robot_agent.locomotion.posing.order import PosingOrder
from robot_agent.locomotion.walk_state import BEARINGS
from robot_agent.locomotion.walkspace import radius_towards, velocity_scale
from robot_agent.locomotion.walkspace_renewal import STALE
from robot_agent.locomotion.workspace import LIMIT_MARGIN, REACHED, length_of_ray
from weaver_shared.config.locomotion import LocomotionConfig
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot

ROBOT = load_robot("weaver")
DT = 0.01


def walker_of(robot=ROBOT, **changes):
    config = robot.locomotion.model_copy(update={"feel_ground": False, "compensate_servos": False, **changes})
    return Walker(robot, config, DT)


def model_of(robot=ROBOT):
    return LegModel.of_robot(robot)


def radius_of(walker):
    return walker._state.cut("model", "radius")


@pytest.mark.parametrize("name", ["weaver", "default", "octopod", "bullet_a_insectoid"])
def test_the_leg_reaches_the_whole_edge_on_every_height(name):
    robot = load_robot(name)
    model, walker = model_of(robot), walker_of(robot)
    limits, radius = model.limits_less(LIMIT_MARGIN), radius_of(walker)
    down, joints = np.array([0.0, 0.0, -1.0]), np.zeros(model.joints_per_leg)
    for leg in range(robot.leg_count):
        for degrees in range(0, 360, 5):
            along = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0])
            for height in walker._state.record["model"]["layers"]:
                far = radius_towards(radius[leg], along[0], along[1])
                guess = model.standing.copy()
                for share in (0.25, 0.5, 0.75, 1.0):
                    foot = robot.stance_in_body[leg] + share * far * along + [0.0, 0.0, height]
                    left = solve_leg(
                        model.dh, limits, model.closed_form, model.hips[leg], model.hip_axes[leg], foot, down, guess,
                        joints,
                    )  # fmt: skip
                    guess[:] = joints
                assert left <= 0.01 * far + REACHED * model.reach
                assert (joints >= limits[:, 0] - 1e-9).all()
                assert (joints <= limits[:, 1] + 1e-9).all()


@pytest.mark.parametrize("name", ["weaver", "default", "octopod"])
def test_walkspaces_of_neighbours_do_not_overlap_and_strides_fit_both_ways(name):
    robot = load_robot(name)
    radius, stance = radius_of(walker_of(robot)), robot.stance_in_body[:, :2]
    np.testing.assert_allclose(radius, np.roll(radius, radius.shape[1] // 2, axis=1))
    angles = 2.0 * np.pi * np.arange(radius.shape[1]) / radius.shape[1]
    edge = stance[:, None] + radius[..., None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    for leg in range(robot.leg_count):
        away = np.linalg.norm(edge[leg][:, None] - stance, axis=-1)
        assert (away.argmin(axis=1) == leg).all() or (away[:, leg] <= away.min(axis=1) + 1e-9).all()


def allowed(walker, robot, direction, turn, duty, frequency):
    """Speed, m/s, allowed in a direction (rad) with `turn` rad/s for each m/s."""
    velocity = 10.0 * np.array([np.cos(direction), np.sin(direction), turn])
    legs = robot.leg_count
    none = np.zeros(legs)
    return 10.0 * velocity_scale(
        velocity, robot.stance_in_body, radius_of(walker), none, duty, frequency, 0.5
    ), velocity


@settings(max_examples=30, deadline=None)
@given(st.floats(0.0, 2.0 * np.pi), st.floats(-4.0, 4.0), st.sampled_from(["tripod", "wave"]), st.floats(0.2, 1.2))
def test_no_stride_leaves_its_walkspace_in_any_mix_of_direction_and_turn(direction, turn, gait, frequency):
    walker, duty = WALKER, ROBOT.gait(gait).duty
    speed, velocity = allowed(walker, ROBOT, direction, turn, duty, frequency)
    worst = 0.0
    for leg, (x, y, _) in enumerate(ROBOT.stance_in_body):
        half = 0.5 * duty / frequency * 0.1 * speed * (velocity[:2] + velocity[2] * np.array([-y, x]))
        worst = max(worst, np.hypot(*half) / min(radius_towards(radius_of(walker)[leg], *half), 0.25))
    assert worst <= 1.01
    assert worst >= 0.99 or speed == 10.0


@pytest.mark.parametrize("turn", [-2.0, 0.0, 0.5, 3.0])
def test_the_limit_has_no_jumps_over_all_directions(turn):
    directions = np.radians(np.arange(0.0, 360.25, 0.25))
    speeds = np.array([allowed(WALKER, ROBOT, d, turn, 0.5, 1.0)[0] for d in directions])
    assert np.abs(np.diff(speeds)).max() < 0.01 * speeds.mean()
    assert speeds[0] == pytest.approx(speeds[-1])


WALKER = walker_of()


def excursions(walker, robot, orders, gait, seconds):
    """Of every tick: the farthest standing foot from its stance, in radii."""
    joints, feet = walker.begin_standing(), walker._state
    place, stance, mode = feet.cut("feet", "place"), feet.cut("feet", "stance"), feet.cut("feet", "mode")
    for tick in range(round(seconds / DT)):
        velocity, frequency = orders(tick * DT)
        sensed = WalkInput(
            stamp_ns=0,
            velocity=np.array(velocity, dtype=float),
            parameters=GaitParameters(
                stamp_ns=0, virtual_stiffness=2000.0, stride_frequency=frequency, stride_height=0.04, confidence=1.0
            ),
            gait=gait,
            stand=True,
            joint_position=joints,
            joint_torque=np.zeros_like(joints),
            foot_contact=np.ones(robot.leg_count, dtype=np.bool_),
            gravity_in_body=np.array([0.0, 0.0, -1.0]),
        )
        joints = walker.step(sensed).joint_position
        away = (place - stance)[:, :2]
        edge = [radius_towards(radius_of(walker)[leg], *away[leg]) for leg in range(robot.leg_count)]
        yield (np.hypot(*away.T) / edge)[mode == STAND].max(initial=0.0)


@pytest.mark.parametrize("gait", ["tripod", "ripple", "wave"])
@pytest.mark.parametrize("direction", [0.0, 1.0, 2.3])
def test_a_walk_at_full_speed_keeps_every_foot_in_its_walkspace_from_the_first_step(gait, direction):
    velocity = np.array([np.cos(direction), np.sin(direction), 0.6 * np.sin(3.0 * direction)])
    walker = walker_of(spare_servos=False)
    assert max(excursions(walker, ROBOT, lambda _: (velocity, 0.6), gait, 8.0)) < 1.01
    assert np.hypot(*walker._walked[:2]) > 0.05


@pytest.mark.parametrize("seed", [3, 4, 5])
def test_orders_that_change_mid_stride_keep_every_foot_in_its_walkspace(seed):
    rng = np.random.default_rng(seed)
    changes = [(rng.uniform(-0.4, 0.4, 3), rng.uniform(0.4, 1.2)) for _ in range(20)]
    walker = walker_of(spare_servos=False)
    worst = max(excursions(walker, ROBOT, lambda t: changes[int(t / 1.3) % 20], "tripod", 26.0))
    assert 0.8 < worst < 1.01


@pytest.mark.parametrize("name", ["weaver", "default", "bullet_insectoid"])
def test_walkspaces_follow_the_body_into_a_pose(name):
    robot = load_robot(name)
    model, walker = model_of(robot), walker_of(robot)
    space, pose = walker._state.record["space"], walker._state.record["orders"]
    before, stale = walker._state.cut("space", "reach").copy(), STALE * model.reach
    joints, ticks = walker.begin_standing(), 0
    order = PosingOrder(manual=(0.12 * model.reach, 0.05 * model.reach, -0.05 * model.reach, 0.05, 0.0, 0.0))
    while ticks < 200 or space["leg"] >= 0 or walker._state.cut("space", "moved").max() > stale:
        joints, ticks = walker.step(standing(robot, joints, order)).joint_position, ticks + 1
        assert ticks < 5000
    differs = 0.0
    for leg in range(robot.leg_count):
        for layer, height in enumerate(walker._state.record["model"]["layers"]):
            for bearing in range(0, BEARINGS, 5):
                angle = 2.0 * np.pi * bearing / BEARINGS
                turn = pose["posing_rotation"]
                afresh = length_of_ray(
                    model.dh, model.limits_less(LIMIT_MARGIN), model.closed_form, model.hips[leg], model.hip_axes[leg],
                    (robot.stance_in_body[leg] - pose["posing_position"]) @ turn + turn[2] * height,
                    turn[0] * np.cos(angle) + turn[1] * np.sin(angle),
                    float(walker._state.record["model"]["farthest"]), model.standing,
                )  # fmt: skip
                assert abs(space["reach"][leg, layer, bearing] - afresh) < 3.0 * stale
                differs = max(differs, abs(before[leg, layer, bearing] - afresh))
    assert differs > 3.0 * stale


def standing(robot, joints, posing):
    return WalkInput(
        stamp_ns=0,
        velocity=np.zeros(3),
        parameters=GaitParameters(
            stamp_ns=0, virtual_stiffness=2000.0, stride_frequency=0.5, stride_height=0.04, confidence=1.0
        ),
        gait=robot.gaits[0],
        stand=True,
        joint_position=joints,
        joint_torque=np.zeros_like(joints),
        foot_contact=np.ones(robot.leg_count, dtype=np.bool_),
        gravity_in_body=np.array([0.0, 0.0, -1.0]),
        posing=posing,
    )


def test_a_foot_is_lifted_no_higher_than_its_leg_can():
    robot = load_robot("max")
    walker = walker_of(robot)
    room = walker._state.cut("model", "headroom")
    assert (room < robot.locomotion.height_bounds[1]).all()
    joints, highest = walker.begin_standing(), 0.0
    for _ in range(1200):
        sensed = WalkInput(
            stamp_ns=0,
            velocity=np.array([0.1, 0.0, 0.0]),
            parameters=GaitParameters(
                stamp_ns=0, virtual_stiffness=2000.0, stride_frequency=0.3, stride_height=1.0, confidence=1.0
            ),
            gait="tripod",
            stand=True,
            joint_position=joints,
            joint_torque=np.zeros_like(joints),
            foot_contact=np.ones(robot.leg_count, dtype=np.bool_),
            gravity_in_body=np.array([0.0, 0.0, -1.0]),
        )
        joints = walker.step(sensed).joint_position
        highest = max(highest, (walker._places - robot.stance_in_body)[:, 2].max())
    assert highest == pytest.approx(room.min(), abs=2e-3)


def test_the_settings_default_to_walkspaces_apart():
    assert not LocomotionConfig().overlapping_walkspaces
