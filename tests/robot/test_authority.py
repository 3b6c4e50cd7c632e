"""One operator commands; the others hear who it is; silence frees the robot."""

from math import inf

from robot_agent.authority import Authority
from weaver_shared.messages import Command, CommandName

SECOND = 1_000_000_000


def command(operator: str, sequence: int, *, epoch: int = 0, reason: str = "") -> Command:
    return Command(command=CommandName.STAND, operator=operator, lease_epoch=epoch, sequence=sequence, reason=reason)


def test_the_second_operator_is_told_who_holds_the_robot() -> None:
    authority = Authority()
    assert authority.take(command("ada", 1), 0).accepted
    refused = authority.take(command("bob", 1), SECOND)
    assert not refused.accepted
    assert "ada" in refused.reason


def test_a_take_over_with_a_reason_voids_the_old_lease() -> None:
    authority = Authority()
    first = authority.take(command("ada", 1), 0)
    second = authority.take(command("bob", 1, reason="ada left"), 0)
    assert second.accepted
    assert second.lease_epoch > first.lease_epoch
    assert "bob is in control" in authority.refusal(command("ada", 2, epoch=first.lease_epoch), 0)


def test_silence_of_two_seconds_frees_the_lease() -> None:
    authority = Authority()
    epoch = authority.take(command("ada", 1), 0).lease_epoch
    assert authority.refusal(command("ada", 2, epoch=epoch), 2 * SECOND) == ""
    assert authority.silence(3 * SECOND) == 1.0
    assert "nobody is in control" in authority.refusal(command("ada", 3, epoch=epoch), 5 * SECOND)
    assert authority.silence(5 * SECOND) == inf
    assert authority.take(command("bob", 1), 5 * SECOND).accepted


def test_a_replayed_or_old_command_is_refused() -> None:
    authority = Authority()
    epoch = authority.take(command("ada", 5), 0).lease_epoch
    assert authority.refusal(command("ada", 6, epoch=epoch), 0) == ""
    assert "not newer than 6" in authority.refusal(command("ada", 6, epoch=epoch), 0)
    assert "lease 0" in authority.refusal(command("ada", 7, epoch=0), 0)


def test_taking_control_again_keeps_the_epoch() -> None:
    authority = Authority()
    first = authority.take(command("ada", 1), 0)
    again = authority.take(command("ada", 2), SECOND)
    assert again.accepted
    assert again.lease_epoch == first.lease_epoch


def test_releasing_lets_the_next_one_in() -> None:
    authority = Authority()
    authority.take(command("ada", 1), 0)
    authority.release()
    assert authority.seconds_left(0) == 0.0
    assert authority.take(command("bob", 1), 0).accepted
