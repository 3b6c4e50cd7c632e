"""A page is told no more than it can take, so that what it shows is new."""

from running_console import Console, Page
from wire_robot import WireRobot

from weaver_console.pace import LATE, LEAST_ROOM, MOST_ON_THE_WAY, MOST_ROOM, Pace
from weaver_shared.messages import CommandName


def test_a_page_that_reports_is_never_more_than_eight_frames_behind():
    pace = Pace()
    pace.taken(0.0)
    for _ in range(MOST_ON_THE_WAY):
        assert pace.ready
        pace.sent(0.0)
    assert not pace.ready
    pace.taken(0.1)
    assert pace.ready


def test_frames_may_be_reported_together():
    pace = Pace()
    pace.taken(0.0)
    for _ in range(MOST_ON_THE_WAY):
        pace.sent(0.0)
    pace.taken(0.1, MOST_ON_THE_WAY - 1)
    for _ in range(MOST_ON_THE_WAY - 1):
        assert pace.ready
        pace.sent(0.2)
    assert not pace.ready


def test_a_page_that_does_not_report_is_told_everything():
    pace = Pace()
    for _ in range(100):
        pace.sent(0.0, MOST_ROOM)
    assert pace.ready
    assert pace.room == MOST_ROOM


def test_reports_too_many_earn_no_credit():
    pace = Pace()
    for _ in range(50):
        pace.taken(0.0)
    for _ in range(MOST_ON_THE_WAY):
        pace.sent(0.0)
    assert not pace.ready


def _over_a_way(pace: Pace, rate: float, seconds: float) -> float:
    """Send all that there is room for over a way of `rate` bytes/s; returns the longest any of the later ones took."""
    pace.taken(0.0)
    now, longest = 0.0, 0.0
    while now < seconds:
        bulk = pace.room
        pace.sent(now, bulk)
        took = 0.1 + bulk / rate
        now += took
        pace.taken(now)
        longest = max(longest, took) if now > 0.5 * seconds else longest
    return longest


def test_a_narrow_way_is_given_no_more_than_it_carries_in_good_time():
    assert _over_a_way(Pace(), 100e3, 60.0) < LATE + 0.2
    assert _over_a_way(Pace(), 20e3, 60.0) < LATE + 0.2


def test_a_quick_way_comes_to_carry_the_most_there_is():
    pace = Pace()
    _over_a_way(pace, 100e6, 5.0)
    assert pace.room == MOST_ROOM


def test_a_tile_finds_room_on_the_narrowest_way():
    pace = Pace()
    _over_a_way(pace, 1e3, 600.0)
    assert pace.room == LEAST_ROOM


def test_a_page_that_falls_behind_still_gets_answers_and_then_the_newest_values(console: Console, robot: WireRobot):
    with console.page() as socket:
        page = Page(socket)
        page.hear("hello")
        page.say(type="taken")
        page.select(robot)
        for _ in range(3 * MOST_ON_THE_WAY):
            robot.step()
            assert page.command(CommandName.STOP)["accepted"]
        for _ in range(100):
            page.say(type="taken")
        robot.step()
        page.hear("value", key="tele/state", stamp_ns=robot.tick * 20_000_000)
