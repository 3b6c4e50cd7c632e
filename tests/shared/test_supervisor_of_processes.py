"""A supervised process that ends is missed and started again; closing ends them all."""

import os
import select
import signal
import subprocess
import sys
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


def test_a_process_that_has_run_and_is_refused_later_is_tried_again(
    supervisor: Supervisor, tmp_path: Path, program: Path, said: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A port in use for a moment, after a crash, must not end all that still runs."""
    (tmp_path / "failing_program.py").write_text("raise SystemExit(3)")
    supervisor.add("the worker", ["failing_program"])
    os.waitid(os.P_PID, supervisor.pids["the worker"], os.WEXITED | os.WNOWAIT)
    with monkeypatch.context() as patch:
        patch.setattr("weaver_shared.supervisor.STABLE_AFTER", -1.0)
        supervisor.watch()
    (tmp_path / "failing_program.py").write_text("raise SystemExit(2)")
    # It may have read the first program still: either way it has ended and is started again.
    os.waitid(os.P_PID, supervisor.pids["the worker"], os.WEXITED | os.WNOWAIT)
    with monkeypatch.context() as patch:
        patch.setattr("weaver_shared.supervisor.STABLE_AFTER", -1.0)
        supervisor.watch()
    os.waitid(os.P_PID, supervisor.pids["the worker"], os.WEXITED | os.WNOWAIT)
    supervisor.watch()
    assert "ended with code 2" in said[-1]


ORPHANS = """
import signal, sys
from weaver_shared.supervisor import Supervisor
supervisor = Supervisor(print)
supervisor.add("the worker", ["waiting_program", sys.argv[1]])
print(supervisor.pids["the worker"], flush=True)
signal.pause()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells a child of its parent's end")
def test_no_process_outlives_a_killed_supervisor(tmp_path: Path, program: Path) -> None:
    (tmp_path / "orphans.py").write_text(ORPHANS)
    with subprocess.Popen([sys.executable, "-m", "orphans", str(program)], stdout=subprocess.PIPE, text=True) as parent:
        assert program.read_text() == "started\n"
        assert parent.stdout is not None
        child = os.pidfd_open(int(parent.stdout.readline()))
        parent.kill()
    try:
        ended, _, _ = select.select([child], [], [], 20.0)
        assert ended, "it still runs"
    finally:
        os.close(child)


def test_closing_leaves_no_process_behind(program: Path) -> None:
    supervisor = Supervisor(lambda _: None)
    supervisor.add("the worker", ["waiting_program", str(program)])
    assert program.read_text() == "started\n"
    pid = supervisor.pids["the worker"]
    supervisor.close()
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
