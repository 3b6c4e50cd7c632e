"""A robot that changes its posture is one machine with two descriptions."""

import pytest

from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import load_robot, robot_names
from weaver_shared.robots.counterpart import counterpart_of
from weaver_shared.robots.parts import Joint

PAIRED = [name for name in robot_names() if load_robot(name).posture]


def test_both_arrangements_of_bullet_have_two_postures() -> None:
    assert [f"bullet_{a}_{p}" for a in "ab" for p in ("insectoid", "mammalian")] == PAIRED


@pytest.mark.parametrize("name", PAIRED)
def test_the_counterpart_of_the_counterpart_is_the_robot(name: str) -> None:
    robot = load_robot(name)
    other = counterpart_of(robot)
    assert other is not None
    assert other.name != name
    assert counterpart_of(other) == robot


def test_a_robot_with_one_posture_has_no_counterpart() -> None:
    assert counterpart_of(load_robot("weaver")) is None


@pytest.mark.parametrize(
    ("key", "update"),
    [
        ("mass", {"mass": 10.1}),
        ("foot_radius", {"foot_radius": 0.02}),
        ("legs.0.hip_in_body", {"legs": "moved"}),
        ("joints.2.r", {"joints": "longer"}),
    ],
)
def test_two_machines_are_not_taken_for_one(key: str, update: dict[str, object]) -> None:
    robot = load_robot("bullet_a_insectoid")
    if update == {"legs": "moved"}:
        update = {"legs": (robot.legs[0].model_copy(update={"hip_in_body": (0.2, -0.1, 0.0)}), *robot.legs[1:])}
    if update == {"joints": "longer"}:
        longer = robot.joints[2].model_copy(update={"r": 0.1})
        update = {"joints": (*robot.joints[:2], longer, *robot.joints[3:])}
    with pytest.raises(ConfigurationError, match=rf"posture.counterpart: {key} is .* one machine has one value"):
        counterpart_of(robot.model_copy(update=update))


def test_a_walking_range_beyond_the_joints_limits_is_refused() -> None:
    yaw = load_robot("bullet_a_insectoid").joints[0].model_dump()
    with pytest.raises(ValueError, match=r"walking -0.5 to 1.8 rad is no range within its limits -1.7 to 1.7 rad"):
        Joint.model_validate(yaw | {"walking": (-0.5, 1.8)})
