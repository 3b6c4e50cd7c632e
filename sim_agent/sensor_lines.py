"""Devices on serial lines that are not there: MicroStrain IMUs and the power monitor, as the bytes they send."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from robot_agent.hardware.imu import gx3, mip
from robot_agent.hardware.imu.record import HIGHEST_FORCE, HIGHEST_RATE, STANDARD_GRAVITY
from robot_agent.hardware.imu.stream import Z_DOWN
from robot_agent.hardware.power_monitor import (
    CLOSE_RELAY,
    HEARTBEAT,
    J_PER_MWH,
    OPEN_RELAY,
    RELAY_CLOSED,
    PowerRecord,
    encode,
)
from robot_agent.hardware.serial_line import ByteLine
from weaver_shared.messages import ImuBatch, Proprioception


class Device(Protocol):
    def obey(self, command: bytes) -> bytes:
        """The answers to commands, which come whole."""
        ...


class SensorLine(ByteLine, Protocol):
    """Both ends of a line: `put` is the device's."""

    def put(self, data: bytes) -> None: ...


class DirectLine:
    """A serial line that is a function call away: `put` on the device's end, a `ByteLine` on the other."""

    def __init__(self, device: Device) -> None:
        self._device = device
        self._coming = b""
        self.openings = 1
        self.plugged = True

    def put(self, data: bytes) -> None:
        self._coming += data

    def receive(self, now_ns: int) -> bytes:
        taken, self._coming = self._coming, b""
        return taken if self.plugged else b""

    def send(self, data: bytes) -> bool:
        if self.plugged:
            self._coming += self._device.obey(data)
        return self.plugged

    def close(self) -> None:
        self.plugged = False


def _records(record: Callable[[int, np.ndarray, np.ndarray], bytes], batch: ImuBatch) -> list[bytes]:
    """Of what is beyond its range a sensor tells the end of the range."""
    forces = np.clip(batch.specific_force_in_imu, -HIGHEST_FORCE, HIGHEST_FORCE)
    rates = np.clip(batch.angular_velocity_in_imu, -HIGHEST_RATE, HIGHEST_RATE)
    samples = zip(batch.stamp_ns, forces, rates, strict=True)
    return [record(int(stamp_ns), force, rate) for stamp_ns, force, rate in samples]


class EmulatedGx3:
    """Sends a record for each sample once it was told to; its orientation is that of its own start."""

    def __init__(self, *, timer_ticks: int = 0) -> None:
        self._timer_offset = timer_ticks
        self.streaming = False

    def obey(self, command: bytes) -> bytes:
        answer = b""
        if gx3.STOP in command:
            self.streaming = False
        if gx3.start_streaming() in command:
            self.streaming = True
            reply = command[command.find(gx3.start_streaming()) :][:1] + bytes([gx3.MOTION]) + bytes(4)
            answer += reply + gx3.sum_of(reply).to_bytes(2, "big")
        return answer

    def records(self, batch: ImuBatch) -> list[bytes]:
        return _records(self.record, batch) if self.streaming else []

    def record(self, stamp_ns: int, force: np.ndarray, rate: np.ndarray) -> bytes:
        """One record of m/s^2 and rad/s in our axes."""
        ticks = self._timer_offset + stamp_ns * gx3.TICKS_PER_SECOND // 1_000_000_000
        values = np.concatenate([Z_DOWN.T @ force / STANDARD_GRAVITY, Z_DOWN.T @ rate, np.eye(3).ravel()])
        message = struct.pack(">B15fI", gx3.MOTION, *values, ticks % gx3.TIMER_RANGE)
        return message + gx3.sum_of(message).to_bytes(2, "big")


class EmulatedGx5:
    """The same in MIP; answers every command with an acknowledgement."""

    def __init__(self) -> None:
        self.streaming = False

    def obey(self, command: bytes) -> bytes:
        answer = b""
        if mip.idle() in command:
            self.streaming = False
            answer += mip.packet(mip.BASE, (mip.REPLY, b"\x02\x00"))
        if mip.start_streaming() in command:
            self.streaming = True
            answer += mip.packet(mip.THREE_DM, (mip.REPLY, b"\x11\x00"))
        return answer

    def records(self, batch: ImuBatch) -> list[bytes]:
        return _records(self.record, batch) if self.streaming else []

    def record(self, stamp_ns: int, force: np.ndarray, rate: np.ndarray) -> bytes:
        acceleration = struct.pack(">3f", *(Z_DOWN.T @ force / STANDARD_GRAVITY))
        turning = struct.pack(">3f", *(Z_DOWN.T @ rate))
        time = struct.pack(">dHH", stamp_ns * 1e-9, 0, 0)
        return mip.packet(
            mip.SENSOR, (mip.ACCELERATION, acceleration), (mip.ANGULAR_RATE, turning), (mip.GPS_TIME, time)
        )


class EmulatedPowerMonitor:
    """Sums up energy as the Arduino does and sends a line for each reading it is given."""

    def __init__(self) -> None:
        self._sequence = 0
        self._energy = 0.0  # J
        self._last_ns: int | None = None
        self.heartbeats = 0
        self.relay_closed = True
        self.on_relay: Callable[[bool], None] = lambda closed: None
        """Called with whether it is closed now."""

    def obey(self, command: bytes) -> bytes:
        self.heartbeats += command == HEARTBEAT
        if command in (OPEN_RELAY, CLOSE_RELAY):
            self.relay_closed = command == CLOSE_RELAY
            self.on_relay(self.relay_closed)
        return b""

    def line(self, now_ns: int, voltage: float, current: float) -> bytes:
        if self._last_ns is not None:
            self._energy += voltage * current * (now_ns - self._last_ns) * 1e-9
        self._last_ns = now_ns
        self._sequence += 1
        return encode(
            PowerRecord(
                self._sequence,
                now_ns // 1_000_000,
                round(voltage * 1e3),
                round(current * 1e3),
                round(self._energy / J_PER_MWH),
                RELAY_CLOSED if self.relay_closed else 0,
            )
        )

    def of(self, now_ns: int, sensed: Proprioception) -> bytes:
        return self.line(now_ns, sensed.battery_voltage, sensed.supply_current)


@dataclass(slots=True)
class SensorTroubles:
    """What goes wrong with the sensors; 0: nothing."""

    imu_silent: float = 0.0
    imu_frozen: float = 0.0  # 1: the same reading again and again
    imu_clock: float = 0.0  # s by which the device's clock is ahead
    power_silent: float = 0.0
    battery: float = 0.0  # V that the monitor sees instead of what there is


class TwinSensors:
    """IMU and power monitor of a simulated body, each on a line that a hardware body reads.

    `line` makes the lines called "imu" and "power" of their devices.
    """

    def __init__(
        self,
        imu: EmulatedGx3 | EmulatedGx5,
        line: Callable[[str, Device], SensorLine] = lambda _name, device: DirectLine(device),
    ) -> None:
        self.imu, self.monitor = imu, EmulatedPowerMonitor()
        self.troubles = SensorTroubles()
        self._frozen: ImuBatch | None = None
        self.imu_line, self.power_line = line("imu", imu), line("power", self.monitor)

    def hear(self, now_ns: int, sensed: Proprioception) -> None:
        """Send what the simulated body felt in a tick."""
        troubles = self.troubles
        if not troubles.imu_silent:
            for record in self.imu.records(self._measured(sensed.imu)):
                self.imu_line.put(record)
        if not troubles.power_silent:
            voltage = troubles.battery or sensed.battery_voltage
            self.power_line.put(self.monitor.line(now_ns, voltage, sensed.supply_current))

    def _measured(self, batch: ImuBatch) -> ImuBatch:
        if not self.troubles.imu_frozen:
            self._frozen = None
        elif batch.stamp_ns.size:
            self._frozen = self._frozen or batch
            count = batch.stamp_ns.size
            batch = replace(
                batch,
                angular_velocity_in_imu=np.repeat(self._frozen.angular_velocity_in_imu[:1], count, axis=0),
                specific_force_in_imu=np.repeat(self._frozen.specific_force_in_imu[:1], count, axis=0),
            )
        ahead_ns = round(self.troubles.imu_clock * 1e9)
        return replace(batch, stamp_ns=batch.stamp_ns + ahead_ns) if ahead_ns else batch
