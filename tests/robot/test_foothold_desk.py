"""Footholds are taken from the holder of control alone, judged against the legs' reach, and forgotten in time."""

import numpy as np
import pytest

from robot_agent.adaptation import ParameterOverrides
from robot_agent.commands import CommandDesk, Situation
from robot_agent.locomotion.leg_reach import LegReach
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Answer, Command, CommandName, Waypoint
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose, rotation_z

ROBOT = load_robot("weaver")
STANCE = ROBOT.stance_in_body
REACH = LegReach(
    stance_in_body=STANCE, radius=np.full((6, 36), 0.1), moved=np.zeros(6), lowest=STANCE[0, 2] - 0.1, highest=0.1
)
BODY = Pose(rotation=rotation_z(0.7), position=np.array([3.0, -1.0, 0.2]))


class Operator:
    def __init__(self) -> None:
        self.clock = SimulatedClock(1_000_000_000)
        self.desk = CommandDesk(robot=ROBOT, overrides=ParameterOverrides(), wall_clock_ns=self.clock.now_ns)
        self.sequence = self.epoch = self.robot_ns = 0
        self.see()
        self.epoch = self.says(CommandName.TAKE_CONTROL).lease_epoch

    def see(self, seconds: float = 0.0, mode: str = "WALK", pose: Pose | None = BODY) -> None:
        self.robot_ns += round(seconds * 1e9)
        self.desk.observe(
            Situation(
                stamp_ns=self.robot_ns,
                robot_xy=(0.0, 0.0),
                mode=mode,
                settled=False,
                stand_blockers=(),
                leg_reach=REACH,
                world_from_body=pose,
            )
        )

    def says(self, command: CommandName, **fields: object) -> Answer:
        self.sequence += 1
        return self.desk.answer(
            Command(command=command, operator="ada", lease_epoch=self.epoch, sequence=self.sequence, **fields)
        )

    def places(self, leg: str, frame: str, place: np.ndarray, **fields: object) -> Answer:
        x, y, z = place.tolist()
        return self.says(
            CommandName.PLACE_FOOT, name=f"{leg}.{frame}", waypoints=(Waypoint(x=x, y=y),), value=z, **fields
        )


@pytest.fixture
def ada() -> Operator:
    return Operator()


def test_a_foothold_within_reach_waits_for_its_swing_and_expires(ada: Operator) -> None:
    reply = ada.places("BR", "body", STANCE[1] + [0.03, 0.04, 0.0], seconds=2.0)
    assert reply.accepted
    assert reply.applied_value == pytest.approx(0.05)
    (order,) = ada.desk.orders().footholds
    assert (order.leg, order.in_world) == (1, False)
    ada.see(1.9)
    assert ada.desk.orders().footholds
    ada.see(0.2)
    assert not ada.desk.orders().footholds


def test_every_order_has_its_own_serial_and_a_leg_its_last_one(ada: Operator) -> None:
    ada.places("BR", "body", STANCE[1])
    (first,) = ada.desk.orders().footholds
    ada.places("BR", "body", STANCE[1] + [0.02, 0.0, 0.0])
    ada.places("AL", "body", STANCE[5])
    orders = {order.leg: order for order in ada.desk.orders().footholds}
    assert set(orders) == {1, 5}
    assert orders[1].serial != first.serial


def test_a_place_in_the_world_is_judged_from_where_the_robot_stands(ada: Operator) -> None:
    near = BODY.transform(STANCE[1] + [0.05, 0.0, 0.0])
    assert ada.places("BR", "world", near).accepted
    far = BODY.transform(STANCE[1] + [0.9, 0.0, 0.0])
    assert "90.0 cm from the stance of leg BR" in ada.places("BR", "world", far).reason
    ada.see(pose=None)
    assert "does not know yet where it stands" in ada.places("BR", "world", near).reason


@pytest.mark.parametrize(
    ("name", "offset", "fields", "reason"),
    [
        ("BR.body", (0.0, -0.2, 0.0), {}, "walks up to 10.0 cm"),
        ("BR.body", (0.0, 0.0, -0.3), {}, "are within reach"),
        ("XX.body", (0.0, 0.0, 0.0), {}, "known are"),
        ("BR.map", (0.0, 0.0, 0.0), {}, "known are world, body"),
        ("BR", (0.0, 0.0, 0.0), {}, "known are world, body"),
        ("BR.body", (float("nan"), 0.0, 0.0), {}, "not all numbers"),
        ("BR.body", (0.0, 0.0, 0.0), {"seconds": 100.0}, "up to 30 s"),
    ],
)
def test_what_can_not_be_is_refused_with_a_reason(ada: Operator, name, offset, fields, reason) -> None:
    x, y, z = (STANCE[1] + offset).tolist()
    reply = ada.says(CommandName.PLACE_FOOT, name=name, waypoints=(Waypoint(x=x, y=y),), value=z, **fields)
    assert not reply.accepted
    assert reason in reply.reason
    assert not ada.desk.orders().footholds


def test_a_foothold_is_one_waypoint(ada: Operator) -> None:
    assert (
        "one waypoint for x and y, and a value for z; 0 came" in ada.says(CommandName.PLACE_FOOT, name="BR.body").reason
    )


def test_sitting_and_stopping_and_releasing_forget_footholds(ada: Operator) -> None:
    for command in (CommandName.SIT, CommandName.RELEASE_CONTROL, CommandName.STOP):
        ada = Operator()
        assert ada.places("BR", "body", STANCE[1]).accepted
        ada.says(command)
        assert not ada.desk.orders().footholds


def test_a_robot_that_sits_places_no_foot(ada: Operator) -> None:
    ada.see(mode="SIT")
    assert "must stand" in ada.places("BR", "body", STANCE[1]).reason
    assert CommandName.PLACE_FOOT not in ada.desk.allowed()
    ada.see(mode="WALK")
    assert CommandName.PLACE_FOOT in ada.desk.allowed()
