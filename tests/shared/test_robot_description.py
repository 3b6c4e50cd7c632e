"""A robot description is checked as a whole, and a mistake in it is named in one sentence."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription, load_robot, robot_names


@pytest.fixture(scope="module")
def weaver() -> RobotDescription:
    return load_robot("weaver")


def shipped(name: str = "weaver") -> str:
    folder = Path(__file__).resolve().parents[2] / "shared" / "weaver_shared" / "robots"
    return (folder / f"{name}.toml").read_text()


def load_changed(folder: Path, old: str, new: str) -> RobotDescription:
    assert old in shipped()
    file = folder / "mine.toml"
    file.write_text(shipped().replace(old, new, 1))
    return load_robot(str(file))


@pytest.mark.parametrize("name", robot_names())
def test_every_shipped_robot_loads(name: str) -> None:
    robot = load_robot(name)
    assert robot.name == name
    assert len(set(robot.joint_names)) == robot.joint_count
    assert robot.dh.shape == (robot.joints_per_leg, 4)
    assert (robot.joint_limits[:, 0] < robot.joint_limits[:, 1]).all()


def test_weaver_is_the_robot_of_the_paper(weaver: RobotDescription) -> None:
    assert weaver.leg_names == ("AR", "BR", "CR", "CL", "BL", "AL")
    assert [joint.name for joint in weaver.joints] == ["yaw", "roll", "femur", "tibia", "tarsus"]
    assert weaver.joint_count == 30
    assert weaver.joint_names[:6] == ("AR_yaw", "AR_roll", "AR_femur", "AR_tibia", "AR_tarsus", "BR_yaw")
    assert weaver.dh[:, 1:3].sum() == pytest.approx(0.34)  # m, leg length
    assert weaver.mass == pytest.approx(10.3)


def test_weaver_stands_symmetrically(weaver: RobotDescription) -> None:
    mirrored = weaver.stance_in_body[::-1] * [1.0, -1.0, 1.0]
    assert_allclose(weaver.stance_in_body, mirrored)
    assert_allclose(weaver.hips_in_body, weaver.hips_in_body[::-1] * [1.0, -1.0, 1.0])
    assert_allclose(weaver.hip_yaws, -weaver.hip_yaws[::-1])


def test_the_cameras_look_forward_and_down(weaver: RobotDescription) -> None:
    left, right = weaver.camera.body_from_left, weaver.camera.body_from_right
    axis = left.rotation @ [0.0, 0.0, 1.0]
    assert axis[0] > 0.0
    assert math.asin(-axis[2]) == pytest.approx(weaver.camera.pitch_down)
    assert_allclose((left.inverse() @ right).position, [weaver.camera.baseline, 0.0, 0.0], atol=1e-12)
    assert np.linalg.det(left.rotation) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("mass = 10.3", "mass = 12.0", "parts add up to 10.30 kg, but the robot is given as 12.00 kg"),
        ("lower = -1.2", "lower = 1.3", "joint yaw: lower limit 1.3 rad is not below upper 1.2 rad"),
        ('servo = "mx64"', 'servo = "ax12"', "servo 'ax12' is not described; described are mx106, mx64"),
        ("clearance = 0.165", "clearance = -1", "clearance: Input should be greater than 0"),
        ("clearance = 0.165", "clearence = 0.165", "clearance: Field required"),
        (
            'gaits = ["tripod"',
            'gaits = ["gallop"',
            "gaits.0: 'gallop' is no gait of a robot with 6 legs; valid are amble",
        ),
        ("rate = 12.5", "rate = 12.5\nbrightness = 3", "camera.brightness: Extra inputs are not permitted"),
        ("[camera]", "[camera", "is not valid TOML"),
        (
            "stance_in_body = [0.278, -0.289]",
            "stance_in_body = [0.6, -0.6]",
            "legs.0.stance_in_body: leg AR comes",
        ),
        ("stall_torque = 10.0", "stall_torque = 0.5", "servos.mx106.stall_torque: joint femur needs"),
        ('name = "BR"', 'name = "AR"', "legs: the name 'AR' stands for more than one"),
        (
            "standing = -0.7",
            "standing = -7.0",
            "joint femur: standing angle -7.0 rad is outside its limits -1.75 to 1.4",
        ),
        (
            "[body]",
            '[[custom_gaits]]\nname = "own"\nduty = 0.6\noffsets = { AR = 0.0 }\n[body]',
            "custom_gaits.own.offsets: has AR; give one for each of the legs AR, BR, CR, CL, BL, AL",
        ),
        ("[locomotion]", "[locomotion]\nlargest_strid = 0.2", "locomotion.largest_strid: Extra inputs"),
    ],
)
def test_a_mistake_is_named(tmp_path: Path, old: str, new: str, sentence: str) -> None:
    with pytest.raises(ConfigurationError) as raised:
        load_changed(tmp_path, old, new)
    assert sentence in str(raised.value)
    assert "\n" not in str(raised.value).replace(str(tmp_path), "")


def test_an_unknown_robot_is_answered_with_the_known_ones() -> None:
    with pytest.raises(ConfigurationError, match=r"robot 'spot' is unknown; known are .*weaver"):
        load_robot("spot")
