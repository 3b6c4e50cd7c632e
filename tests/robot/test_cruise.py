"""Cruise control holds what it was given, no longer than it was given for, and yields to everything else."""

import numpy as np
import pytest

from robot_agent.adaptation import ParameterOverrides
from robot_agent.commands import CommandDesk, Situation
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Answer, Command, CommandName, TeleopFrame, Waypoint
from weaver_shared.robots import load_robot


class Operator:
    def __init__(self) -> None:
        self.clock = SimulatedClock(1_000_000_000)
        self.desk = CommandDesk(robot=load_robot(), overrides=ParameterOverrides(), wall_clock_ns=self.clock.now_ns)
        self.sequence = self.epoch = self.robot_ns = 0
        self.see()
        self.epoch = self.says(CommandName.TAKE_CONTROL).lease_epoch

    def see(self, seconds: float = 0.0, mode: str = "STAND") -> None:
        """The robot reports after so many seconds of its own clock."""
        self.robot_ns += round(seconds * 1e9)
        self.desk.observe(
            Situation(stamp_ns=self.robot_ns, robot_xy=(0.0, 0.0), mode=mode, settled=False, stand_blockers=())
        )

    def says(self, command: CommandName, **fields: object) -> Answer:
        self.sequence += 1
        return self.desk.answer(
            Command(command=command, operator="ada", lease_epoch=self.epoch, sequence=self.sequence, **fields)
        )

    def steers(self, forward: float, *, dead_man: bool = True) -> None:
        self.sequence += 1
        frame = TeleopFrame(
            operator="ada", lease_epoch=self.epoch, sequence=self.sequence, dead_man=dead_man, forward=forward,
            left=0.0, turn=0.0,
        )  # fmt: skip
        self.desk.teleoperate(frame)

    @property
    def velocity(self) -> np.ndarray | None:
        return self.desk.orders().teleop_velocity


@pytest.fixture
def ada() -> Operator:
    return Operator()


def test_a_velocity_is_held_for_its_time_on_the_robots_clock(ada: Operator) -> None:
    assert ada.says(CommandName.START_CRUISE, name="forward", value=0.1, seconds=5.0).applied_value == 0.1
    assert ada.says(CommandName.START_CRUISE, name="turn", value=9.0, seconds=5.0).applied_value == 0.5
    np.testing.assert_allclose(ada.velocity, [0.1, 0.0, 0.5])
    ada.see(4.9, "WALK")
    assert ada.velocity is not None
    ada.see(0.2, "WALK")
    assert ada.velocity is None


def test_what_the_stick_asks_is_kept_when_it_is_let_go(ada: Operator) -> None:
    assert "not held" in ada.says(CommandName.START_CRUISE, name="stick").reason
    ada.steers(0.5)
    held = ada.velocity
    assert ada.says(CommandName.START_CRUISE, name="stick").accepted
    ada.steers(0.0, dead_man=False)
    np.testing.assert_allclose(ada.velocity, held)
    ada.steers(0.0)  # a hand on the stick again
    np.testing.assert_allclose(ada.velocity, np.zeros(3))
    ada.steers(0.0, dead_man=False)
    assert ada.velocity is None


@pytest.mark.parametrize("command", [CommandName.STOP_CRUISE, CommandName.STOP, CommandName.SIT,
                                     CommandName.RELEASE_CONTROL])  # fmt: skip
def test_it_ends_when_told(ada: Operator, command: CommandName) -> None:
    ada.says(CommandName.START_CRUISE, name="forward", value=0.1)
    assert ada.says(command).accepted
    assert ada.velocity is None


def test_it_ends_with_the_lease(ada: Operator) -> None:
    ada.says(CommandName.START_CRUISE, name="forward", value=0.1)
    ada.clock.forward(seconds=2.1)
    assert ada.velocity is None


def test_a_mission_and_a_cruise_exclude_each_other(ada: Operator) -> None:
    ada.says(CommandName.SET_MISSION, waypoints=(Waypoint(x=1.0, y=0.0),))
    ada.says(CommandName.START_CRUISE, name="forward", value=0.1)
    assert ada.says(CommandName.START_MISSION).accepted
    assert ada.velocity is None
    assert "pause it first" in ada.says(CommandName.START_CRUISE, name="forward", value=0.1).reason


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"name": "up", "value": 0.1}, "known are forward, left, turn, stick"),
        ({"name": "forward", "value": float("nan")}, "not a number"),
        ({"name": "forward", "value": 0.1, "seconds": -1.0}, "above 0 and up to 600 s"),
        ({"name": "forward", "value": 0.1, "seconds": float("inf")}, "above 0 and up to 600 s"),
    ],
)
def test_what_makes_no_sense_is_refused(ada: Operator, fields: dict[str, object], words: str) -> None:
    assert words in ada.says(CommandName.START_CRUISE, **fields).reason
    assert ada.velocity is None


def test_a_sitting_robot_does_not_cruise(ada: Operator) -> None:
    ada.see(0.1, "READY")
    assert "must stand" in ada.says(CommandName.START_CRUISE, name="forward", value=0.1).reason


def test_everybody_is_told_what_body_and_legs_are_asked(ada: Operator) -> None:
    ada.says(CommandName.SET_POSE, name="z", value=0.02)
    ada.says(CommandName.SET_POSING, name="levelling", value=1.0)
    ada.says(CommandName.START_CRUISE, name="forward", value=0.1, seconds=5.0)
    ada.see(2.0)
    told = ada.desk.motion()
    np.testing.assert_allclose(told.pose, [0.0, 0.0, 0.02, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(told.cruise_velocity, [0.1, 0.0, 0.0])
    assert told.cruise_seconds_left == pytest.approx(3.0)
    assert (told.levelling, told.automatic_posing, told.in_sequence, told.held_legs) == (True, False, False, ())
    assert told.held_tips.shape == (0, 3)
    ada.see(4.0)
    assert ada.desk.motion().cruise_seconds_left == 0.0
    assert not ada.desk.motion().cruise_velocity.any()
