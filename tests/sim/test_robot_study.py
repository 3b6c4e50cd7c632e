"""The study of the robots walks what it is told, judges by the truth and tells it in a table."""

import json

import pytest

pytest.importorskip("pybullet")

from sim_agent.command_line.study_robots import main
from sim_agent.study.plan import Course, courses
from sim_agent.study.report import table
from sim_agent.study.result import Result
from sim_agent.study.speeds import pace_of, parameters_for
from sim_agent.study.summary import summary
from weaver_shared.errors import InputError
from weaver_shared.robots import load_robot


@pytest.mark.walk
@pytest.mark.parametrize(
    ("robot", "gait", "ways"),
    [("default", "tripod", ("forward", "turn")), ("octopod", "tetrapod", ("sideways",))],
)
def test_a_robot_stands_up_walks_as_fast_as_told_and_sits_down(robot, gait, ways):
    results = Course(robot=robot, gait=gait, world="flat", seed=1, ways=ways).walk()
    assert [result.manoeuvre for result in results] == list(ways)
    for result in results:
        assert result.stood
        assert result.sat
        assert result.belly_on_ground
        assert not result.fell
        assert 0.85 < result.ratio < 1.2
        assert result.static_margin_mm > 0.0
        assert 0.0 < result.torque_share < 1.0
        assert result.touches == 0


def test_every_robot_walks_every_gait_on_level_ground_and_some_climb():
    planned = courses(("weaver", "magneto", "bullet_mammalian"), (), ("flat", "stairs6"), 1)
    gaits = {(course.robot, course.gait) for course in planned if course.world == "flat"}
    assert gaits == {
        (name, gait) for name in ("weaver", "magneto", "bullet_mammalian") for gait in load_robot(name).gaits
    }
    assert {course.robot for course in planned if course.world == "stairs6"} == {"weaver", "bullet_mammalian"}


@pytest.mark.parametrize("gait", ["tripod", "wave"])
def test_the_speed_asked_is_one_the_robot_grants(gait):
    robot = load_robot("weaver")
    parameters = parameters_for(robot, gait)
    forward, sideways = (pace_of(robot, gait, way, parameters) for way in ("forward", "sideways"))
    assert 0.02 < forward.velocity[0] < robot.locomotion.largest_speed
    assert sideways.velocity[1] < forward.velocity[0]  # its knees have to fold to step sideways
    assert 0.0 < forward.frequency <= parameters.stride_frequency + 1e-9


def result_of(**changes: object) -> Result:
    figures = {
        "robot": "weaver", "gait": "bipod", "world": "flat", "manoeuvre": "turn", "stood": True, "fell": False,
        "sat": True, "belly_on_ground": True, "asked": 0.5, "achieved": 0.45, "static_margin_mm": None,
        "energy_margin_mm": None, "largest_tilt_deg": 1.5, "torque_share": 0.4, "touches": 0, "seconds": 12.0,
        "real_time_factor": 3.0,
    }  # fmt: skip
    return Result(**{**figures, **changes})


def test_the_table_has_a_row_for_each_result_and_says_what_failed():
    rows = table([result_of(), result_of(fell=True), result_of(achieved=0.2)]).splitlines()[2:]
    assert rows[0] == "| weaver | bipod | flat | turn | 0.500 rad/s | 0.90 | – | – | 1.5 | 0.40 | yes | no | " \
        "on its belly | 3.0 |  |"  # fmt: skip
    assert [("failed" in row) for row in rows] == [False, True, True]


def test_the_summary_has_a_row_for_each_gait_and_one_for_each_climb():
    walks = [result_of(manoeuvre="forward", static_margin_mm=30.0), result_of(static_margin_mm=-2.4, fell=True)]
    level, climbs = summary([*walks, result_of(world="stairs6", manoeuvre="over", sat=None)]).split("\n\n")
    assert level.splitlines()[2:] == ["| weaver | bipod | 0.500, 0.90 | – | 0.500, 0.90 | -2 | 1.5 | yes | yes |"]
    assert climbs.splitlines()[2] == "| weaver | stairs6 | bipod | over | 0.500, 0.90 | – | – | 1.5 | 0.40 | no |"
    assert summary(walks).count("\n") == 3


def test_figures_are_json():
    assert json.loads(json.dumps(result_of().as_dict()))["ratio"] == pytest.approx(0.9)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--robots", "snail"], "robot 'snail' is unknown"),
        (["--robots", "magneto", "--gaits", "tripod"], "gait 'tripod' is unknown here; known are trot, wave"),
        (["--worlds", "moon"], "world 'moon' is unknown"),
        (["--jobs", "0"], "whole number from 1"),
    ],
)
def test_bad_orders_are_answered_in_a_sentence(arguments, words):
    with pytest.raises(InputError, match=words):
        main(arguments)
