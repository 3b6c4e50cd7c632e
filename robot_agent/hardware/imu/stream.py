"""A MicroStrain IMU as a source of samples: started, stamped by its own clock, silent when it can not be trusted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.imu import gx3, mip
from robot_agent.hardware.imu.clock_map import ClockMap
from robot_agent.hardware.imu.record import InertialRecord
from robot_agent.hardware.serial_line import ByteLine
from weaver_shared.messages import ImuBatch

Z_DOWN = np.diag([1.0, -1.0, -1.0])
"""Turns the vendor's axes, x forward and z down, into ours, z up."""
FROZEN = 10
"""Samples that are the same to the last bit: a sensor has noise, so it has died with its line alive."""
WAKING_NS = 1_000_000_000
"""After so long without a sample the device is told again to send."""


class Parser(Protocol):
    def feed(self, data: bytes) -> list[InertialRecord]: ...


class MicroStrainImu:
    """A `robot_agent.hardware.sources.InertialSource`. `begin` are the commands that make the device send."""

    def __init__(
        self,
        line: ByteLine,
        parser: Callable[[], Parser],
        begin: Sequence[bytes],
        *,
        imu_from_sensor: NDArray[np.float64] = Z_DOWN,
        delay: float = 0.0,
    ) -> None:
        """`delay`: s from a sample to its last byte here, on a computer that loses no time."""
        self._line = line
        self._make_parser = parser
        self._parser = parser()
        self._begin = begin
        self._turn = imu_from_sensor
        self._delay_ns = round(delay * 1e9)
        self._clock = ClockMap()
        self._heard_ns: int | None = None
        self._stamp_ns = 0
        self._last: InertialRecord | None = None
        self._same = 0

    def take(self, now_ns: int) -> ImuBatch:
        """Samples since the last call in the IMU's axes; stamps rise, also where the device's clock began anew."""
        records = self._parser.feed(self._line.receive(now_ns))
        if records:
            self._heard_ns = now_ns
        elif self._heard_ns is None or now_ns - self._heard_ns > WAKING_NS:
            self._wake(now_ns)
        for record in records:
            self._clock.observe(record.device_ns, now_ns)
        kept = [(stamp, record) for record in records if (stamp := self._judge(record, now_ns)) is not None]
        if not kept:
            return ImuBatch.empty()
        return ImuBatch(
            stamp_ns=np.array([stamp for stamp, _ in kept], dtype=np.int64),
            angular_velocity_in_imu=np.array([record.angular_velocity for _, record in kept]) @ self._turn.T,
            specific_force_in_imu=np.array([record.specific_force for _, record in kept]) @ self._turn.T,
        )

    def close(self) -> None:
        self._line.close()

    def _wake(self, now_ns: int) -> None:
        self._parser = self._make_parser()
        for command in self._begin:
            self._line.send(command)
        self._heard_ns = now_ns

    def _judge(self, record: InertialRecord, now_ns: int) -> int | None:
        """The record's stamp, or None where it is not to be used."""
        last, self._last = self._last, record
        same = last is not None and (last.specific_force, last.angular_velocity) == (
            record.specific_force,
            record.angular_velocity,
        )
        self._same = self._same + 1 if same else 0
        stamp_ns = self._clock.at(record.device_ns) - self._delay_ns
        # Beyond now are those from before a restart of the device that came together with one from after it.
        if self._same >= FROZEN or not self._stamp_ns < stamp_ns <= now_ns:
            return None
        self._stamp_ns = stamp_ns
        return stamp_ns


def gx3_imu(line: ByteLine, rate: int, delay: float = 0.0) -> MicroStrainImu:
    """A 3DM-GX3-25 sending `rate` Hz."""
    begin = [gx3.STOP, gx3.sampling(rate), gx3.start_streaming()]
    return MicroStrainImu(line, gx3.Gx3Parser, begin, delay=delay)


def gx5_imu(line: ByteLine, rate: int, delay: float = 0.0) -> MicroStrainImu:
    """A 3DM-GX4 or GX5 sending `rate` Hz."""
    begin = [mip.idle(), mip.message_format(rate), mip.start_streaming()]
    return MicroStrainImu(line, mip.MipParser, begin, delay=delay)
