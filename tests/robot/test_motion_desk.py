"""What an operator asks of body and legs is clamped to what may be asked, or refused with what is valid."""

import pytest

from robot_agent.adaptation import ParameterOverrides
from robot_agent.commands import CommandDesk, Situation
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Answer, Command, CommandName
from weaver_shared.robots import load_robot


class Operator:
    """In control of a desk of a standing robot."""

    def __init__(self) -> None:
        self.clock = SimulatedClock(1_000_000_000)
        self.desk = CommandDesk(robot=load_robot(), overrides=ParameterOverrides(), wall_clock_ns=self.clock.now_ns)
        self.sequence = self.epoch = 0
        self.see("STAND")
        self.epoch = self.says(CommandName.TAKE_CONTROL).lease_epoch

    def see(self, mode: str) -> None:
        self.desk.observe(
            Situation(stamp_ns=0, robot_xy=(0.0, 0.0), mode=mode, settled=mode in ("OFF", "READY"), stand_blockers=())
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
