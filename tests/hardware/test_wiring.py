"""The wiring file: what it may say, and that counts and angles are two names of the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot_agent.hardware.wiring import Wiring, load_wiring
from sim_agent.servo_bus.twin_wiring import twin_wiring, wiring_file
from weaver_shared.config.hardware import ImuLine, PowerLine
from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription, load_robot

ALL = np.arange(30)
WEAVER = load_robot("weaver")
WIRING = Wiring(twin_wiring(WEAVER, Path("/dev")), WEAVER)


def test_angles_come_back_from_their_counts_to_half_a_count() -> None:
    for share in np.linspace(0.0, 1.0, 9):
        angle = WIRING.lower + share * (WIRING.upper - WIRING.lower)
        assert np.abs(WIRING.angle(WIRING.counts(angle, ALL), ALL) - angle).max() <= np.pi / 4096 + 1e-12


def test_goals_never_leave_the_joints_range() -> None:
    for angle in (np.full(30, 9.0), np.full(30, -9.0)):
        counts = WIRING.counts(angle, ALL)
        stops = np.array([WIRING.stops(joint) for joint in ALL])
        assert ((counts >= stops[:, 0]) & (counts <= stops[:, 1])).all()


@given(torque=st.floats(0.0, 12.0))
def test_currents_make_the_torques_they_are_made_of(torque: float) -> None:
    current = WIRING.current(np.full(30, torque), ALL)
    made = np.abs(WIRING.torque(current, ALL))
    capped = current == np.array([model.current_limit for model in WIRING.models])
    assert np.abs(made - torque)[~capped].max(initial=0.0) < 3.36e-3 * 2.2


def test_a_mirrored_servo_turns_the_other_way() -> None:
    straight, mirrored = WIRING.rate(np.full(30, 100), ALL)[:2]
    assert straight == -mirrored == pytest.approx(2.398, rel=1e-3)


def written(tmp_path: Path, **changes: object) -> Path:
    joints = "".join(
        f'[[joints]]\njoint = "{j.joint}"\nbus = "{j.bus}"\nid = {changes.get("id", j.id)}\n'
        for j in WIRING.config.joints
    )
    buses = "".join(f'[[buses]]\nname = "{b.name}"\nport = "{b.port}"\n' for b in WIRING.config.buses)
    path = tmp_path / "robot.toml"
    path.write_text(f'robot = "weaver"\n{changes.get("extra", "")}\n{buses}{joints}')
    return path


def test_a_wiring_file_is_read(tmp_path: Path) -> None:
    config = load_wiring(written(tmp_path))
    assert len(config.joints) == 30
    assert config.servos.watchdog == 0.2


@pytest.mark.parametrize(
    ("changes", "says"),
    [({"id": 5}, "is there twice"), ({"id": 300}, "less than or equal to 252"), ({"extra": "speed = 3"}, "speed")],
)
def test_a_wrong_wiring_file_is_answered_with_what_is_wrong(
    tmp_path: Path, changes: dict[str, object], says: str
) -> None:
    with pytest.raises(ConfigurationError, match=says):
        load_wiring(written(tmp_path, **changes))


def test_a_wiring_comes_back_from_its_file(tmp_path: Path) -> None:
    config = WIRING.config.model_copy(
        update={"imu": ImuLine(kind="gx3", port="/dev/imu"), "power": PowerLine(port="/dev/power")}
    )
    path = tmp_path / "robot.toml"
    path.write_text(wiring_file(config))
    assert load_wiring(path) == config


def test_a_robot_whose_joints_are_not_all_wired_is_refused() -> None:
    robot: RobotDescription = WEAVER
    config = WIRING.config.model_copy(update={"joints": WIRING.config.joints[1:]})
    with pytest.raises(ConfigurationError, match="no servo for AR_yaw"):
        Wiring(config, robot)
