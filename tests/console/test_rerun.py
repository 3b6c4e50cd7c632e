"""A recording becomes a Rerun file with everything that was said in it; the console hands out file and viewer."""

from __future__ import annotations

import gzip
import json
from collections import Counter
from pathlib import Path

import pytest
from running_console import Console
from wire_robot import WireRobot

from robot_agent.command_line.export import main
from robot_agent.recording import Recorder, RecordingWriter
from robot_agent.recording.store import RecordingStore
from weaver_console import rerun_viewer
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock
from weaver_shared.errors import InputError, ResourceError
from weaver_shared.robots import load_robot

pytest.importorskip("rerun")

TICKS = 50


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recordings") / "run.mcap"
    bus, clock = MemoryBus(), SimulatedClock()
    writer = RecordingWriter(path, robot_id="weaver", robot=load_robot(), clock=clock, started="now")
    recorder = Recorder(bus, "weaver", writer)
    robot = WireRobot(bus)
    robot.publish_map(reach=1)
    for _ in range(TICKS):
        robot.step()
        recorder.turn()
    writer.close()
    return path


def test_every_state_and_every_tile_is_in_the_file(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from rerun.chunk import RrdReader

    assert main([str(recording), "--output", str(tmp_path / "run.rrd"), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["recorded_s"] == pytest.approx((TICKS - 1) * 0.02)
    rows: Counter[str] = Counter()
    for chunk in RrdReader(tmp_path / "run.rrd").stream().to_chunks():
        rows[chunk.entity_path] += chunk.num_rows
    assert {rows[name] for name in ("/world/body", "/joints/torque", "/stability/margin")} == {TICKS}
    assert {rows[name] for name in ("/world/truth", "/gait/stride_height", "/mission/cross_track_error")} == {
        TICKS // 5
    }
    assert sum(count for name, count in rows.items() if name.startswith("/world/ground/")) == 4


def test_what_is_no_recording_is_refused_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "a.mcap").write_text("nothing")
    for name in ("a.mcap", "b.mcap"):
        with pytest.raises(InputError, match=name):
            main([str(tmp_path / name)])
    assert not list(tmp_path.glob("*.rrd"))


@pytest.fixture
def with_recorder(console: Console, robot: WireRobot, recording: Path) -> Console:
    console.bus.answer_queries(robot.robot_id, topics.RECORDING_PART, RecordingStore(recording.parent).part)
    return console


def test_the_console_converts_what_the_robot_has(
    with_recorder: Console, robot: WireRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    ran = []

    async def run(module: str, *arguments: str) -> None:
        ran.append(module)
        assert main([argument for argument in arguments if argument != "export"]) == 0

    monkeypatch.setattr(rerun_viewer, "_run", run)
    for _ in range(2):
        answer = with_recorder.http.get(f"/api/rerun/{robot.robot_id}/run.rrd", timeout=60.0)
        assert answer.status_code == 200
        assert answer.content[:4] == b"RRF2"
    assert ran == ["weaver_shared.command_line"]  # the second time it was there
    assert not list(with_recorder.data.rglob("*.mcap"))


@pytest.mark.parametrize("address", ["weaver/never.rrd", "nobody/run.rrd", "weaver/..%2Fsecret.rrd"])
def test_what_is_not_there_is_not_found(with_recorder: Console, address: str) -> None:
    answer = with_recorder.http.get(f"/api/rerun/{address}")
    assert answer.status_code == 404
    assert answer.json()["error"]


def test_a_conversion_that_fails_says_why(
    with_recorder: Console, robot: WireRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def fail(module: str, *arguments: str) -> None:
        raise ResourceError("there is no room left")

    monkeypatch.setattr(rerun_viewer, "_run", fail)
    answer = with_recorder.http.get(f"/api/rerun/{robot.robot_id}/run.rrd")
    assert (answer.status_code, answer.json()) == (504, {"error": "there is no room left"})


def test_the_viewer_comes_from_here_and_may_ask_nobody_else(console: Console, monkeypatch: pytest.MonkeyPatch) -> None:
    async def unpack(module: str, folder: str) -> None:
        for name in rerun_viewer.FILES:
            (Path(folder) / f"{name}.gz").write_bytes(gzip.compress(f"this is {name}".encode()))

    monkeypatch.setattr(rerun_viewer, "_run", unpack)
    page, module = console.http.get("/rerun/?url=x"), console.http.get("/rerun/re_viewer_bg.wasm")
    assert (page.text, page.headers["content-type"]) == ("this is index.html", "text/html; charset=utf-8")
    assert (module.content, module.headers["content-type"]) == (b"this is re_viewer_bg.wasm", "application/wasm")
    assert "connect-src 'self' blob:;" in page.headers["content-security-policy"]
    assert console.http.get("/rerun/secret.txt").status_code == 404
