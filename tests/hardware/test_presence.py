"""What is missing of a real robot is said before anything is opened, all at once, with what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from robot_agent.hardware.presence import require_devices
from sim_agent.servo_bus.twin_wiring import twin_wiring
from weaver_shared import up
from weaver_shared.config.hardware import HardwareConfig
from weaver_shared.errors import ConfigurationError, ResourceError
from weaver_shared.robots import load_robot


@pytest.fixture
def config(tmp_path: Path) -> HardwareConfig:
    """Two buses, an IMU and a power monitor, all of them there."""
    made = twin_wiring(load_robot("weaver"), tmp_path, clock=tmp_path / "time")
    for name in ("right", "left", "imu", "power"):
        (tmp_path / name).touch()
    return made


def test_nothing_is_said_of_a_robot_that_is_all_there(config: HardwareConfig, tmp_path: Path) -> None:
    require_devices(config, tmp_path)


def test_everything_missing_is_named_with_what_to_do(config: HardwareConfig, tmp_path: Path) -> None:
    plugged = tmp_path / "by-id"
    plugged.mkdir()
    (plugged / "usb-Arduino_1").touch()
    (tmp_path / "left").unlink()
    (tmp_path / "imu").unlink()
    with pytest.raises(ResourceError) as caught:
        require_devices(config, plugged)
    told = str(caught.value)
    assert f"bus left: port {tmp_path / 'left'} is not there; plug it in" in told
    assert "the IMU: port" in told
    assert "bus right" not in told
    assert "usb-Arduino_1" in told


def test_a_computer_without_any_adapter_is_told_so(config: HardwareConfig, tmp_path: Path) -> None:
    (tmp_path / "power").unlink()
    with pytest.raises(ResourceError, match="no serial adapter is plugged in"):
        require_devices(config, tmp_path / "nothing")


def test_a_port_that_is_not_ours_to_use_is_told_with_the_group_to_join(
    config: HardwareConfig, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    closed = tmp_path / "power"
    monkeypatch.setattr("os.access", lambda path, _mode: Path(path) != closed)
    with pytest.raises(ResourceError, match=r"^the power monitor: port .* join its group \(dialout on Debian\)[^;]*$"):
        require_devices(config, tmp_path)


@pytest.mark.parametrize("arguments", [["--robot", "hardware"], ["--robot", "sim", "--wiring", "robot.toml"]])
def test_a_real_robot_needs_its_wiring_and_no_other_takes_one(arguments: list[str]) -> None:
    with pytest.raises(ConfigurationError, match="--wiring FILE"):
        up.main(arguments)


def test_a_wiring_that_can_not_be_read_starts_nothing(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="can not be read"):
        up.main(["--robot", "hardware", "--no-console", "--wiring", str(tmp_path / "none.toml")])
