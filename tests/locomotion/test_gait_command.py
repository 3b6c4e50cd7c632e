"""`weaver gait` and `weaver bench tick` as programs."""

import csv
import io
import json

import numpy as np
import pytest

from robot_agent.command_line import bench_tick, gait
from weaver_shared.errors import WeaverError


def table(capsys, *arguments):
    assert gait.main(list(arguments)) == 0
    return list(csv.DictReader(io.StringIO(capsys.readouterr().out)))


def test_the_table_has_a_row_per_tick_and_leg_and_idles_first(capsys):
    rows = table(capsys, "--velocity", "0.1,0,0", "--ticks", "60")
    assert len(rows) == 61 * 6
    assert [row["leg"] for row in rows[:6]] == ["AR", "BR", "CR", "CL", "BL", "AL"]
    assert {row["step_state"] for row in rows if int(row["tick"]) <= 5} == {"3"}
    assert {row["step_state"] for row in rows if int(row["tick"]) > 6} == {"0", "1"}
    for name in ("poser_x", "model_qw", "swing_progress", "virtual_stiffness", "q4", "dq4"):
        assert name in rows[0]


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_a_gait_is_drawn_into_a_file_and_printed_only_when_asked(kind, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    picture = tmp_path / f"gait.{kind}"
    assert gait.main(["--ticks", "150", "--gait", "ripple", "--plot", str(picture)]) == 0
    assert not capsys.readouterr().out
    assert picture.stat().st_size > 20_000
    assert gait.main(["--ticks", "3", "--plot", str(picture), "--csv"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 1 + 4 * 6


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--plot", "gait.txt"], "end with .png, .svg"),
        (["--plot", "a.png", "--compat", "openshc-0.5.11"], "leave --compat"),
    ],
)
def test_pictures_that_can_not_be_drawn_are_refused(arguments, reason):
    with pytest.raises(WeaverError, match=reason):
        gait.main(["--ticks", "3", *arguments])


def test_csv_without_a_file_is_the_standard_output(capsys):
    assert table(capsys, "--ticks", "3", "--csv") == table(capsys, "--ticks", "3")


def test_its_swing_apex_and_its_stance_speed_are_exact(capsys):
    rows = table(capsys, "--velocity", "0.1,0,0", "--ticks", "300", "--frequency", "0.8", "--height", "0.06")
    leg = [row for row in rows if row["leg"] == "BL" and int(row["tick"]) > 200]
    heights = np.array([float(row["walker_z"]) for row in leg])
    assert heights.max() == pytest.approx(0.06, abs=3e-4)  # the apex falls between two ticks
    stance = [float(row["walker_vx"]) for row in leg if float(row["stance_progress"]) > 0.05]
    np.testing.assert_allclose(stance, -0.1, atol=1e-6)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--gait", "gallop"], "known are tripod"),
        (["--robot", "spot"], "weaver"),
        (["--velocity", "1,2"], "three numbers"),
        (["--velocity", "nan,0,0"], "three numbers"),
        (["--ticks", "0"], "from 1 up"),
        (["--frequency", "-1"], "above zero"),
        (["--csv", "/nowhere/at/all.csv"], "can not be written"),
    ],
)
def test_bad_input_gets_one_sentence(arguments, says):
    with pytest.raises(WeaverError, match=says):
        gait.main(arguments)


def test_the_benchmark_reports_its_keys(capsys):
    assert bench_tick.main(["--json", "--ticks", "50"]) == 0
    figures = json.loads(capsys.readouterr().out)["tick_us"]
    legs, stages = ("five_joint", "bullet", "three_joint"), ("walk", "admittance", "posing")
    assert set(figures) == {f"{kind}_{stage}" for kind in legs for stage in stages}
    for figure in figures.values():
        assert 0.0 < figure["median"] <= figure["p99"]
        assert figure["yardsticks"] == pytest.approx(figure["median"] / figure["yardstick"], rel=0.02)
