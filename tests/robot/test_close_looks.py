"""A close look is asked for from elsewhere, taken from the next picture, and refused when none comes."""

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor

import pytest

from robot_agent.close_looks import REST_NS, CloseLooks
from robot_agent.perception import CloseLook
from weaver_shared.messages import Answer, Command, CommandName

LOOK = Command(command=CommandName.LOOK_CLOSELY, operator="anna", lease_epoch=0, sequence=1)
SEEN = CloseLook(stamp_ns=5_000_000_000, cells=4000, sigma=0.001, reason="")
LONG = 30.0  # s, never waited for


@pytest.fixture
def workers() -> Iterator[ThreadPoolExecutor]:
    with ThreadPoolExecutor(2) as pool:
        yield pool


def asked(workers: ThreadPoolExecutor, looks: CloseLooks, stamp_ns: int) -> Future[Answer]:
    answer = workers.submit(looks.ask, LOOK)
    while not looks.due(stamp_ns):
        assert not answer.done()
    return answer


def test_nobody_looks_unasked() -> None:
    assert not CloseLooks().due(0)


def test_the_answer_tells_how_many_cells_were_measured(workers: ThreadPoolExecutor) -> None:
    looks = CloseLooks(LONG)
    answer = asked(workers, looks, 0)
    looks.answer(SEEN)
    assert answer.result() == Answer(accepted=True, reason="", applied_value=4000.0)
    assert not looks.due(SEEN.stamp_ns + REST_NS)


def test_a_look_that_measured_nothing_is_a_refusal_with_its_reason(workers: ThreadPoolExecutor) -> None:
    looks = CloseLooks(LONG)
    answer = asked(workers, looks, 0)
    looks.answer(CloseLook(stamp_ns=0, cells=0, sigma=float("nan"), reason="the pose is lost"))
    assert answer.result() == Answer(accepted=False, reason="the pose is lost")


def test_all_who_wait_share_one_look(workers: ThreadPoolExecutor) -> None:
    looks = CloseLooks(LONG)
    answers = [workers.submit(looks.ask, LOOK) for _ in range(2)]
    while looks.waiting < 2:
        assert not any(answer.done() for answer in answers)
    looks.answer(SEEN)
    assert all(answer.result().accepted for answer in answers)


def test_odometry_is_left_pictures_between_two_looks(workers: ThreadPoolExecutor) -> None:
    looks = CloseLooks(LONG)
    asked(workers, looks, 0)
    looks.answer(SEEN)
    second = asked(workers, looks, SEEN.stamp_ns + REST_NS)
    assert not looks.due(SEEN.stamp_ns + REST_NS - 1)
    assert looks.due(0)  # a robot started anew counts from zero
    looks.answer(SEEN)
    assert second.result().accepted


def test_without_a_picture_it_is_refused_and_forgotten() -> None:
    looks = CloseLooks(0.0)
    answer = looks.ask(LOOK)
    assert not answer.accepted
    assert "no picture" in answer.reason
    assert not looks.due(0)


def test_a_look_that_takes_long_is_not_taken_for_silence(workers: ThreadPoolExecutor) -> None:
    looks = CloseLooks(1.0)
    answer = asked(workers, looks, 0).result()
    assert answer.accepted
    assert "still at work" in answer.reason
    looks.answer(SEEN)
    assert looks.waiting == 0


def test_other_commands_are_refused_at_once() -> None:
    stand = Command(command=CommandName.STAND, operator="anna", lease_epoch=0, sequence=1)
    assert "does not know stand" in CloseLooks(LONG).ask(stand).reason
