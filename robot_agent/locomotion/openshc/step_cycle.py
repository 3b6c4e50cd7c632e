"""OpenSHC's integer step cycle (facts 3.3): whole ticks, so its frequency is off by up to several per cent (D21)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from robot_agent.locomotion.openshc.configuration import Gait


@dataclass(frozen=True, slots=True, kw_only=True)
class StepCycle:
    """Ticks; swing is [swing_start, swing_end)."""

    period: int
    frequency: float  # Hz, really stepped
    dt: float  # s
    swing_start: int
    swing_end: int
    swing_period: int
    stance_period: int
    offsets: tuple[int, ...]

    @property
    def stance_start(self) -> int:
        return self.swing_end

    @property
    def stance_end(self) -> int:
        return self.swing_start

    @property
    def on_ground_ratio(self) -> float:
        return self.stance_period / self.period

    @property
    def swing_ticks(self) -> int:
        """As OpenSHC counts them again from the frequency, even."""
        return even_up(self.ticks_of(self.swing_period))

    def ticks_of(self, part: int) -> int:
        """Ticks of `part` of the period by way of the frequency; rounding may lose one."""
        return int((part / self.period) / (self.frequency * self.dt))

    @staticmethod
    def of(gait: Gait, step_frequency: float, dt: float, legs: Sequence[str]) -> StepCycle:
        """`step_frequency` (Hz) is one over the swing's time; `legs` gives the offsets' order."""
        base = gait.stance_phase + gait.swing_phase
        raw = (1.0 / step_frequency) / dt / (gait.swing_phase / base)
        period = even_up(raw / base) * base
        part = period // base
        swing_start = int(gait.stance_phase * 0.5) * part
        swing_period = gait.swing_phase * part
        return StepCycle(
            period=period,
            frequency=1.0 / (period * dt),
            dt=dt,
            swing_start=swing_start,
            swing_end=swing_start + swing_period,
            swing_period=swing_period,
            stance_period=gait.stance_phase * part,
            offsets=tuple(gait.phase_offset * part * gait.offset_multiplier[leg] % period for leg in legs),
        )


def even_up(value: float) -> int:
    """Truncate, then add one if the result is odd."""
    whole = int(value)
    return whole + whole % 2
