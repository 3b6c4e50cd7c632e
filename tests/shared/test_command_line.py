"""The `weaver` command: finds what is registered, and answers bad input with one sentence and exit code 2."""

from importlib.metadata import EntryPoint

import pytest

from weaver_shared import command_line
from weaver_shared.errors import InputError


def refuse(arguments: list[str]) -> int:
    raise InputError(f"{arguments[0]} is no picture")


def interrupt(arguments: list[str]) -> int:
    raise KeyboardInterrupt


def succeed(arguments: list[str]) -> int:
    return len(arguments)


@pytest.fixture
def registered() -> dict[str, EntryPoint]:
    here = [refuse, interrupt, succeed]
    return {f.__name__: EntryPoint(f.__name__, f"{__name__}:{f.__name__}", "test") for f in here}


def test_help_names_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.main(["--help"]) == 0
    printed = capsys.readouterr().out
    for name in ("up", "walk", "gait", "odometry", "terrain", "robot", "sim", "console", "bench"):
        assert f"  {name}\n" in printed


def test_an_unknown_command_is_answered_with_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.main(["fly"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("weaver: command 'fly' is unknown; known are bench, ")
    assert captured.err.count("\n") == 1


def test_an_unknown_bench_is_answered_with_the_known_ones(capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.main(["bench", "nothing"]) == 2
    assert "bench 'nothing' is unknown; known are" in capsys.readouterr().err


def test_bad_input_is_one_sentence(registered: dict[str, EntryPoint], capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.run(registered, ["refuse", "a.png"], "command") == 2
    assert capsys.readouterr().err == "weaver refuse: a.png is no picture\n"


def test_a_command_gets_its_arguments_and_gives_its_exit_code(registered: dict[str, EntryPoint]) -> None:
    assert command_line.run(registered, ["succeed", "a", "b"], "command") == 2
    assert command_line.run(registered, ["succeed"], "command") == 0


def test_an_interrupt_ends_quietly(registered: dict[str, EntryPoint]) -> None:
    assert command_line.run(registered, ["interrupt"], "command") == 130
