"""How well the walker moves: feet where they belong, nothing moves at rest, stops are quick, forces are answered."""

import numpy as np
import pytest

from robot_agent.locomotion import Walker, WalkInput
from weaver_shared.config.locomotion import AdmittanceConfig
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription, load_robot, robot_names
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.robots.gaits import predefined_gaits

WEAVER = RobotDescription.model_validate(
    load_robot("weaver").model_dump(by_alias=True) | {"gaits": list(predefined_gaits(6))}
)
SERVO_SPEED = "a servo is at its largest speed"


class Ideal:
    """Joints that do as they are told, feet that touch where they are expected, and torques that carry the weight."""

    def __init__(self, robot, *, dt=0.01, gait=None, frequency=0.6, stiffness=1000.0, **settings):
        config = robot.locomotion.model_copy(update={"compensate_servos": False, **settings})
        self.robot, self.dt = robot, dt
        self.walker = Walker(robot, config, dt)
        self.joints = self.walker.begin_standing()
        self.gait = gait or robot.gaits[0]
        self.parameters = GaitParameters(
            stamp_ns=0,
            virtual_stiffness=stiffness,
            stride_frequency=frequency,
            stride_height=robot.locomotion.height_bounds[0],
            confidence=1.0,
        )

    def tick(self, velocity=(0.0, 0.0, 0.0), *, torque=None):
        out = self.walker.step(
            WalkInput(
                stamp_ns=0,
                velocity=np.array(velocity),
                parameters=self.parameters,
                gait=self.gait,
                stand=True,
                joint_position=self.joints,
                joint_torque=np.zeros(self.robot.joint_count) if torque is None else torque,
                foot_contact=np.ones(self.robot.leg_count, dtype=bool),
                gravity_in_body=np.array([0.0, 0.0, -1.0]),
            )
        )
        self.joints = out.joint_position
        return out


@pytest.mark.parametrize("name", robot_names())
def test_feet_follow_their_paths_to_a_hundredth_of_a_millimetre(name):
    robot = load_robot(name)
    for gait in robot.gaits:
        ideal, worst, moved = Ideal(robot, gait=gait, feel_ground=False), 0.0, 0
        for _ in range(300):
            out = ideal.tick((0.3 * robot.locomotion.largest_speed, 0.0, 0.0))
            if SERVO_SPEED not in out.reasons:
                away = np.linalg.norm(feet_in_body(robot, ideal.joints) - out.foot_in_body, axis=1).max()
                worst, moved = max(worst, away), moved + out.swing.any()
        assert moved > 20
        assert worst < 1e-5


@pytest.mark.parametrize("name", robot_names())
def test_sixty_seconds_of_standing_move_no_joint(name):
    ideal = Ideal(load_robot(name))
    for _ in range(2000):
        ideal.tick()
    start, fastest = ideal.joints, 0.0
    for _ in range(6000):
        before = ideal.joints
        fastest = max(fastest, np.abs(ideal.tick().joint_position - before).max() / ideal.dt)
    assert fastest < 1e-3
    assert np.abs(ideal.joints - start).max() < 1e-3


@pytest.mark.parametrize("gait", sorted(WEAVER.gaits))
@pytest.mark.parametrize("after", [2.0, 2.61])
def test_every_gait_stops_in_half_a_second_and_lands_within_a_swing(gait, after):
    ideal = Ideal(WEAVER, gait=gait, feel_ground=False)
    for _ in range(round(after / ideal.dt)):
        ideal.tick((0.2, 0.05, 0.1))
    swing = WEAVER.gait(gait).swing / ideal.parameters.stride_frequency
    outs = [ideal.tick() for _ in range(round(max(0.5, swing) / ideal.dt) + 5)]
    assert not any(out.velocity.any() for out in outs[50:])
    assert not outs[-1].swing.any()


def torque_for(walker, surplus):
    """Joint torques that hold every leg's own weight, its share of the robot's and `surplus` (legs,) N more."""
    senses, load = walker._state.record["senses"], walker._load
    joints = walker._angles.shape[1]
    legs = range(load.size)
    return np.concatenate(
        [
            senses["own_torque"][leg, :joints] - senses["jacobian"][leg, 2, :joints] * (load[leg] + surplus[leg])
            for leg in legs
        ]
    )


def settled(surplus, *, dt=0.01, seconds=6.0, stiffness=1000.0, **admittance):
    """The feet's moves (legs, 3) that a steady surplus force (legs,) leads to, body held where it is, and their way."""
    config = AdmittanceConfig(**admittance)
    ideal = Ideal(WEAVER, dt=dt, stiffness=stiffness, admittance=config)
    offset, way = ideal.walker._state.cut("load", "offset"), []
    for _ in range(round(seconds / dt)):
        ideal.tick(torque=torque_for(ideal.walker, surplus))
        way.append(offset[:, 0].copy())
    return np.array(way)


def test_a_leg_gives_way_by_force_over_stiffness_and_no_other_moves():
    surplus = np.array([15.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    way = settled(surplus, stiffness=1000.0)
    assert way[-1, 0] == pytest.approx(15.0 / 1000.0, rel=0.01)
    assert np.abs(way[-1, 1:]).max() < 1e-5 * GRAVITY


def test_the_answer_to_a_force_is_the_same_at_50_100_and_200_hertz():
    surplus = np.array([12.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    ways = {rate: settled(surplus, dt=1.0 / rate, seconds=2.0)[:, 0] for rate in (50, 100, 200)}
    for rate, way in ways.items():
        for at in (0.3, 0.6, 1.2, 1.9):
            assert way[round(at * rate) - 1] == pytest.approx(ways[200][round(at * 200) - 1], abs=3e-4)


def test_a_force_within_the_dead_band_moves_nothing():
    surplus = np.array([4.0, 0.0, 0.0, 12.0, 0.0, 0.0])
    way = settled(surplus, dead_band=5.0)
    assert np.abs(way[-1, 0]) < 1e-6
    assert way[-1, 3] == pytest.approx(7.0 / 1000.0, rel=0.02)


def test_legs_beside_a_swinging_one_are_stiffer_and_only_while_it_swings():
    ideal = Ideal(WEAVER, gait="wave", admittance=AdmittanceConfig(neighbour_stiffness=4.0))
    stiffness = ideal.walker._state.cut("load", "stiffness")
    most, others = 0.0, 0.0
    for _ in range(300):
        out = ideal.tick((0.05, 0.0, 0.0))
        near = np.roll(out.swing, 1) | np.roll(out.swing, -1)
        most = max(most, stiffness[near].max(initial=0.0))
        others = max(others, np.abs(stiffness[~near] - 1000.0).max())
    assert most == pytest.approx(4000.0, rel=0.02)
    assert others < 1e-9
