"""A wiring for a robot that does not exist: a bus for each side, and servos mounted as differently as real ones."""

from __future__ import annotations

import json
import zlib
from pathlib import Path

from robot_agent.hardware.servos.registers import CENTRE
from weaver_shared.config.hardware import (
    EmulatedRobot,
    GenicamCameras,
    HardwareConfig,
    ImuLine,
    PowerLine,
    ServoBus,
    ServoSettings,
    WiredJoint,
)
from weaver_shared.robots import RobotDescription


def twin_wiring(
    robot: RobotDescription,
    folder: Path,
    *,
    baud: int = 3_000_000,
    settings: ServoSettings | None = None,
    clock: Path | None = None,
    cameras: bool = False,
) -> HardwareConfig:
    """Legs right of the body on one bus and left of it on the other; ports are names in `folder`.

    With `clock`, where the time stands, IMU and power monitor have lines too; with `cameras`, two of GigE Vision.
    """
    sides = ["right" if leg.hip_in_body[1] < 0.0 else "left" for leg in robot.legs]
    joints = []
    for index, name in enumerate(robot.joint_names):
        side = sides[index // robot.joints_per_leg]
        # Horns go onto their shafts in steps of 4 degrees, and half of the servos look the other way.
        zero = CENTRE + 45 * (index % 5 - 2)
        joints.append(WiredJoint(joint=name, bus=side, id=index + 1, zero=zero, reversed=index % 2 == 1))
    return HardwareConfig(
        robot=robot.name,
        buses=tuple(ServoBus(name=side, port=str(folder / side), baud=baud) for side in ("right", "left")),
        joints=tuple(joints),
        servos=settings or ServoSettings(),
        imu=ImuLine(kind="gx5", port=str(folder / "imu"), delay=0.0) if clock is not None else None,
        power=PowerLine(port=str(folder / "power")) if clock is not None else None,
        cameras=_cameras(robot, folder) if cameras else None,
        emulated=EmulatedRobot(clock=str(clock)) if clock is not None else None,
    )


def _cameras(robot: RobotDescription, folder: Path) -> GenicamCameras:
    """On addresses of this computer alone, others for each folder: the protocol knows but one port."""
    network = zlib.crc32(str(folder).encode())
    address = f"127.{64 + network % 128}.{network // 128 % 256}."
    return GenicamCameras(kind="genicam", left=address + "1", right=address + "2", rate=robot.camera.rate)


def wiring_file(config: HardwareConfig) -> str:
    """A wiring as the text of its file."""
    values = config.model_dump(mode="json", exclude_none=True)
    parts = [f"robot = {json.dumps(values.pop('robot'))}"]
    for key, value in values.items():
        for table in value if isinstance(value, list) else [value]:
            head = f"[[{key}]]" if isinstance(value, list) else f"[{key}]"
            # Strings, numbers and booleans are written in TOML as in JSON.
            parts.append("\n".join([head, *(f"{name} = {json.dumps(entry)}" for name, entry in table.items())]))
    return "\n\n".join(parts) + "\n"
