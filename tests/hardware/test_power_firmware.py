"""The power monitor's sketch, compiled for this computer, sends what our parser reads."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from robot_agent.hardware.power_monitor import RELAY_CLOSED, PowerParser, PowerRecord

ROOT = Path(__file__).resolve().parents[2]
COMPILER = shutil.which("g++")
pytestmark = pytest.mark.skipif(COMPILER is None, reason="compiling the sketch needs g++")


@pytest.fixture(scope="module")
def sketch(tmp_path_factory: pytest.TempPathFactory) -> Path:
    program = tmp_path_factory.mktemp("sketch") / "monitor"
    stand_in = program.parent / "Wire.h"
    stand_in.write_text("")
    source = Path(__file__).parent / "arduino_on_host.cpp"
    include = [f"-I{ROOT / 'firmware' / 'power_monitor'}", f"-I{program.parent}"]
    command = [str(COMPILER), "-Wall", "-Werror", "-Wno-format-truncation", *include, str(source), "-o", str(program)]
    subprocess.run(command, check=True)
    return program


def sent(sketch: Path, seconds: float, commands: str, after: float = 0.0) -> tuple[bytes, list[PowerRecord]]:
    times = [str(round(value * 1e6)) for value in (seconds, after)]
    output = subprocess.run([str(sketch), *times, commands], check=True, capture_output=True).stdout
    return output, PowerParser().feed(output)


def test_every_line_is_read(sketch: Path) -> None:
    output, records = sent(sketch, 10.0, "PING\n")
    assert len(records) == pytest.approx(900, abs=2)
    assert output.count(b"$") == len(records)
    assert b"PONG" in output
    assert {(record.millivolts, record.milliamperes) for record in records} == {(25_900, 4000)}
    assert [record.sequence for record in records] == list(range(len(records)))


def test_energy_is_summed_up_also_where_the_counters_begin_anew(sketch: Path) -> None:
    """103.6 W for 10 s are 287.8 mWh; the microseconds' counter overflows half-way."""
    _, records = sent(sketch, 10.0, "")
    assert records[-1].milliwatt_hours == pytest.approx(287, abs=1)


def test_a_guarded_relay_opens_when_the_computer_falls_silent(sketch: Path) -> None:
    _, records = sent(sketch, 2.0, "RELAY 1\nGUARD 1\n", after=0.5)
    closed = [bool(record.flags & RELAY_CLOSED) for record in records]
    assert not any(closed[:45])
    assert sum(closed) * 0.0111 == pytest.approx(0.5, abs=0.03)
    assert not closed[-1]


def test_an_unguarded_relay_stays_as_it_was_told(sketch: Path) -> None:
    _, records = sent(sketch, 2.0, "RELAY 1\n", after=0.5)
    assert records[-1].flags & RELAY_CLOSED
