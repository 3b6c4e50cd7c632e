"""A serial adapter is ours alone, may vanish at any time, and is found again under its name."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from robot_agent.hardware.servos.packet import Instruction, encode
from robot_agent.hardware.servos.port import MonotonicLineClock, PortLostError, SerialPort
from robot_agent.hardware.servos.registers import MODELS
from sim_agent.servo_bus import EmulatedBus, EmulatedServo
from sim_agent.servo_bus.pseudo_terminal import PseudoTerminal
from weaver_shared.errors import ConfigurationError, ResourceError

PING = encode(1, Instruction.PING)
PATIENCE_NS = 5_000_000_000


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[PseudoTerminal]:
    with closing(PseudoTerminal(EmulatedBus([EmulatedServo(1, MODELS[311])]), tmp_path / "adapter")) as served:
        yield served


@pytest.fixture
def port(terminal: PseudoTerminal) -> Iterator[SerialPort]:
    opened = SerialPort(str(terminal.link), 1_000_000)
    opened.open()
    yield opened
    opened.closePort()


def answer(port: SerialPort) -> bytes:
    clock = MonotonicLineClock()
    port.send(PING)
    clock.wait_for_answer([port], clock.now_ns() + PATIENCE_NS)
    return port.receive()


def test_it_speaks_with_what_hangs_on_it(port: SerialPort) -> None:
    assert answer(port)[:8] == bytes.fromhex("FFFFFD0001070055")


def test_a_second_program_is_refused_with_the_firsts_number(port: SerialPort) -> None:
    with pytest.raises(ResourceError, match=f"in use by process {os.getpid()}"):
        SerialPort(port.port_name, 1_000_000).open()


def test_a_closed_port_can_be_opened_again(port: SerialPort) -> None:
    port.closePort()
    port.open()
    assert answer(port)


def test_a_port_that_is_not_there_is_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(ResourceError, match="can not be opened"):
        SerialPort(str(tmp_path / "nothing"), 1_000_000).open()


def test_a_rate_that_servos_do_not_know_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="do not know 500000 bit/s"):
        SerialPort("/dev/null", 500_000)


def test_an_adapter_pulled_out_is_one_kind_of_error_and_comes_back(port: SerialPort, terminal: PseudoTerminal) -> None:
    terminal.unplug()
    for attempt in (lambda: port.send(PING), port.receive, lambda: port.readPort(1), port.clearPort):
        with pytest.raises(PortLostError):
            attempt()
    assert not port.reopen()
    terminal.plug_in()
    assert port.reopen()
    assert answer(port)
