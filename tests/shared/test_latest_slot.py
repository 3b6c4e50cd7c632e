"""A slow reader gets the newest value once, and never slows the writer."""

import threading

from weaver_shared.latest import LatestSlot


def test_the_newest_value_wins_and_is_taken_once() -> None:
    slot: LatestSlot[int] = LatestSlot()
    for value in (1, 2, 3):
        slot.put(value)
    assert slot.take() == 3
    assert slot.take() is None
    assert slot.peek() == 3
    assert slot.overwritten == 2


def test_an_empty_slot_has_nothing() -> None:
    slot: LatestSlot[str] = LatestSlot()
    assert slot.peek() is None
    assert slot.take() is None
    assert slot.take(timeout=0.001) is None


def test_a_waiting_reader_is_woken_by_the_writer() -> None:
    slot: LatestSlot[str] = LatestSlot()
    got: list[str | None] = []
    reader = threading.Thread(target=lambda: got.append(slot.take(timeout=10.0)))
    reader.start()
    slot.put("now")
    reader.join(timeout=10.0)
    assert got == ["now"]


def test_a_falsy_value_is_a_value() -> None:
    slot: LatestSlot[int] = LatestSlot()
    slot.put(0)
    assert slot.take() == 0
