"""Control handed over by request and grant."""

from __future__ import annotations

from typing import Any

import pytest
from running_console import Console, Field, Page
from wire_robot import WireRobot

from weaver_console.handover import ANSWER_WITHIN, Handover
from weaver_shared import topics
from weaver_shared.errors import InputError
from weaver_shared.messages import CommandName, LeaseState


class Desk:
    """An operator's page, without the page."""

    def __init__(self, operator: str, robot: str | None = "weaver") -> None:
        self.operator = operator
        self.robot = robot
        self.told: list[dict[str, Any]] = []
        self.taken: list[tuple[str, str]] = []

    def tell(self, message: dict[str, object]) -> None:
        self.told.append(message)

    def take_granted(self, robot: str, reason: str) -> None:
        self.taken.append((robot, reason))


class Office:
    """Anna has control of a robot; ben and cleo are there too."""

    def __init__(self, field: Field) -> None:
        self.field = field
        self.handover = Handover(field.link)
        self.anna, self.ben, self.cleo = Desk("anna"), Desk("ben"), Desk("cleo")
        for desk in (self.anna, self.ben, self.cleo):
            self.handover.enter(desk)
        self.gives_control_to("anna")

    def gives_control_to(self, holder: str) -> None:
        lease = LeaseState(holder=holder, epoch=1, seconds_left=2.0)
        self.field.bus.publish("weaver", topics.LEASE, lease)

    def later(self, seconds: float) -> None:
        self.field.clock.forward(seconds=seconds)
        self.handover.check()

    @property
    def log(self) -> list[tuple[str, str]]:
        return [(event.source, event.text) for event in self.field.link.events.latest()]


@pytest.fixture
def office(field: Field) -> Office:
    return Office(field)


def test_the_holder_sees_who_asks_and_why(office: Office):
    office.handover.ask(office.ben, "  your lunch\nbreak ")
    (asked,) = office.anna.told
    assert (asked["type"], asked["asker"], asked["reason"]) == ("asked", "ben", "your lunch break")
    assert office.ben.told[0]["state"] == "waiting"
    assert not office.cleo.told
    assert office.log == [("ben", "ben asks anna for control: your lunch break")]


def test_what_is_granted_is_taken_with_that_as_the_reason(office: Office):
    office.handover.ask(office.ben, "")
    office.handover.answer(office.anna, "ben", grant=True)
    assert office.ben.taken == [("weaver", "handed over by anna")]
    assert office.ben.told[-1]["state"] == "granted"
    assert office.anna.told[-1]["type"] == "asked_no_more"
    assert office.log[-1] == ("anna", "anna hands control over to ben")


def test_a_declined_request_takes_nothing(office: Office):
    office.handover.ask(office.ben, "")
    office.handover.answer(office.anna, "ben", grant=False)
    assert not office.ben.taken
    assert office.ben.told[-1]["state"] == "declined"
    office.handover.ask(office.ben, "now?")  # and may ask again


def test_silence_is_answered_with_what_the_asker_can_do(office: Office):
    office.handover.ask(office.ben, "")
    office.later(ANSWER_WITHIN - 0.1)
    assert office.ben.told[-1]["state"] == "waiting"
    office.later(0.2)
    assert office.ben.told[-1]["state"] == "unanswered"
    assert "take control with a reason" in office.ben.told[-1]["text"]
    assert office.anna.told[-1]["type"] == "asked_no_more"
    assert not office.ben.taken
    with pytest.raises(InputError, match="asks for nothing any more"):
        office.handover.answer(office.anna, "ben", grant=True)


def test_who_has_lost_control_hands_nothing_over(office: Office):
    office.handover.ask(office.ben, "")
    office.gives_control_to("cleo")
    with pytest.raises(InputError, match="no control to hand over"):
        office.handover.answer(office.anna, "ben", grant=True)
    office.later(0.1)
    assert office.ben.told[-1]["state"] == "lost"
    assert "cleo has control now" in office.ben.told[-1]["text"]
    assert not office.ben.taken


def test_of_two_who_ask_one_is_served_and_the_other_told(office: Office):
    office.handover.ask(office.ben, "")
    office.handover.ask(office.cleo, "")
    office.handover.answer(office.anna, "cleo", grant=True)
    office.gives_control_to("cleo")
    office.later(0.1)
    assert not office.ben.taken
    assert office.ben.told[-1]["state"] == "lost"


@pytest.mark.parametrize("leaver", ["anna", "ben"])
def test_a_request_ends_when_either_leaves(office: Office, leaver: str):
    office.handover.ask(office.ben, "")
    office.handover.leave(getattr(office, leaver))
    office.later(1.0)
    assert office.ben.told[-1]["state"] == "lost"
    assert office.anna.told[-1]["type"] == "asked_no_more"


def test_nobody_is_asked_in_vain(office: Office):
    with pytest.raises(InputError, match="you have control already"):
        office.handover.ask(office.anna, "")
    office.handover.ask(office.ben, "")
    with pytest.raises(InputError, match="anna has been asked already"):
        office.handover.ask(office.ben, "")
    office.gives_control_to("")
    with pytest.raises(InputError, match="nobody has control; take control"):
        office.handover.ask(office.cleo, "")
    office.gives_control_to("somebody elsewhere")
    with pytest.raises(InputError, match="is not at this console"):
        office.handover.ask(office.cleo, "")
    with pytest.raises(InputError, match="no robot is selected"):
        office.handover.ask(Desk("dora", None), "")


def test_nobody_answers_for_somebody_else(office: Office):
    office.handover.ask(office.ben, "")
    for impostor in (office.ben, office.cleo):
        with pytest.raises(InputError):
            office.handover.answer(impostor, "ben", grant=True)
    assert not office.ben.taken


def test_the_robot_goes_from_hand_to_hand_without_a_gap(console: Console, robot: WireRobot):
    with console.page() as first, console.page(page="page-0002", operator="ben") as second:
        anna, ben = Page(first), Page(second)
        for page in (anna, ben):
            page.select(robot)
        assert anna.command(CommandName.TAKE_CONTROL)["accepted"]
        for _ in range(6):
            robot.step()
        ben.say(type="ask_for_control", reason="my turn")
        assert anna.hear("asked")["asker"] == "ben"
        anna.say(type="answer_request", asker="ben", grant=True)
        assert ben.hear("request", state="granted")["holder"] == "anna"
        assert ben.hear("answer", command="take_control")["accepted"]
        assert robot.holder == "ben"
        assert ben.command(CommandName.STAND)["accepted"]
        assert not anna.command(CommandName.SIT)["accepted"]
    assert CommandName.RELEASE_CONTROL not in [command.command for command in robot.commands[:4]]
    assert robot.commands[1].reason == "handed over by anna"


def test_a_viewer_asks_in_vain(guarded: Console, robot: WireRobot):
    with guarded.page(additional_headers=guarded.log_in("ben")) as socket:
        page = Page(socket)
        page.select(robot)
        page.say(type="ask_for_control")
        assert "viewer" in page.hear("error")["reason"]
