"""The shipped robots are those of the papers: sizes, masses and, for OpenSHC's, every foot of its configuration."""

import json
from pathlib import Path

import numpy as np
import pytest

from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import load_robot, robot_names
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.robots.reach import foot_jacobians, joints_reaching, leg_length

OPENSHC = Path(__file__).resolve().parents[3] / "shared" / "data" / "openshc"
LEGS = ("AR", "BR", "CR", "CL", "BL", "AL")


def openshc(name: str) -> dict[str, dict[str, float]]:
    path = OPENSHC / f"config_{name}.json"
    if not path.exists():
        pytest.skip(f"{path} is not here")
    parameters: dict[str, dict[str, float]] = json.loads(path.read_text())["syropod"]["parameters"]
    return parameters


def foot_of_openshc(
    parameters: dict[str, dict[str, float]], leg: str, joints: list[str], angles: np.ndarray
) -> np.ndarray:
    frame = np.eye(4)
    for link, angle in zip(["base", *joints], [0.0, *angles], strict=True):
        row = parameters[f"{leg}_{link}_link_parameters"]
        ct, st = np.cos(row["theta"] + angle), np.sin(row["theta"] + angle)
        ca, sa = np.cos(row["alpha"]), np.sin(row["alpha"])
        frame = frame @ np.array(
            [
                [ct, -st * ca, st * sa, row["r"] * ct],
                [st, ct * ca, -ct * sa, row["r"] * st],
                [0.0, sa, ca, row["d"]],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )
    foot: np.ndarray = frame[:3, 3]
    return foot


@pytest.mark.parametrize("name", ["default", "bullet_insectoid", "bullet_mammalian"])
def test_feet_are_where_openshc_has_them(name: str) -> None:
    """Left legs mirror right ones here, so OpenSHC's first two angles, which it mirrors itself, change sign there."""
    robot, parameters = load_robot(name), openshc(name)
    joints = [joint.name for joint in robot.joints]
    generator = np.random.default_rng(0)
    for _ in range(10):
        angles = generator.uniform(*robot.joint_limits.T, size=(6, len(joints)))
        theirs = angles.copy()
        if name != "default":
            theirs[3:, :2] *= -1.0
        expected = [foot_of_openshc(parameters, leg, joints, theirs[i]) for i, leg in enumerate(LEGS)]
        np.testing.assert_allclose(feet_in_body(robot, angles), expected, atol=1e-3)  # its quarter turns are 1.571
    assert robot.clearance == parameters["body_clearance"]
    stance = [[parameters[f"{leg}_stance_position"][axis] for axis in "xy"] for leg in LEGS]
    np.testing.assert_allclose(robot.stance_in_body[:, :2], stance)


@pytest.mark.parametrize(("arrangement", "mass", "length"), [("a", 10.07, 0.340), ("b", 11.13, 0.466)])
@pytest.mark.parametrize("posture", ["insectoid", "mammalian"])
def test_bullet_has_the_masses_and_leg_lengths_of_its_arrangements(
    arrangement: str, mass: float, length: float, posture: str
) -> None:
    robot = load_robot(f"bullet_{arrangement}_{posture}")
    assert robot.mass == mass
    links = robot.dh[:, 1:3].sum() if arrangement == "a" else robot.dh[1:, 2].sum()
    assert links == pytest.approx(length)
    assert {joint.servo for joint in robot.joints} == {"mx106"}
    assert robot.joint_count == 30


@pytest.mark.parametrize("name", robot_names())
def test_every_robot_reaches_its_standing_and_its_sitting_feet(name: str) -> None:
    robot = load_robot(name)
    lower, upper = robot.joint_limits.T
    for feet, search in (
        (robot.stance_in_body, robot.standing_search),
        (robot.sitting_in_body, robot.sitting_search),
    ):
        joints, left = joints_reaching(robot, feet, search)
        assert left.max() < 1e-3 * leg_length(robot)
        assert (joints >= lower).all()
        assert (joints <= upper).all()
        np.testing.assert_allclose(np.linalg.norm(feet_in_body(robot, joints) - feet, axis=1), left, atol=1e-12)


@pytest.mark.parametrize("name", robot_names())
def test_the_jacobian_is_the_derivative_of_every_foot(name: str) -> None:
    robot = load_robot(name)
    angles = np.random.default_rng(1).uniform(*robot.joint_limits.T, size=(robot.leg_count, robot.joints_per_leg))
    jacobian = foot_jacobians(robot, angles)
    for joint in range(robot.joints_per_leg):
        step = np.zeros_like(angles)
        step[:, joint] = 1e-6
        difference = (feet_in_body(robot, angles + step) - feet_in_body(robot, angles - step)) / 2e-6
        np.testing.assert_allclose(jacobian[:, :, joint], difference, atol=1e-7)


def test_a_robot_without_camera_says_so_when_it_needs_one() -> None:
    robot = load_robot("max")
    assert not robot.has_camera
    with pytest.raises(ConfigurationError, match="robot 'max' has no camera"):
        _ = robot.camera
