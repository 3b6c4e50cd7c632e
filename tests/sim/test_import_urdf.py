"""A URDF becomes a robot of ours whose feet are where the URDF has them; what can not be one is told apart clearly."""

from __future__ import annotations

import json
import re
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robot_agent.command_line.import_urdf import main
from robot_agent.locomotion.soak.robots import random_robot
from sim_agent.model import robot_urdf
from weaver_shared.errors import InputError, WeaverError
from weaver_shared.robots import RobotDescription, load_robot, robot_names
from weaver_shared.robots.forward_kinematics import feet_in_body
from weaver_shared.robots.urdf import ImportedRobot, robot_of_urdf
from weaver_shared.robots.urdf import robot as urdf_robot


def imported(robot: RobotDescription) -> ImportedRobot:
    return robot_of_urdf(robot_urdf(robot).encode(), f"{robot.name}.urdf")


@pytest.mark.parametrize("name", robot_names())
def test_every_shipped_robot_comes_back_with_the_same_feet_masses_and_limits(name: str) -> None:
    robot = load_robot(name)
    back = imported(robot)
    again = RobotDescription.model_validate(back.tables)
    assert again.joint_names == robot.joint_names
    assert all(one.sign == 1.0 and one.offset == 0.0 for one in back.joints)
    np.testing.assert_allclose(again.joint_limits, robot.joint_limits)
    rng = np.random.default_rng(3)
    for _ in range(20):
        angles = rng.uniform(*robot.joint_limits.T, size=(robot.leg_count, robot.joints_per_leg))
        np.testing.assert_allclose(feet_in_body(again, angles), feet_in_body(robot, angles), rtol=0, atol=1e-9)
    assert again.mass == pytest.approx(robot.body.mass + robot.leg_count * sum(j.mass for j in robot.joints))
    for mine, theirs in zip(again.joints, robot.joints, strict=True):
        assert mine.mass == pytest.approx(theirs.mass)
        assert again.servos[mine.servo].stall_torque == robot.servos[theirs.servo].stall_torque
        assert again.servos[mine.servo].no_load_speed == robot.servos[theirs.servo].no_load_speed
    assert again.foot_radius == pytest.approx(robot.foot_radius)


@pytest.mark.parametrize("seed", range(6))
def test_random_robots_keep_their_feet_too(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Skew axes, any number of legs and joints; whether such a robot can stand is not asked."""
    monkeypatch.setattr(urdf_robot, "_stand", lambda tables, robot: None)
    robot = random_robot(np.random.default_rng(seed), seed)
    back = imported(robot)
    again = RobotDescription.model_validate(back.tables)
    assert back.deviation < 1e-9
    rng = np.random.default_rng(seed)
    angles = dict(
        zip(robot.joint_names, rng.uniform(*np.tile(robot.joint_limits, (robot.leg_count, 1)).T), strict=True)
    )
    ours = [one.sign * angles[one.urdf_name] + one.offset for one in back.joints]
    mine = dict(zip(again.leg_names, feet_in_body(again, np.array(ours)), strict=True))
    theirs = dict(zip(robot.leg_names, feet_in_body(robot, np.array(list(angles.values()))), strict=True))
    by_urdf = {one.urdf_name.rpartition("_")[0]: one.name for one in back.joints}
    for leg, foot in theirs.items():
        own = next(name for name in mine if by_urdf[leg].startswith(name))
        np.testing.assert_allclose(mine[own], foot, atol=1e-9)


QUADRUPED = Path(__file__).with_name("quadruped.urdf")


def test_a_quadruped_whose_left_legs_turn_as_the_right_ones_do() -> None:
    """All hips roll about +x and all knees pitch about +y, as robots are usually drawn; a footprint lies under them."""
    back = robot_of_urdf(QUADRUPED.read_bytes(), QUADRUPED.name)
    robot = RobotDescription.model_validate(back.tables)
    assert robot.leg_names == ("FR", "RR", "RL", "FL")
    assert [joint.name for joint in robot.joints] == ["hip", "thigh", "calf"]
    assert {one.urdf_name for one in back.joints if one.sign < 0.0} == {"RL_hip", "FL_hip"}
    assert not any(one.offset for one in back.joints)
    straight = feet_in_body(robot, np.zeros(12))
    np.testing.assert_allclose(straight[:, :2], [(0.2, -0.13), (-0.2, -0.13), (-0.2, 0.13), (0.2, 0.13)], atol=1e-9)
    np.testing.assert_allclose(straight[:, 2], -0.4, atol=1e-9)
    assert robot.body.mass == pytest.approx(5.5)  # the camera on the trunk counts
    assert robot.clearance > 0.2
    assert robot.joint_limits[1].tolist() == [-1.0, 2.5]


def test_the_command_writes_a_robot_that_can_be_used(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "own.toml"
    assert main([str(QUADRUPED), "--out", str(out), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["legs"] == ["FR", "RR", "RL", "FL"]
    assert report["deviation_m"] < 1e-9
    robot = load_robot(str(out))
    assert robot.gaits[0] == "trot"
    assert "# RL_hip = -RL_hip" in out.read_text()
    assert main([str(QUADRUPED)]) == 0
    assert capsys.readouterr().out == out.read_text()


def changed(old: str, new: str, *, count: int = 1) -> bytes:
    text = QUADRUPED.read_text()
    assert old in text
    return text.replace(old, new, count).encode()


@pytest.mark.parametrize(
    ("document", "complaint"),
    [
        (b"", "is not XML"),
        (b"<robot>", "is not XML"),
        (b"<sdf/>", "the outermost element is <sdf>; valid is <robot>"),
        (b"<robot name='x'/>", "there is no <link>"),
        (b'<!DOCTYPE robot [<!ENTITY a "b">]><robot>&a;</robot>', "document type"),
        (
            b'<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="/etc/passwd"/></robot>',
            "run xacro",
        ),
        (
            changed('type="revolute"', 'type="prismatic"', count=4),
            r"2 legs hang from 'trunk'; valid are 3 to 8 .* no legs are .*'FR_hip' with a fork or a sliding joint",
        ),
        (changed('type="revolute"', 'type="hinge"'), r"joint 'FR_hip': type 'hinge' is unknown; known are revolute"),
        (changed('lower="-0.8" upper="0.8"', 'lower="0.8" upper="-0.8"'), r"joint 'FR_hip': limit lower 0.8 rad"),
        (changed('lower="-0.8" upper="0.8"', 'lower="a" upper="0.8"'), r"joint 'FR_hip': limit lower is 'a'"),
        (changed('axis xyz="1 0 0"', 'axis xyz="0 0 0"'), r"joint 'FR_hip': axis xyz has no length"),
        (changed('axis xyz="1 0 0"', 'axis xyz="1 0"'), r"joint 'FR_hip': axis xyz is '1 0'; valid are three numbers"),
        (changed('xyz="0.2 -0.08 0"', 'xyz="0.2 nan 0"'), r"joint 'FR_hip': origin xyz is 'nan'"),
        (changed('child link="FR_hip_link"', 'child link="nobody"'), r"joint 'FR_hip': its child link 'nobody'"),
        (
            changed('"trunk"/><child link="FR_hip_link"', '"FR_foot"/><child link="FR_hip_link"'),
            r"link 'FR_calf_link' does not hang from the trunk",
        ),
        (
            changed('child link="RR_hip_link"', 'child link="FR_hip_link"'),
            r"hangs from the joints 'FR_hip' and 'RR_hip'",
        ),
        (changed('mass value="0.5"', 'mass value="-0.5"'), r"inertial mass is -0.5 kg; valid is 0 or more"),
        (changed('xyz="0 0 -0.2"', 'xyz="0 0 -0.25"'), r"is not built as the first one or its mirror image"),
        (changed("<limit ", "<limits "), r"joint 'FR_hip': it has no <limit>"),
        (changed('name="FR_hip" ', ""), r"a <joint> has no name"),
        (changed('name="RR_hip"', 'name="FR_hip"'), r"joint 'FR_hip' is described twice"),
    ],
)
def test_errors_name_what_was_found_and_what_is_valid(document: bytes, complaint: str) -> None:
    with pytest.raises(InputError) as error:
        robot_of_urdf(document, "own.urdf")
    assert re.search(complaint, str(error.value)), str(error.value)
    assert "\n" not in str(error.value) or "not XML" in str(error.value)


NUMBERS = st.sampled_from(["", "nan", "inf", "-1e308", "1e308", "0", "-3", "x", "0 0", "1 2 3", "0 0 0 0"])


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow], derandomize=True)
@given(st.data())
def test_broken_documents_are_refused_in_one_sentence_or_read(data: st.DataObject) -> None:
    """Attributes changed, elements dropped, doubled or moved, and bytes cut: never another exception."""
    root = Xml.fromstring(QUADRUPED.read_text())
    for _ in range(data.draw(st.integers(1, 3))):
        elements = [one for one in root.iter() if one is not root]
        element = elements[data.draw(st.integers(0, len(elements) - 1))]
        parents = {child: parent for parent in root.iter() for child in parent}
        what = data.draw(st.sampled_from(["attribute", "drop", "double", "empty"]))
        if what == "attribute" and element.attrib:
            key = data.draw(st.sampled_from(sorted(element.attrib)))
            element.set(key, data.draw(st.one_of(NUMBERS, st.sampled_from(["trunk", "FR_hip", "fixed", "revolute"]))))
        elif what == "drop":
            parents[element].remove(element)
        elif what == "double":
            parents[element].append(element)
        else:
            element.attrib.clear()
    text = Xml.tostring(root)
    if data.draw(st.integers(0, 9)) == 0:
        text = text[: data.draw(st.integers(0, len(text)))]
    try:
        back = robot_of_urdf(text, "own.urdf")
    except WeaverError as error:
        said = str(error)
    else:
        said = "read"
        assert np.isfinite(feet_in_body(RobotDescription.model_validate(back.tables), np.zeros(12))).all()
    assert 0 < len(said) < 700
