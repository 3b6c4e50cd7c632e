"""The page starts and stops the robot's recorder without control of the robot, and downloads what it wrote."""

from __future__ import annotations

import pytest
from running_console import Console, Page
from wire_robot import WireRobot

from weaver_console import robot_files
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.messages import Answer, Command, CommandName, PartRequest, RecordingPart, RecordingState

CONTENT = bytes(range(256)) * 10


class WireRecorder:
    """A recorder's end of the bus."""

    def __init__(self, bus: MemoryBus, robot_id: str) -> None:
        self.commands: list[Command] = []
        self.shrunk = False
        bus.answer_queries(robot_id, topics.RECORDER_COMMANDS, self._obey)
        bus.answer_queries(robot_id, topics.RECORDING_PART, self._part)
        state = RecordingState(
            active="a.mcap", seconds=2.5, size=1000, pictures=True, lost=0, reason="", folder="/f", free=1, entries=()
        )
        bus.publish(robot_id, topics.RECORDING, state)

    def _obey(self, command: Command) -> Answer:
        self.commands.append(command)
        return Answer(accepted=True, reason="")

    def _part(self, request: PartRequest) -> RecordingPart:
        if request.name != "a.mcap":
            return RecordingPart(data=b"", size=0, reason="there is no such file")
        end = 1000 if self.shrunk else len(CONTENT)
        data = CONTENT[request.offset : min(request.offset + request.length, end)]
        return RecordingPart(data=data, size=len(CONTENT), reason="")


@pytest.fixture
def recorder(bus: MemoryBus, robot: WireRobot) -> WireRecorder:
    return WireRecorder(bus, robot.robot_id)


def test_a_page_records_without_control_of_the_robot(
    console: Console, robot: WireRobot, recorder: WireRecorder
) -> None:
    with console.page() as connection:
        page = Page(connection)
        page.select(robot)
        assert page.hear("value", key="state/recording")["value"]["active"] == "a.mcap"
        assert page.command(CommandName.START_RECORDING, value=1.0)["accepted"]
        assert page.command(CommandName.STOP_RECORDING)["accepted"]
    assert [(c.command, c.value, c.operator) for c in recorder.commands] == [
        (CommandName.START_RECORDING, 1.0, "anna"),
        (CommandName.STOP_RECORDING, 0.0, "anna"),
    ]
    assert robot.commands == []


def test_without_a_recorder_the_page_is_told_so(console: Console, robot: WireRobot) -> None:
    with console.page() as connection:
        page = Page(connection)
        page.select(robot)
        answer = page.command(CommandName.START_RECORDING)
    assert not answer["accepted"]
    assert answer["reason"]


def test_a_recording_is_downloaded_whole(
    console: Console, robot: WireRobot, recorder: WireRecorder, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(robot_files, "PART_BYTES", 999)
    robot.step()
    reply = console.http.get(f"/api/recordings/{robot.robot_id}/a.mcap")
    assert reply.content == CONTENT
    assert reply.headers["content-disposition"] == 'attachment; filename="a.mcap"'


def test_what_is_not_there_is_said(console: Console, robot: WireRobot, recorder: WireRecorder) -> None:
    robot.step()
    reply = console.http.get(f"/api/recordings/{robot.robot_id}/b.mcap")
    assert (reply.status_code, reply.json()) == (404, {"error": "there is no such file"})
    assert console.http.get("/api/recordings/nobody/a.mcap").status_code == 404
    assert console.http.get(f"/api/recordings/{robot.robot_id}/..%2Fa.mcap").status_code == 404


def test_a_robot_without_a_recorder_has_no_recordings(console: Console, robot: WireRobot) -> None:
    robot.step()
    assert console.http.get(f"/api/recordings/{robot.robot_id}/a.mcap").status_code == 504
