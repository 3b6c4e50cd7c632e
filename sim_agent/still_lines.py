"""Sensors of a robot that stands still, on lines that say what is due when somebody listens."""

from __future__ import annotations

import numpy as np

from sim_agent.sensor_lines import DirectLine, EmulatedGx3, EmulatedGx5, EmulatedPowerMonitor
from sim_agent.sensors import InertialSensor
from weaver_shared.robots.description import Imu

_UPRIGHT, _RESTING = np.eye(3), np.zeros(3)


class StillImuLine(DirectLine):
    """The described IMU at rest, upright, with its noise; silent until told to send."""

    def __init__(self, device: EmulatedGx3 | EmulatedGx5, imu: Imu, *, seed: int = 0, speed: float = 1.0) -> None:
        super().__init__(device)
        self._imu = device
        self._sensor = InertialSensor(imu, np.random.default_rng(seed))
        self._sensor.begin(_UPRIGHT, _RESTING)
        self._period_ns = round(1e9 / imu.rate / speed)
        self._due_ns: int | None = None

    def receive(self, now_ns: int) -> bytes:
        due_ns = now_ns + self._period_ns if self._due_ns is None else self._due_ns
        while due_ns <= now_ns:
            self._sensor.sample(due_ns, _UPRIGHT, _RESTING)
            due_ns += self._period_ns
        self._due_ns = due_ns
        for record in self._imu.records(self._sensor.take()):
            self.put(record)
        return super().receive(now_ns)


class StillPowerLine(DirectLine):
    """A power monitor that sees a constant battery, 90 times a second."""

    def __init__(self, *, voltage: float = 27.0, current: float = 3.0) -> None:
        self.monitor = EmulatedPowerMonitor()
        super().__init__(self.monitor)
        self.voltage, self.current = voltage, current
        self._due_ns: int | None = None

    def receive(self, now_ns: int) -> bytes:
        due_ns = now_ns if self._due_ns is None else self._due_ns
        while due_ns <= now_ns:
            self.put(self.monitor.line(due_ns, self.voltage, self.current))
            due_ns += 11_111_000
        self._due_ns = due_ns
        return super().receive(now_ns)
