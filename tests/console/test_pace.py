"""A page is told no more than it can take, so that what it shows is new."""

from conftest import Console, Page
from wire_robot import WireRobot

from weaver_console.pace import MOST_ON_THE_WAY, Pace
from weaver_shared.messages import CommandName


def test_a_page_that_reports_is_never_more_than_three_frames_behind():
    pace = Pace()
    pace.taken()
    for _ in range(MOST_ON_THE_WAY):
        assert pace.ready
        pace.sent()
    assert not pace.ready
    pace.taken()
    assert pace.ready


def test_a_page_that_does_not_report_is_told_everything():
    pace = Pace()
    for _ in range(100):
        pace.sent()
    assert pace.ready


def test_reports_too_many_earn_no_credit():
    pace = Pace()
    for _ in range(50):
        pace.taken()
    for _ in range(MOST_ON_THE_WAY):
        pace.sent()
    assert not pace.ready


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
