"""OpenSHC's files become robots of ours that stand where OpenSHC's stand, and become the same files again."""

import json

import numpy as np
import pytest
import yaml

from robot_agent.command_line import gait, import_openshc
from robot_agent.locomotion.openshc.configuration import Configuration
from robot_agent.locomotion.openshc.description import configuration_from
from robot_agent.locomotion.openshc.leg import Leg
from robot_agent.locomotion.openshc.mirroring import joint_signs
from robot_agent.locomotion.openshc.reading import read_configuration, sections_of
from robot_agent.locomotion.openshc.shipped import ROBOTS, shipped
from robot_agent.locomotion.openshc.toml import toml_of
from weaver_shared.errors import WeaverError
from weaver_shared.robots import load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body


def written(path, sections):
    path.write_text(yaml.safe_dump(sections))
    return str(path)


def imported(tmp_path, name, *options):
    source, target = written(tmp_path / f"{name}.yaml", sections_of(shipped(name))), tmp_path / f"{name}.toml"
    assert import_openshc.main([source, "--output", str(target), *options]) == 0
    return target


@pytest.mark.parametrize("name", ROBOTS)
def test_an_imported_robot_has_its_feet_where_openshc_has_them(tmp_path, name):
    robot, configuration = load_robot(str(imported(tmp_path, name))), shipped(name)
    lower, upper = robot.joint_limits.T
    angles = lower + np.random.default_rng(0).random((6, len(lower))) * (upper - lower)
    expected = [
        Leg(leg, 0.02, clamp_rate=False, start=angles[k] * joint_signs(configuration.legs[0], leg)).tip()
        for k, leg in enumerate(configuration.legs)
    ]
    # OpenSHC writes a quarter turn as 1.571, 0.2 mrad too much
    np.testing.assert_allclose(feet_in_body(robot, angles.ravel()), expected, atol=2.5e-4)
    assert robot.leg_names == configuration.leg_id
    assert robot.gaits[0] == configuration.gait_type.removesuffix("_gait")


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("suffix", ["yaml", "json"])
def test_the_way_back_gives_what_was_imported(tmp_path, name, suffix):
    target = tmp_path / f"back.{suffix}"
    assert import_openshc.main([str(imported(tmp_path, name)), "--export", "--output", str(target)]) == 0
    assert yaml.safe_load(target.read_text()) == json.loads(json.dumps(sections_of(shipped(name))))
    assert read_configuration([target]) == shipped(name)


def test_a_changed_stance_is_exported(tmp_path):
    file = imported(tmp_path, "default", "--mass", "3")
    file.write_text(
        file.read_text().replace("clearance = 0.1", "clearance = 0.09").replace("0.13, -0.075", "0.12, -0.07")
    )
    robot = load_robot(str(file))
    assert robot.mass == 3.0
    configuration = configuration_from(robot)
    assert configuration.body_clearance == 0.09
    assert (configuration.legs[0].stance.x, configuration.legs[0].stance.y) == (0.12, -0.07)
    assert configuration.legs[1] == shipped("default").legs[1]


def test_an_imported_robot_walks_with_our_walker_and_with_openshc(tmp_path):
    file, table = str(imported(tmp_path, "default")), tmp_path / "out.csv"
    assert gait.main(["--robot", file, "--gait", "tripod", "--velocity", "0.03,0,0", "--csv", str(table)]) == 0
    assert len(table.read_text().splitlines()) == 1 + 401 * 6
    compatible = ["--compat", "openshc-0.5.11", "--velocity", "1,0,0", "--ticks", "20", "--csv", str(table)]
    assert gait.main(["--robot", file, *compatible]) == 0
    of_import = table.read_text()
    assert gait.main(["--robot", "default", *compatible]) == 0
    assert table.read_text() == of_import


def test_separate_files_complete_each_other(tmp_path):
    whole = sections_of(shipped("default"))["syropod"]
    parts = [written(tmp_path / f"{key}.yaml", {"syropod": {key: value}}) for key, value in whole.items()]
    target = tmp_path / "robot.toml"
    assert import_openshc.main([*parts, "--output", str(target)]) == 0
    assert configuration_from(load_robot(str(target))) == shipped("default")


def changed(change):
    sections = json.loads(json.dumps(sections_of(shipped("default"))["syropod"]))
    change(sections)
    return {"syropod": sections}


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda s: s["parameters"].pop("time_delta"), "time_delta: Field required"),
        (lambda s: s["parameters"].update(time_delta=-0.02), r"time_delta: .*greater than 0 \(found -0.02\)"),
        (lambda s: s["parameters"].update(step_heigth=0.1), "parameters.step_heigth: this is no parameter"),
        (lambda s: s["parameters"]["AR_femur_joint_parameters"].pop("max_vel"), "AR_femur_joint_parameters.max_vel"),
        (
            lambda s: s["parameters"]["CL_tibia_link_parameters"].update(r="long"),
            "CL_tibia_link_parameters.r: .*'long'",
        ),
        (lambda s: s["parameters"].pop("BL_stance_position"), "BL_stance_position is missing"),
        (
            lambda s: s["parameters"]["BR_coxa_joint_parameters"].update(min=1.0),
            "BR_coxa_joint_parameters: .*above max",
        ),
        (lambda s: s["parameters"].update(gait_type="gallop"), "'gallop' is not described; described are"),
        (lambda s: s["parameters"].update(leg_DOF={"AR": 9}), "leg_DOF.AR is 9; valid is 1 to 3"),
        (lambda s: s["parameters"]["BR_femur_link_parameters"].update(r=0.2), "BR: link 2"),
        (lambda s: s["gait_parameters"]["wave_gait"].update(swing_phase=0), "gaits.wave_gait.swing_phase"),
        (lambda s: s.pop("gait_parameters"), "gait_parameters: nothing was found"),
    ],
)
def test_an_error_names_the_key_and_what_was_found(tmp_path, change, says):
    source = written(tmp_path / "bad.yaml", changed(change))
    with pytest.raises(WeaverError, match=says):
        import_openshc.main([source, "--output", str(tmp_path / "out.toml")])
    assert not (tmp_path / "out.toml").exists()


@pytest.mark.parametrize(
    ("text", "says"),
    [("a: [", "not valid YAML"), ("a: 1", "none of OpenSHC's sections"), ("- 1", "none of OpenSHC's sections")],
)
def test_a_file_of_something_else_is_refused(tmp_path, text, says):
    source = tmp_path / "bad.yaml"
    source.write_text(text)
    with pytest.raises(WeaverError, match=says):
        import_openshc.main([str(source)])


def test_only_imported_robots_go_back():
    with pytest.raises(WeaverError, match="openshc: this table is missing"):
        import_openshc.main(["weaver", "--export"])


def test_toml_says_what_it_was_given():
    import tomllib

    tables = {
        "a": 1,
        "b c": 'say "hi"',
        "t": {"u": {"v": {"w": [1.5, True]}, "e": {}}},
        "l": [{"x": -0.0}, {"x": 1e-9}],
    }
    assert tomllib.loads(toml_of(tables)) == tables
    assert Configuration.model_validate(shipped("default").model_dump()) == shipped("default")
