"""A supervised process that ends is missed and started again; closing ends them all."""

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from weaver_shared.errors import ConfigurationError
from weaver_shared.supervisor import Supervisor

PROGRAM = """
import signal, sys
open(sys.argv[1], "a").write("started\\n")
signal.pause()
"""


@pytest.fixture
def program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "waiting_program.py").write_text(PROGRAM)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    os.mkfifo(tmp_path / "started")
    return tmp_path / "started"


@pytest.fixture
def said() -> list[str]:
    return []


@pytest.fixture
def supervisor(said: list[str]) -> Iterator[Supervisor]:
    supervisor = Supervisor(said.append)
    yield supervisor
    supervisor.close()


def test_a_killed_process_is_named_and_started_again(
    supervisor: Supervisor, program: Path, said: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    supervisor.add("the worker", ["waiting_program", str(program)])
    assert program.read_text() == "started\n"  # a pipe: returns once the process has written to it
    first = supervisor.pids["the worker"]
    os.kill(first, signal.SIGKILL)
    os.waitid(os.P_PID, first, os.WEXITED | os.WNOWAIT)
    monkeypatch.setattr("weaver_shared.supervisor.STABLE_AFTER", -1.0)
    supervisor.watch()
    assert said == ["the worker was ended by signal 9; starting it again"]
    assert program.read_text() == "started\n"
    assert supervisor.pids["the worker"] != first


def test_a_process_that_dies_young_waits_before_it_starts_again(
    supervisor: Supervisor, program: Path, said: list[str]
) -> None:
    supervisor.add("the worker", ["waiting_program", str(program)])
    assert program.read_text() == "started\n"
    pid = supervisor.pids["the worker"]
    os.kill(pid, signal.SIGKILL)
    os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)
    supervisor.watch()
    assert supervisor.pids == {}
    assert "in 1 s" in said[0]


def test_refused_settings_are_not_tried_for_ever(supervisor: Supervisor, tmp_path: Path, program: Path) -> None:
    (tmp_path / "refusing_program.py").write_text("raise SystemExit(2)")
    supervisor.add("the worker", ["refusing_program", str(program)])
    os.waitid(os.P_PID, supervisor.pids["the worker"], os.WEXITED | os.WNOWAIT)
    with pytest.raises(ConfigurationError, match="the worker"):
        supervisor.watch()


def test_closing_leaves_no_process_behind(program: Path) -> None:
    supervisor = Supervisor(lambda _: None)
    supervisor.add("the worker", ["waiting_program", str(program)])
    assert program.read_text() == "started\n"
    pid = supervisor.pids["the worker"]
    supervisor.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
