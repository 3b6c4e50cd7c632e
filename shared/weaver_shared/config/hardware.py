"""What a real robot is wired with: its buses, which servo moves which joint, and how the servos are run."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

Positive = Annotated[float, Field(gt=0.0)]


class Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class ServoBus(Strict):
    """One serial adapter; `port` should be a stable name, as in /dev/serial/by-id."""

    name: str
    port: str
    baud: Annotated[int, Field(gt=0)] = 1_000_000  # bit/s


class WiredJoint(Strict):
    """Where a joint's servo hangs and how its counts become the joint's angle."""

    joint: str
    bus: str
    id: Annotated[int, Field(ge=0, le=252)]
    zero: Annotated[int, Field(ge=0, le=4095)] = 2048  # counts at which the joint's angle is 0 rad
    reversed: bool = False  # counts grow as the joint's angle falls


class ServoSettings(Strict):
    """How the servos are run; times in s, speeds in rad/s."""

    operating_mode: Literal["position", "current_position"] = "current_position"
    watchdog: Annotated[float, Field(ge=0.02, le=2.54)] = 0.2  # without a packet for so long a servo stops and holds
    lost_after: Annotated[int, Field(ge=1)] = 5  # cycles without an answer
    retry_period: Positive = 0.5  # between questions to servos that are lost, and to buses that are down
    answer_margin: Positive = 0.004  # waited for answers beyond the time they need on the wire
    start_time: Positive = 2.0  # for torque to come up from its beginning
    start_torque: Annotated[float, Field(gt=0.0, le=1.0)] = 0.3  # of the torque asked for, at the beginning
    start_speed: Positive = 1.0  # at which joints go where they are wanted after torque came on


class ImuLine(Strict):
    """The serial line of a MicroStrain IMU: 3DM-GX3 by its single-byte protocol, GX4 and GX5 by MIP."""

    kind: Literal["gx3", "gx5"]
    port: str
    baud: Annotated[int, Field(gt=0)] = 115_200  # bit/s
    delay: Annotated[float, Field(ge=0.0)] | None = None  # s from a sample to its last byte; None: its time on the wire


class PowerLine(Strict):
    """The serial line of the power monitor (firmware/power_monitor)."""

    port: str


class GenicamCameras(Strict):
    """Two cameras by serial number or address; the primary one exposes freely and triggers the other by a wire."""

    kind: Literal["genicam"]
    left: str
    right: str
    primary: Literal["left", "right"] = "left"
    rate: Positive = 20.0  # Hz
    exposure: Positive = 0.005  # s
    gain: float = 0.0  # dB
    exposure_line: str = "Line2"  # of the primary, that says when it exposes
    trigger_line: str = "Line3"  # of the other


class VideoCameras(Strict):
    """What OpenCV opens, by number or path; without `right` both eyes come side by side in one picture."""

    kind: Literal["video"]
    left: str
    right: str | None = None
    exposure: Annotated[float, Field(ge=0.0)] = 0.0  # s, if it is known


class ReplayedCameras(Strict):
    """The stereo pictures of a recording."""

    kind: Literal["replay"]
    recording: str


class EmulatedRobot(Strict):
    """That the devices are emulated, and the file in which their time stands."""

    clock: str


class HardwareConfig(Strict):
    robot: str
    buses: Annotated[tuple[ServoBus, ...], Field(min_length=1)]
    joints: tuple[WiredJoint, ...]
    servos: ServoSettings = ServoSettings()
    imu: ImuLine | None = None
    power: PowerLine | None = None
    cameras: Annotated[GenicamCameras | VideoCameras | ReplayedCameras, Field(discriminator="kind")] | None = None
    emulated: EmulatedRobot | None = None  # not for robots that exist

    @model_validator(mode="after")
    def _consistent(self) -> HardwareConfig:
        names = [bus.name for bus in self.buses]
        for what, values in (
            ("bus", names),
            ("port", [line.port for line in (*self.buses, self.imu, self.power) if line is not None]),
            ("joint", [wired.joint for wired in self.joints]),
            ("servo", [f"{wired.id} on bus {wired.bus}" for wired in self.joints]),
        ):
            twice = {value for value in values if values.count(value) > 1}
            if twice:
                raise ValueError(f"{what} {min(twice)} is there twice")
        for wired in self.joints:
            if wired.bus not in names:
                raise ValueError(f"joint {wired.joint}: bus {wired.bus!r} is unknown; known are {', '.join(names)}")
        return self
