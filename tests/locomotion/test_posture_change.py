"""A standing robot moves itself into its other posture and goes on walking there."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from robot_agent.body import JointTargets
from robot_agent.limits import JointGate
from robot_agent.locomotion import Postures, WalkInput, WalkOutput
from robot_agent.locomotion.posture_order import NO_POSTURE_ORDER, PostureOrder
from robot_agent.locomotion.posture_plan import plan_change
from robot_agent.motion_desk import MotionDesk
from sim_agent.body import SimulatedBody
from sim_agent.worlds import make_world
from weaver_shared.errors import InputError
from weaver_shared.messages import Command, CommandName, GaitParameters
from weaver_shared.robots import load_robot
from weaver_shared.robots.counterpart import counterpart_of
from weaver_shared.robots.forward_kinematics import feet_in_body

DT = 0.01
DOWN = np.array([0.0, 0.0, -1.0])
OTHER = {"insectoid": "mammalian", "mammalian": "insectoid"}
ROBOTS = [f"bullet_{a}_{p}" for a in "ab" for p in OTHER]
PARAMETERS = GaitParameters(
    stamp_ns=0, virtual_stiffness=1000.0, stride_frequency=0.5, stride_height=0.1, confidence=1.0
)


class Legs:
    """The walker's legs obeyed at once: a foot touches where it is no higher than the lowest, within a millimetre."""

    def __init__(self, name: str) -> None:
        self.robot = load_robot(name)
        self.walker = Postures(self.robot, DT)
        self.joints = self.walker.begin_standing().copy()
        self.order = NO_POSTURE_ORDER
        self.out: WalkOutput | None = None

    @property
    def feet(self) -> np.ndarray:
        return feet_in_body(self.robot, self.joints)

    def tick(self, *, stand: bool = True, forward: float = 0.0) -> WalkOutput:
        heights = self.feet[:, 2]
        self.out = self.walker.step(
            WalkInput(
                stamp_ns=0,
                velocity=np.array([forward, 0.0, 0.0]),
                parameters=PARAMETERS,
                gait="tripod",
                stand=stand,
                joint_position=self.joints,
                joint_torque=np.zeros(self.joints.size),
                foot_contact=heights < np.median(np.sort(heights)[:4]) + 1e-3,
                gravity_in_body=DOWN,
                posture_order=self.order,
            )
        )
        self.joints = self.out.joint_position.copy()
        return self.out

    def change(self) -> None:
        self.order = PostureOrder(name=OTHER[self.walker.name], serial=self.order.serial + 1)

    def until(self, posture: str, *, stand: bool = True, ticks: int = 6000) -> int:
        for count in range(ticks):
            if self.tick(stand=stand).posture == posture:
                return count
        raise AssertionError(f"not {posture} after {ticks} ticks but {self.out and self.out.posture}")


@pytest.mark.parametrize("name", ROBOTS)
def test_every_leg_ends_in_the_other_postures_stance_one_after_the_other(name: str) -> None:
    legs = Legs(name)
    other = counterpart_of(legs.robot)
    assert other is not None
    lower, upper = np.tile(legs.robot.joint_limits, (legs.robot.leg_count, 1)).T
    before = legs.tick().joint_position.copy()
    fastest = max(servo.no_load_speed for servo in legs.robot.servos.values())
    legs.change()
    most_in_air = 0
    for _ in range(6000):
        out = legs.tick()
        most_in_air = max(most_in_air, int(out.swing.sum()))
        assert np.isfinite(out.joint_position).all()
        assert (out.joint_position >= lower - 1e-9).all()
        assert (out.joint_position <= upper + 1e-9).all()
        assert np.abs(out.joint_position - before).max() <= fastest * DT + 1e-9
        before = out.joint_position.copy()
        if out.posture == "standing":
            break
    assert most_in_air == 1
    assert legs.walker.name == other.posture.name  # type: ignore[union-attr]
    feet = out.foot_in_body  # as wanted: the targets lead the servos by the sag under a weight that is not here
    np.testing.assert_allclose(feet[:, :2], other.stance_in_body[:, :2], atol=0.01)
    assert feet[:, 2].mean() == pytest.approx(other.stance_in_body[0, 2], abs=0.01)


def test_told_to_sit_on_the_way_it_sits_and_goes_on_when_told_to_stand() -> None:
    legs = Legs("bullet_a_insectoid")
    legs.tick()
    legs.change()
    legs.until("changing")
    for _ in range(800):
        legs.tick()
    ticks = legs.until("sitting", stand=False)
    assert ticks < 1000  # the leg in the air is put down first
    belly = legs.robot.sitting_in_body[0, 2]
    assert legs.feet[:, 2].max() > belly - 0.1
    still = legs.joints.copy()
    for _ in range(50):
        legs.tick(stand=False)
    np.testing.assert_allclose(legs.joints, still, atol=1e-3)
    legs.until("standing")
    assert legs.walker.name == "mammalian"


def test_an_order_while_walking_is_dropped() -> None:
    legs = Legs("bullet_b_insectoid")
    legs.tick()
    for _ in range(100):
        legs.tick(forward=0.1)
    assert legs.tick(forward=0.1).change_refusal == "the posture is changed only while the robot stands still"
    legs.change()
    for _ in range(100):
        assert legs.tick(forward=0.1).posture == "walking"
    legs.until("standing")
    for _ in range(100):
        assert legs.tick().posture == "standing"


def test_a_lost_reset_ends_the_change_without_a_jump() -> None:
    """Torque goes off in the middle: the legs are taken as they are, in whichever posture each of them is."""
    legs = Legs("bullet_a_insectoid")
    legs.tick()
    legs.change()
    for _ in range(900):
        legs.tick()
    before = legs.joints.copy()
    legs.walker.reset(before)
    out = legs.tick(stand=False)
    assert out.posture == "sitting"
    np.testing.assert_allclose(out.joint_position, before, atol=1e-9)


def test_the_plan_keeps_off_the_ground_and_within_the_limits() -> None:
    for name in ROBOTS:
        here = load_robot(name)
        there = counterpart_of(here)
        assert there is not None
        plan = plan_change(here, there)
        assert sorted(plan.order) == list(range(6))
        for angles, robot in ((plan.lifted, here), (plan.turned, there)):
            assert (angles >= robot.walking_limits[:, 0] - 1e-9).all()
            assert (angles <= robot.walking_limits[:, 1] + 1e-9).all()
            np.testing.assert_allclose(feet_in_body(here, angles)[:, 2], plan.height + plan.lift, atol=2e-3)


def command(name: str) -> Command:
    return Command(command=CommandName.CHANGE_POSTURE, operator="o", lease_epoch=1, sequence=1, name=name)


def test_the_desk_says_why_a_posture_is_not_changed() -> None:
    desk = MotionDesk(load_robot("bullet_a_insectoid"))
    desk.change_posture(command("mammalian"), "")
    assert desk.posture == PostureOrder(name="mammalian", serial=1)
    with pytest.raises(InputError, match="posture 'avian' is unknown; known are insectoid, mammalian"):
        desk.change_posture(command("avian"), "")
    with pytest.raises(InputError, match="the robot walks"):
        desk.change_posture(command("insectoid"), "the robot walks")
    assert desk.posture.serial == 1
    with pytest.raises(InputError, match="robot weaver has one posture only"):
        MotionDesk(load_robot("weaver")).change_posture(command("mammalian"), "")


class Standing:
    """A simulated robot in the hands of its walker alone."""

    def __init__(self, name: str) -> None:
        self.robot = load_robot(name)
        self.body = SimulatedBody(self.robot, make_world("flat", 1), 1)
        self.walker = Postures(self.robot, DT)
        self.gate = JointGate(self.robot)
        self.order = NO_POSTURE_ORDER
        self.body.wait_next()
        self.walker.reset(self.body.read().joint_position)
        self.largest_tilt = 0.0
        self.belly_touched = False

    def tick(self, forward: float = 0.0) -> WalkOutput:
        stamp_ns = self.body.wait_next()
        sensed = self.body.read()
        pose = self.body.scene_state().world_from_body
        self.largest_tilt = max(self.largest_tilt, float(np.arccos(min(pose.rotation[2, 2], 1.0))))
        self.belly_touched |= bool(np.abs(self.body.contact_forces()[1]).max() > 0.0)
        out = self.walker.step(
            WalkInput(
                stamp_ns=stamp_ns,
                velocity=np.array([forward, 0.0, 0.0]),
                parameters=PARAMETERS,
                gait="tripod",
                stand=True,
                joint_position=sensed.joint_position,
                joint_torque=sensed.joint_torque,
                foot_contact=sensed.foot_contact,
                gravity_in_body=pose.rotation.T @ DOWN,
                posture_order=self.order,
            )
        )
        torque = np.full(self.robot.joint_count, 10.0)
        targets = JointTargets(stamp_ns=stamp_ns, position=out.joint_position, torque_limit=torque, torque_on=True)
        self.body.write(self.gate.pass_on(targets, sensed.joint_position, DT))
        return out

    def until(self, reached: Callable[[WalkOutput], bool]) -> None:
        for _ in range(6000):
            if reached(self.tick()):
                return
        raise AssertionError("it did not come to an end")


@pytest.fixture
def simulated(request: pytest.FixtureRequest) -> Iterator[Standing]:
    robot = Standing(request.param)
    yield robot
    robot.body.close()


@pytest.mark.walk
@pytest.mark.parametrize("simulated", ["bullet_a_insectoid", "bullet_b_mammalian"], indirect=True)
def test_it_changes_its_posture_there_and_back_and_walks_in_both(simulated: Standing) -> None:
    simulated.until(lambda out: out.posture == "standing")
    simulated.belly_touched, simulated.largest_tilt = False, 0.0
    for serial in (1, 2):
        name = OTHER[simulated.walker.name]
        simulated.order = PostureOrder(name=name, serial=serial)
        simulated.until(lambda out, name=name: out.posture == "standing" and out.leg_posture == name)  # type: ignore[misc]
        begin = simulated.body.scene_state().position_in_world
        for _ in range(300):
            simulated.tick(forward=0.1)
        assert simulated.body.scene_state().position_in_world[0] > begin[0] + 0.15
        simulated.until(lambda out: out.posture == "standing")
    assert not simulated.belly_touched
    assert np.degrees(simulated.largest_tilt) < 4.0
    clearance = simulated.robot.clearance
    assert simulated.body.scene_state().position_in_world[2] == pytest.approx(clearance, abs=0.02)
