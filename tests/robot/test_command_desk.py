"""The desk carries out what is valid, refuses the rest in words, and lets anyone stop the robot."""

from math import inf, nan

import numpy as np
import pytest

from robot_agent.adaptation import ParameterOverrides
from robot_agent.commands import CommandDesk, Situation
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Answer, Command, CommandName, MapTile, TeleopFrame, Waypoint
from weaver_shared.robots import load_robot


class Operator:
    def __init__(self, desk: CommandDesk, name: str) -> None:
        self.desk = desk
        self.name = name
        self.epoch = 0
        self.sequence = 0

    def says(self, command: CommandName, **fields: object) -> Answer:
        self.sequence += 1
        request = Command(command=command, operator=self.name, lease_epoch=self.epoch, sequence=self.sequence, **fields)
        answer = self.desk.answer(request)
        self.epoch = answer.lease_epoch
        return answer

    def steers(self, forward: float, *, dead_man: bool = True) -> None:
        self.sequence += 1
        self.desk.teleoperate(
            TeleopFrame(
                operator=self.name,
                lease_epoch=self.epoch,
                sequence=self.sequence,
                dead_man=dead_man,
                forward=forward,
                left=0.0,
                turn=0.0,
            )
        )


@pytest.fixture
def clock() -> SimulatedClock:
    return SimulatedClock(1_000_000_000)


@pytest.fixture
def desk(clock: SimulatedClock) -> CommandDesk:
    desk = CommandDesk(robot=load_robot(), overrides=ParameterOverrides(), wall_clock_ns=clock.now_ns)
    observe(desk)
    return desk


@pytest.fixture
def ada(desk: CommandDesk) -> Operator:
    ada = Operator(desk, "ada")
    assert ada.says(CommandName.TAKE_CONTROL).accepted
    return ada


def observe(
    desk: CommandDesk,
    mode: str = "STAND",
    blockers: tuple[str, ...] = (),
    robot_xy: tuple[float, float] = (1.0, 0.0),
) -> None:
    settled = mode in ("OFF", "READY")
    desk.observe(Situation(stamp_ns=0, robot_xy=robot_xy, mode=mode, settled=settled, stand_blockers=blockers))


def test_nothing_moves_without_control(desk: CommandDesk) -> None:
    answer = Operator(desk, "bob").says(CommandName.STAND)
    assert not answer.accepted
    assert "take control first" in answer.reason
    assert not desk.orders().stand


def test_anyone_may_stop_and_only_the_holder_may_release(desk: CommandDesk, ada: Operator) -> None:
    ada.says(CommandName.STAND)
    assert Operator(desk, "bob").says(CommandName.STOP).accepted
    assert desk.orders().stop_level == "settle"
    assert not desk.orders().stand
    observe(desk, "ESTOP")
    assert not Operator(desk, "bob").says(CommandName.RELEASE_STOP).accepted
    assert "still settling" in ada.says(CommandName.RELEASE_STOP).reason
    observe(desk, "READY")
    assert ada.says(CommandName.RELEASE_STOP).accepted
    assert desk.orders().stop_level == ""
    assert not desk.orders().stand


def test_a_stop_can_be_made_harder_but_not_softer(desk: CommandDesk, ada: Operator) -> None:
    ada.says(CommandName.STOP, name="cut")
    ada.says(CommandName.STOP)
    assert desk.orders().stop_level == "cut"


def test_a_stopped_robot_refuses_to_stand_or_start(desk: CommandDesk, ada: Operator) -> None:
    ada.says(CommandName.SET_MISSION, waypoints=(Waypoint(x=1.0, y=0.0),))
    ada.says(CommandName.STOP)
    assert "release the stop" in ada.says(CommandName.STAND).reason
    assert "release the stop" in ada.says(CommandName.START_MISSION).reason


def test_what_keeps_the_robot_down_is_the_answer(desk: CommandDesk, ada: Operator) -> None:
    observe(desk, "OFF", ("the battery is at 22.0 V",))
    answer = ada.says(CommandName.STAND)
    assert (answer.accepted, answer.reason) == (False, "the battery is at 22.0 V")


@pytest.mark.parametrize(
    ("waypoint", "words"),
    [
        (Waypoint(x=nan, y=0.0), "waypoint 1 is not a place"),
        (Waypoint(x=0.0, y=inf), "waypoint 1 is not a place"),
        (Waypoint(x=1e6, y=0.0), "from the robot"),
    ],
)
def test_a_waypoint_that_is_no_place_is_refused_and_the_mission_kept(
    desk: CommandDesk, ada: Operator, waypoint: Waypoint, words: str
) -> None:
    good = (Waypoint(x=2.0, y=0.0),)
    assert ada.says(CommandName.SET_MISSION, waypoints=good).applied_value == 1.0
    answer = ada.says(CommandName.SET_MISSION, waypoints=(waypoint,))
    assert not answer.accepted
    assert words in answer.reason
    assert desk.mission(0).waypoints == good


def test_a_mission_starts_standing_pauses_and_goes_on(desk: CommandDesk, ada: Operator) -> None:
    assert "add one first" in ada.says(CommandName.START_MISSION).reason
    ada.says(CommandName.SET_MISSION, waypoints=(Waypoint(x=2.0, y=0.0),))
    observe(desk, "READY")
    assert "must stand" in ada.says(CommandName.START_MISSION).reason
    observe(desk, "STAND")
    assert ada.says(CommandName.START_MISSION).accepted
    serial = desk.orders().mission_serial
    ada.says(CommandName.PAUSE_MISSION)
    assert not desk.orders().mission_active
    ada.says(CommandName.START_MISSION)
    assert desk.orders().mission_active
    assert desk.orders().mission_serial == serial


def test_losing_the_operator_pauses_the_mission(desk: CommandDesk, ada: Operator, clock: SimulatedClock) -> None:
    ada.says(CommandName.SET_MISSION, waypoints=(Waypoint(x=2.0, y=0.0),))
    ada.says(CommandName.START_MISSION)
    clock.forward(seconds=1.9)
    assert desk.orders().mission_active
    clock.forward(seconds=0.2)
    assert not desk.orders().mission_active
    assert desk.mission(0).phase == "paused"


def test_appending_a_waypoint_under_way_does_not_start_over(desk: CommandDesk, ada: Operator) -> None:
    first, second = Waypoint(x=2.0, y=0.0), Waypoint(x=3.0, y=0.0)
    ada.says(CommandName.SET_MISSION, waypoints=(first,))
    ada.says(CommandName.START_MISSION)
    serial = desk.orders().mission_serial
    ada.says(CommandName.SET_MISSION, waypoints=(first, second))
    assert desk.orders().mission_active
    assert desk.orders().mission_serial == serial


def test_a_waypoint_is_skipped_and_the_way_back_is_walked(desk: CommandDesk, ada: Operator) -> None:
    first, second = Waypoint(x=2.0, y=0.0), Waypoint(x=3.0, y=0.0)
    assert "no mission is under way" in ada.says(CommandName.SKIP_WAYPOINT).reason
    ada.says(CommandName.SET_MISSION, waypoints=(first, second))
    ada.says(CommandName.START_MISSION)
    before = desk.orders().mission_serial
    assert ada.says(CommandName.SKIP_WAYPOINT).applied_value == 2.0
    assert desk.orders().waypoints == (second,)
    assert "at the start already" in ada.says(CommandName.RETURN_TO_START).reason
    progress(desk, before, index=1)  # of the mission as it was before: comes too late
    assert desk.mission(0).next_waypoint == 1
    progress(desk, desk.orders().mission_serial, index=1)
    observe(desk, "STAND", robot_xy=(3.0, 0.0))
    assert ada.says(CommandName.RETURN_TO_START).applied_value == 2.0
    assert desk.orders().waypoints == (second, Waypoint(x=1.0, y=0.0))
    observe(desk, "SIT", robot_xy=(3.0, 0.0))
    assert "must stand" in ada.says(CommandName.RETURN_TO_START).reason


def wall_at(desk: CommandDesk, x: float) -> None:
    """Level ground with a wall of 0.5 m across it, in the map of the desk."""
    size, cell = 32, 0.02
    none = np.full((size, size), 255, dtype=np.uint8)
    for i in range(8):
        for j in range(-2, 2):
            along = (i * size + np.arange(size) + 0.5) * cell
            height = np.where((along > x) & (along < x + 0.2), 500, 0).astype(np.int16)
            elevation, sigma = np.repeat(height[:, None], size, axis=1), np.full((size, size), 3, dtype=np.uint8)
            desk.ground.put(
                MapTile(stamp_ns=0, i=i, j=j, size=size, cell=cell, elevation_mm=elevation, sigma_mm=sigma,
                        roughness=none, step_height=none, age_s=none)
            )  # fmt: skip


def test_a_way_over_a_wall_is_refused_whichever_command_would_lead_there(desk: CommandDesk, ada: Operator) -> None:
    before, aside, behind = Waypoint(x=2.0, y=0.0), Waypoint(x=2.0, y=0.1), Waypoint(x=4.0, y=0.0)
    wall_at(desk, 3.0)
    ada.says(CommandName.SET_MISSION, waypoints=(before, behind))
    answer = ada.says(CommandName.START_MISSION)
    assert not answer.accepted
    assert "the way to waypoint 2 leads over a step of 0.50 m" in answer.reason
    assert desk.mission(0).phase == "ready"
    ada.says(CommandName.SET_MISSION, waypoints=(before, behind), name="auto")
    assert ada.says(CommandName.START_MISSION).accepted  # it finds its own way
    ada.says(CommandName.SET_MISSION, waypoints=(before, aside))
    assert ada.says(CommandName.START_MISSION) == Answer(accepted=True, reason="", lease_epoch=1)
    assert "waypoint 3" in ada.says(CommandName.SET_MISSION, waypoints=(before, aside, behind)).reason
    assert desk.orders().waypoints == (before, aside)


def test_unknown_ground_on_the_way_is_said(desk: CommandDesk, ada: Operator) -> None:
    ada.says(CommandName.SET_MISSION, waypoints=(Waypoint(x=4.0, y=0.0),))
    answer = ada.says(CommandName.START_MISSION)
    assert answer.accepted
    assert "the map does not know" in answer.reason
    assert "the map does not know" in desk.take_events()[-1].text


def progress(desk: CommandDesk, serial: int, index: int) -> None:
    desk.mission_progress(
        serial=serial, index=index, cross_track_error=0.0, distance_left=1.0, lookahead=np.zeros(2), done=False
    )


def test_the_stick_falls_silent_after_three_tenths_of_a_second(
    desk: CommandDesk, ada: Operator, clock: SimulatedClock
) -> None:
    ada.steers(1.0)
    velocity = desk.orders().teleop_velocity
    assert velocity is not None
    assert velocity[0] > 0.0
    clock.forward(seconds=0.31)
    assert desk.orders().teleop_velocity is None


def test_a_released_dead_man_a_stranger_and_a_broken_stick_do_not_steer(desk: CommandDesk, ada: Operator) -> None:
    Operator(desk, "bob").steers(1.0)
    assert desk.orders().teleop_velocity is None
    ada.steers(nan)
    assert desk.orders().teleop_velocity is None
    ada.steers(1.0)
    ada.steers(1.0, dead_man=False)
    assert desk.orders().teleop_velocity is None


def test_an_override_outside_its_range_is_refused_with_the_range(ada: Operator) -> None:
    answer = ada.says(CommandName.SET_OVERRIDE, name="stride_height", value=0.5)
    assert not answer.accepted
    assert "0.05 to 0.14 m" in answer.reason
    assert "unknown" in ada.says(CommandName.SET_OVERRIDE, name="colour", value=1.0).reason
    assert "unknown" in ada.says(CommandName.CLEAR_OVERRIDE, name="colour").reason
    assert "lasts" in ada.says(CommandName.SET_OVERRIDE, name="stride_height", value=0.1, seconds=-1.0).reason
    assert ada.says(CommandName.SET_OVERRIDE, name="stride_height", value=0.1).applied_value == 0.1


def test_a_preset_is_chosen_by_its_name(ada: Operator) -> None:
    assert ada.says(CommandName.SET_PRESET, name="careful").accepted
    assert "known are usual" in ada.says(CommandName.SET_PRESET, name="reckless").reason


def test_the_ground_is_judged_as_the_holder_says(desk: CommandDesk, ada: Operator) -> None:
    assert desk.perception(5).mode == "robust"
    assert ada.says(CommandName.SET_PERCEPTION, name="paper").accepted
    assert desk.perception(5).mode == "paper"
    assert "known are robust, paper" in ada.says(CommandName.SET_PERCEPTION, name="rosy").reason
    assert not Operator(desk, "bob").says(CommandName.SET_PERCEPTION, name="robust").accepted
    assert desk.perception(5).mode == "paper"


def test_a_robot_without_cameras_has_no_perception_to_choose(clock: SimulatedClock) -> None:
    desk = CommandDesk(robot=load_robot("max"), overrides=ParameterOverrides(), wall_clock_ns=clock.now_ns)
    observe(desk)
    ada = Operator(desk, "ada")
    ada.says(CommandName.TAKE_CONTROL)
    assert "has no cameras" in ada.says(CommandName.SET_PERCEPTION, name="paper").reason
    assert CommandName.SET_PERCEPTION not in desk.allowed()


def test_an_unknown_gait_is_refused_with_the_known_ones(desk: CommandDesk, ada: Operator) -> None:
    assert "tripod" in ada.says(CommandName.SET_GAIT, name="gallop").reason
    assert ada.says(CommandName.SET_GAIT, name="wave").accepted
    assert desk.orders().gait == "wave"


def test_every_command_but_the_heartbeat_is_in_the_log(desk: CommandDesk, ada: Operator) -> None:
    desk.take_events()
    ada.says(CommandName.RETAIN_CONTROL)
    ada.says(CommandName.STAND)
    Operator(desk, "bob").says(CommandName.SIT)
    texts = [f"{event.source}: {event.text}" for event in desk.take_events()]
    assert texts == ["ada: stand", "bob: sit: refused, ada is in control"]
    assert desk.take_events() == []


def test_the_allowed_commands_are_the_ones_that_get_accepted(desk: CommandDesk, ada: Operator) -> None:
    observe(desk, "READY")
    assert "stand" in desk.allowed()
    observe(desk, "READY", ("no",))
    assert "stand" not in desk.allowed()
    observe(desk, "STAND")
    assert {"sit"} <= set(desk.allowed())
    assert "start_mission" not in desk.allowed()
    observe(desk, "FAULT")
    assert "sit" in desk.allowed()  # the only way out of it
    assert "stand" not in desk.allowed()
    observe(desk, "STAND")
    ada.says(CommandName.SET_MISSION, waypoints=(Waypoint(x=2.0, y=0.0),))
    assert "start_mission" in desk.allowed()
    ada.says(CommandName.START_MISSION)
    assert {"pause_mission", "clear_mission", "skip_waypoint", "return_to_start"} <= set(desk.allowed())
    ada.says(CommandName.STOP)
    assert "release_stop" not in desk.allowed()
    observe(desk, "READY")
    assert "release_stop" in desk.allowed()


def test_the_posture_of_the_legs_is_changed_only_while_the_robot_stands(clock: SimulatedClock) -> None:
    desk = CommandDesk(
        robot=load_robot("bullet_a_insectoid"), overrides=ParameterOverrides(), wall_clock_ns=clock.now_ns
    )
    ada = Operator(desk, "ada")
    ada.says(CommandName.TAKE_CONTROL)

    def is_in(mode: str, refusal: str) -> None:
        desk.observe(
            Situation(
                stamp_ns=0, robot_xy=(0.0, 0.0), mode=mode, settled=False, stand_blockers=(), change_refusal=refusal
            )
        )

    is_in("WALK", "")
    assert "it is in WALK" in ada.says(CommandName.CHANGE_POSTURE, name="mammalian").reason
    assert CommandName.CHANGE_POSTURE not in desk.allowed()
    is_in("STAND", "the ground is not level enough")
    assert ada.says(CommandName.CHANGE_POSTURE, name="mammalian").reason == "the ground is not level enough"
    assert desk.orders().posture.serial == 0
    is_in("STAND", "")
    assert CommandName.CHANGE_POSTURE in desk.allowed()
    assert ada.says(CommandName.CHANGE_POSTURE, name="mammalian").accepted
    assert desk.orders().posture.name == "mammalian"
    assert desk.orders().posture.serial == 1
