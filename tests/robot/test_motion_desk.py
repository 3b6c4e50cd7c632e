"""What an operator asks of body and legs is clamped to what may be asked, or refused with what is valid."""

import pytest

from robot_agent.adaptation import ParameterOverrides
from robot_agent.commands import CommandDesk, Situation
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Answer, Command, CommandName, Waypoint
from weaver_shared.robots import load_robot


class Operator:
    """In control of a desk of a standing robot."""

    def __init__(self) -> None:
        self.clock = SimulatedClock(1_000_000_000)
        self.desk = CommandDesk(robot=load_robot(), overrides=ParameterOverrides(), wall_clock_ns=self.clock.now_ns)
        self.sequence = self.epoch = 0
        self.see("STAND")
        self.epoch = self.says(CommandName.TAKE_CONTROL).lease_epoch

    def see(self, mode: str, lift_margins: tuple[float, ...] = ()) -> None:
        self.desk.observe(
            Situation(
                stamp_ns=0,
                robot_xy=(0.0, 0.0),
                mode=mode,
                settled=mode in ("OFF", "READY"),
                stand_blockers=(),
                lift_margins=lift_margins,
            )
        )

    def says(self, command: CommandName, **fields: object) -> Answer:
        self.sequence += 1
        return self.desk.answer(
            Command(command=command, operator="ada", lease_epoch=self.epoch, sequence=self.sequence, **fields)
        )


@pytest.fixture
def ada() -> Operator:
    return Operator()


def test_a_pose_is_kept_axis_by_axis_and_clamped(ada: Operator) -> None:
    assert ada.says(CommandName.SET_POSE, name="roll", value=0.1).applied_value == 0.1
    assert ada.says(CommandName.SET_POSE, name="z", value=9.0).applied_value == 0.05
    assert ada.desk.orders().posing.manual == (0.0, 0.0, 0.05, 0.1, 0.0, 0.0)
    assert ada.says(CommandName.CLEAR_POSE, name="roll").accepted
    assert ada.desk.orders().posing.manual == (0.0, 0.0, 0.05, 0.0, 0.0, 0.0)
    assert ada.says(CommandName.CLEAR_POSE).accepted
    assert ada.desk.orders().posing.idle


@pytest.mark.parametrize(
    ("command", "fields", "words"),
    [
        (CommandName.SET_POSE, {"name": "up", "value": 0.1}, "known are x, y, z, roll, pitch, yaw"),
        (CommandName.SET_POSE, {"name": "x", "value": float("nan")}, "not a number"),
        (CommandName.CLEAR_POSE, {"name": "up"}, "known are x, y, z"),
        (CommandName.SET_POSING, {"name": "sway", "value": 1.0}, "known are automatic, levelling"),
        (CommandName.SET_POSING, {"name": "levelling", "value": 0.5}, "1 for on or 0 for off"),
    ],
)
def test_what_makes_no_sense_is_refused_and_nothing_changes(
    ada: Operator, command: CommandName, fields: dict[str, object], words: str
) -> None:
    before = ada.desk.orders().posing
    answer = ada.says(command, **fields)
    assert not answer.accepted
    assert words in answer.reason
    assert ada.desk.orders().posing == before


def test_automatic_posing_and_levelling_are_switched(ada: Operator) -> None:
    assert ada.says(CommandName.SET_POSING, name="levelling", value=1.0).accepted
    assert ada.desk.orders().posing.levelling
    assert ada.says(CommandName.SET_POSING, name="levelling", value=0.0).accepted
    assert ada.desk.orders().posing.idle


def test_start_up_and_packing_are_chosen(ada: Operator) -> None:
    assert not ada.desk.orders().in_sequence
    assert ada.says(CommandName.SET_START_UP, name="sequence").accepted
    assert ada.desk.orders().in_sequence
    assert "known are direct, sequence" in ada.says(CommandName.SET_START_UP, name="jump").reason
    assert ada.says(CommandName.SIT, name="pack").accepted
    assert ada.desk.orders().pack
    assert "pack or none" in ada.says(CommandName.SIT, name="lie").reason
    assert ada.says(CommandName.SIT).accepted
    assert not ada.desk.orders().pack


def test_legs_are_taken_in_hand_moved_and_given_back(ada: Operator) -> None:
    assert "only while the robot stands" in ada.says(CommandName.LIFT_LEG, name="AR").reason
    ada.see("STAND", (0.1, 0.1, 0.1, 0.1, 0.1, 0.001))
    assert ada.says(CommandName.LIFT_LEG, name="AR").applied_value == 0.1
    assert "0.1 cm of stability would be left" in ada.says(CommandName.LIFT_LEG, name="AL").reason
    assert ada.says(CommandName.LIFT_LEG, name="BL").accepted
    assert "at most 2 legs" in ada.says(CommandName.LIFT_LEG, name="CR").reason
    assert ada.says(CommandName.MOVE_TIP, name="AR.z", value=9.0).applied_value == 0.15
    assert ada.says(CommandName.MOVE_JOINT, name="BL_femur", value=-9.0).applied_value == -1.75
    first, second = ada.desk.orders().legs
    assert (first.leg, first.tip) == (0, (0.0, 0.0, 0.15))
    assert second.joints is not None
    assert second.joints[2] == -1.75
    ada.says(CommandName.SET_MISSION, waypoints=(Waypoint(x=1.0, y=0.0),))
    assert "lower them before walking" in ada.says(CommandName.START_MISSION).reason
    assert ada.says(CommandName.LOWER_LEG, name="AR").accepted
    assert [order.leg for order in ada.desk.orders().legs] == [4]
    ada.says(CommandName.STOP)
    assert ada.desk.orders().legs == ()


@pytest.mark.parametrize(
    ("command", "fields", "words"),
    [
        (CommandName.LIFT_LEG, {"name": "XX"}, "known are AR, BR"),
        (CommandName.LOWER_LEG, {"name": "BR"}, "not lifted"),
        (CommandName.MOVE_TIP, {"name": "BR.x"}, "not lifted"),
        (CommandName.MOVE_TIP, {"name": "AR.up"}, "known are x, y, z"),
        (CommandName.MOVE_TIP, {"name": "AR.x", "value": float("nan")}, "not a number"),
        (CommandName.MOVE_JOINT, {"name": "AR_wrist"}, "known are AR_yaw"),
    ],
)
def test_what_makes_no_sense_of_a_leg_is_refused(
    ada: Operator, command: CommandName, fields: dict[str, object], words: str
) -> None:
    ada.see("STAND", (0.1,) * 6)
    ada.says(CommandName.LIFT_LEG, name="AR")
    assert words in ada.says(command, **fields).reason
