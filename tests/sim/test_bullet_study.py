"""The study of Bullet measures what eq. 22 of OpenSHC'20 says, and tells it beside the paper's figures."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from sim_agent.bullet_study import paper
from sim_agent.bullet_study.machine import bullet
from sim_agent.bullet_study.measure import Measured, cost_of_transport, measure
from sim_agent.bullet_study.plots import draw_all
from sim_agent.bullet_study.points import CURVES, PROBED, SWING, Point, points_of
from sim_agent.bullet_study.reasons import reasons
from sim_agent.bullet_study.report import write_report
from sim_agent.bullet_study.store import PointStore
from sim_agent.bullet_study.tables import bipod_faster, optimum_table, power_table, variant_table
from sim_agent.command_line import study_bullet
from weaver_shared.errors import InputError
from weaver_shared.robots import load_robot


def made_up(point: Point) -> Measured:
    """A point with figures that follow from its own: 100 J a metre more than standing, half the speed asked."""
    walks = point.scenario == "WG"
    asked = point.stride * 0.2 * point.frequency * SWING[point.gait] / (1.0 - SWING[point.gait])
    speed = 0.5 * asked if walks else 0.0
    power = 40.0 + 100.0 * speed + 3.0 * point.frequency**2
    return Measured(
        point=point, power=power, idle=25.8, heat=5.0, work=0.93 * power - 30.8, speed=speed, asked=asked,
        granted=asked, cost=cost_of_transport(power, 10.0, speed), tilt=0.02, at_largest_speed=0.1, fell=False,
    )  # fmt: skip


def test_cost_of_transport_is_energy_over_weight_and_way() -> None:
    """98.07 W carry 10 kg along at 0.5 m/s: 196.1 J a metre against a weight of 98.07 N."""
    assert cost_of_transport(98.0665, 10.0, 0.5) == pytest.approx(2.0)
    assert np.isnan(cost_of_transport(50.0, 10.0, 0.0))


def test_the_paper_s_gaits_and_speeds_are_set_up() -> None:
    for name in PROBED:
        robot = bullet(name)
        kind = name.removeprefix("bullet_")
        assert robot.gait("tripod").duty == 0.5
        assert robot.gait("bipod").duty == pytest.approx(1 / 3)
        assert robot.gait("tripod").offset == load_robot(name).gait("tripod").offset
        assert robot.locomotion.largest_stride == paper.STRIDE_LENGTH[kind]
        assert robot.adaptation.height_polynomial[0] == paper.STRIDE_HEIGHT[kind]
        assert robot.clearance == paper.BODY_HEIGHT[kind]
        heavy = bullet(name, "heavy_legs")
        assert heavy.mass == robot.mass
        assert heavy.joints[2].mass == pytest.approx(1.5 * robot.joints[2].mass)
        assert bullet(name, "no_friction").servos["mx106"].coulomb_friction == 0.0


def test_every_point_of_the_paper_s_tables_and_figures_is_planned_once() -> None:
    points = points_of(8.0, 1, quick=False)
    assert len(points) == len(set(points))
    for robot, gait in paper.TABLE_4:
        own = {p.scenario for p in points if p.robot == robot and not p.variant and p.gait in (gait, "tripod")}
        assert own == {"SA", "WA", "SG", "WG"}
    for curves in CURVES.values():
        for robot, gait, stride in curves:
            along = [p for p in points if (p.robot, p.gait, p.stride, p.scenario) == (robot, gait, stride, "WG")]
            assert len(along) >= 5
    assert len(points_of(8.0, 1, quick=True)) < 0.5 * len(points)


def test_tables_and_reasons_tell_the_figures(tmp_path: Path) -> None:
    measured = [made_up(point) for point in points_of(8.0, 1, quick=False)]
    head, *rows = power_table(measured)
    assert [row[:2] for row in rows] == [
        ("mammalian A", "tripod"), ("mammalian B", "tripod"), ("insectoid A", "tripod"), ("insectoid A", "bipod"),
        ("insectoid B", "tripod"),
    ]  # fmt: skip
    assert rows[3][head.index("walk air") : head.index("walk air") + 2] == ("43.0", "72.3")
    # Half of 2 L f against half of L f, for the bipod swings two thirds of a stride and the tripod a half.
    assert bipod_faster(measured) == pytest.approx(2.0)
    assert any("walks 100 % faster" in text for text in reasons(measured))
    assert any("no prediction" in text for text in reasons(measured))
    cheapest = [row for row in optimum_table(measured) if row[0] == "15" and row[1].startswith("insectoid A tripod")]
    expected = min(cost_of_transport(40 + 10 * f + 3 * f * f, 10.0, 0.1 * f) for f in (0.6, 1.0, 1.4, 1.8, 2.2))
    assert float(cheapest[0][2]) == pytest.approx(expected, abs=0.01)
    assert len(variant_table(measured)) == 1 + 4 * len(PROBED)
    pictures = draw_all(measured, tmp_path)
    assert set(pictures) == {"power", "14", "15", "16"}
    markdown, page = write_report(tmp_path, measured, pictures)
    assert "| mammalian A | tripod |" in markdown.read_text()
    assert page.read_text().count("data:image/png;base64,") == 4


def test_a_walk_that_fell_has_no_cost(tmp_path: Path) -> None:
    measured = [made_up(point) for point in points_of(8.0, 1, quick=True)]
    fallen = [replace(m, fell=m.point.gait == "bipod" and m.point.frequency == 2.2) for m in measured]
    assert len(optimum_table(fallen)) == len(optimum_table(measured))
    best = {row[1]: row for row in optimum_table(measured)[1:]}
    assert all(float(row[2]) >= float(best[row[1]][2]) for row in optimum_table(fallen)[1:])
    bipod = next(row for row in optimum_table(fallen) if row[1].startswith("insectoid A bipod"))
    assert float(bipod[4]) < float(best[bipod[1]][4])
    assert any("1 fell" in text for text in reasons(fallen))


def test_what_was_measured_is_found_again_and_half_a_line_is_not(tmp_path: Path) -> None:
    store = PointStore(tmp_path)
    *points, last = points_of(8.0, 1, quick=True)[:4]
    for point in points:
        store.save(made_up(point))
    with (tmp_path / "points.jsonl").open("a") as file:
        file.write('{"version": 1, "point": {"rob')
    again = PointStore(tmp_path)
    assert [repr(again.load(point)) for point in points] == [repr(made_up(point)) for point in points]
    assert again.load(last) is None
    again.save(made_up(last))
    assert repr(PointStore(tmp_path).load(last)) == repr(made_up(last))
    assert again.load(replace(points[0], seed=2)) is None


def test_short_points_of_the_real_thing(tmp_path: Path) -> None:
    """Held in the air nothing moves and only electronics and the legs' weight draw power; standing draws more."""
    common = {"gait": "tripod", "seconds": 0.5, "seed": 1}
    air = measure(Point(robot="bullet_b_mammalian", scenario="SA", **common))  # type: ignore[arg-type]
    ground = measure(Point(robot="bullet_b_mammalian", scenario="SG", **common))  # type: ignore[arg-type]
    for one in (air, ground):
        assert one.power * 0.93 == pytest.approx(one.idle + one.heat + one.work)
        assert one.idle == pytest.approx(30 * 0.86)
        assert not one.fell
        assert one.speed == 0.0
    assert air.tilt < 1e-6
    assert 27.7 < air.power < 33.0
    assert ground.power > air.power + 10.0
    assert ground.heat > air.heat


def test_bad_options_are_refused() -> None:
    for arguments, complaint in (
        (["--jobs", "0"], "--jobs 0 is not valid"),
        (["--seconds", "nan"], "--seconds nan is not valid; use 0.5 to 600 s"),
    ):
        with pytest.raises(InputError, match=complaint):
            study_bullet.main(arguments)


def test_the_command_prints_one_object(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """With every point in the store nothing is walked again."""
    store = PointStore(tmp_path)
    for point in points_of(2.0, 1, quick=True):
        store.save(made_up(point))
    assert study_bullet.main(["--out", str(tmp_path), "--quick", "--seconds", "2", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert len(report["points"]) == len(points_of(2.0, 1, quick=True))
    assert report["paper_table_4"][0]["stance_air"] == 27.7
    assert study_bullet.main(["--out", str(tmp_path), "--quick", "--seconds", "2"]) == 0
    assert "Power in the four scenarios" in capsys.readouterr().out
