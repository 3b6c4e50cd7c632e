"""The testbed study's figures follow from the walks, and a finished walk is never walked twice."""

import json
from dataclasses import replace

import numpy as np
import pytest

from robot_agent.adaptation import safe_gait
from sim_agent.command_line import study_testbed
from sim_agent.testbed_study import cluster
from sim_agent.testbed_study.figures import study_figures
from sim_agent.testbed_study.fixed_set import fixed_set
from sim_agent.testbed_study.plan import adaptive_walks, fixed_walks
from sim_agent.testbed_study.report import parameter_table
from sim_agent.testbed_study.store import RecordStore
from sim_agent.testbed_study.walk import COLUMNS, WalkRecord
from sim_agent.worlds import make_world
from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.errors import InputError
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import load_robot

MASS = 10.3
SPEED = {"adaptive": 0.2, "fixed": 0.1}
POWER = {"adaptive": 150.0, "fixed": 120.0}
SWAY = {"adaptive": 0.01, "fixed": 0.02}

CONSTANT = {"virtual_stiffness": 500.0, "stride_frequency": 0.35, "stride_height": 0.11}


def plan(runs, seed, world_seed, distance):
    """Adaptive and fixed walks in turns."""
    adaptive = adaptive_walks(runs, seed, world_seed, distance)
    return [walk for pair in zip(adaptive, fixed_walks(adaptive, CONSTANT), strict=True) for walk in pair]


def made_up_walk(walk):
    """A steady walk whose figures are known by hand."""
    time = np.arange(0.0, walk.distance / SPEED[walk.kind], 0.05)
    rows = {name: np.zeros(len(time)) for name in COLUMNS}
    rows["time"], rows["x"] = time, SPEED[walk.kind] * time
    rows["supply_power"][:], rows["motor_power"][:] = POWER[walk.kind], POWER[walk.kind] - 80.0
    rows["roll"], rows["pitch"] = SWAY[walk.kind] * np.sin(7.0 * time), 0.1 + 0.02 * np.sin(7.0 * time)
    rough = np.exp(-(((rows["x"] - 4.1) / 0.5) ** 2))  # roughest at 4.1 m
    rows["roughness"] = np.where(rows["x"] < 0.5, np.nan, 0.8 * rough)
    rows["virtual_stiffness"][:] = np.where(rows["x"] < 0.5, 400.0, 2000.0 - 1500.0 * rough)
    rows["stride_frequency"][:] = np.where(rows["x"] < 0.5, 0.3, 1.0 - 0.6 * rough)
    rows["stride_height"][:] = np.where(rows["x"] < 0.5, 0.14, 0.05 + 0.05 * rough)
    rows["estimated_x"] = rows["x"] * 1.001
    return WalkRecord(plan=walk, outcome="reached", duration=float(time[-1]), drift_percent=0.1, rows=rows)


def test_figures_are_those_of_the_walks():
    records = [made_up_walk(walk) for walk in plan(3, 1, 1, 8.4)]
    records[1] = replace(records[1], outcome="stuck")
    figures = study_figures(records, make_world("testbed", 1), MASS)
    assert (figures.kinds["adaptive"].reached, figures.kinds["fixed"].reached) == (3, 2)
    cost = {kind: POWER[kind] / (MASS * GRAVITY * SPEED[kind]) for kind in SPEED}
    assert figures.kinds["adaptive"].cost_total == pytest.approx((cost["adaptive"], 0.0), abs=1e-6)
    assert figures.cost_reduction == pytest.approx(100.0 * (1.0 - cost["adaptive"] / cost["fixed"]))
    assert set(figures.segments) == set("ABCDEFG")
    for segment in figures.segments.values():
        assert segment.cost_total == pytest.approx((cost["adaptive"], cost["fixed"]))
        assert segment.speed == pytest.approx((0.2, 0.1))
        assert segment.roll_reduction == pytest.approx(75.0, abs=6.0)  # half the angle, a quarter of the variance
        assert segment.pitch_reduction == pytest.approx(0.0, abs=20.0)


def test_the_fixed_set_is_the_adaptive_one_where_known_ground_is_roughest():
    walk, *_ = plan(1, 1, 1, 8.4)
    found = fixed_set(made_up_walk(walk), AdaptationConfig())
    assert found["stride_frequency"] == pytest.approx(0.4, abs=0.02)  # not the 0.3 Hz where nothing was known
    assert found["virtual_stiffness"] == pytest.approx(500.0, abs=50.0)
    assert found["stride_height"] == pytest.approx(0.1, abs=0.002)
    unfinished = replace(made_up_walk(walk), outcome="stuck")
    assert fixed_set(unfinished, AdaptationConfig()) == safe_gait(AdaptationConfig())


def test_the_table_of_parameters_tells_what_was_taken_of_what_was_allowed():
    adaptation = load_robot().adaptation
    records = [made_up_walk(walk) for walk in plan(1, 1, 1, 8.4)]
    heading, *rows = parameter_table(records, adaptation)
    assert heading == ("", "bounds", "adaptive", "fixed")
    bounds = adaptation.stride_frequency
    assert rows[1] == ("stride frequency, Hz", f"{bounds.lower:g} to {bounds.upper:g}", "0.3 to 1", "0.35")


def test_without_a_finished_walk_figures_are_unknown_not_wrong():
    records = [replace(made_up_walk(walk), outcome="fell") for walk in plan(1, 1, 1, 8.4)]
    figures = study_figures(records, make_world("testbed", 1), MASS)
    assert np.isnan(figures.cost_reduction)
    assert figures.segments == {}


def test_adaptive_and_fixed_walks_of_a_seed_begin_alike_and_others_do_not():
    adaptive, fixed, other, _ = plan(2, 1, 1, 8.4)
    assert adaptive.world().start == fixed.world().start
    assert adaptive.world().friction == fixed.world().friction
    assert adaptive.world().start != other.world().start
    assert 0.85 <= other.world().friction <= 1.15


def test_a_record_is_found_again_exactly_for_its_own_plan(tmp_path):
    walk, *_ = plan(1, 1, 1, 2.0)
    store, record = RecordStore(tmp_path), made_up_walk(walk)
    assert store.load(walk) is None
    store.save(record)
    found = store.load(walk)
    assert (found.outcome, found.duration, found.plan) == (record.outcome, record.duration, walk)
    for name in COLUMNS:
        np.testing.assert_array_equal(found.rows[name], record.rows[name])
    assert store.load(replace(walk, distance=3.0)) is None
    (tmp_path / f"{walk.name}.parquet").write_bytes(b"PAR1 cut off")
    assert store.load(walk) is None


def test_an_interrupted_study_goes_on_and_reports(tmp_path, monkeypatch, capsys):
    walked = []

    def interrupted(walks, *_):
        for walk in walks:
            if len(walked) == 2:
                raise KeyboardInterrupt
            walked.append(walk.name)
            yield made_up_walk(walk)

    monkeypatch.setattr(study_testbed, "walk_all", interrupted)
    arguments = ["--runs", "2", "--out", str(tmp_path), "--json"]
    with pytest.raises(KeyboardInterrupt):
        study_testbed.main(arguments)
    assert walked == ["adaptive-001", "adaptive-002"]
    monkeypatch.setattr(study_testbed, "walk_all", lambda walks, *_: map(made_up_walk, walks))
    capsys.readouterr()
    assert study_testbed.main(arguments) == 0
    figures = json.loads(capsys.readouterr().out)
    assert len(figures["walks"]) == 4
    assert figures["cost_reduction"] == pytest.approx(37.5)
    page = (tmp_path / "report.html").read_text()
    assert page.count("data:image/png;base64,") == 3
    assert "29.6" in (tmp_path / "report.md").read_text()


def test_walks_are_spread_over_processes():
    walks = plan(2, 1, 1, 2.0)
    records = list(cluster.walk_all(walks, made_up_walk, 2, None))
    assert sorted(record.plan.name for record in records) == sorted(walk.name for walk in walks)


def test_a_scheduler_that_is_not_there_is_named(monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT_SECONDS", 0.2)
    with pytest.raises(InputError, match=r"no Dask scheduler answers at tcp://127\.0\.0\.1:9"):
        list(cluster.walk_all(plan(1, 1, 1, 2.0), made_up_walk, 1, "tcp://127.0.0.1:9"))


@pytest.mark.parametrize("arguments", [["--runs", "0"], ["--jobs", "0"], ["--distance", "50"]])
def test_impossible_orders_are_refused(arguments, tmp_path):
    with pytest.raises(InputError, match=r"valid|whole numbers"):
        study_testbed.main([*arguments, "--out", str(tmp_path)])
