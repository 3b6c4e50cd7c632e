"""OpenSHC's integer step cycle (facts 3.3): whole ticks, so its frequency is off by up to several per cent (D21)."""

from __future__ import annotations

from dataclasses import dataclass

from weaver_shared.errors import ConfigurationError


@dataclass(frozen=True, slots=True, kw_only=True)
class GaitTable:
    """Stance, swing and offset in parts of a stride, and how often each leg takes the offset, AR BR CR CL BL AL."""

    stance: int
    swing: int
    offset: int
    multipliers: tuple[int, ...]


GAITS = {
    "wave_gait": GaitTable(stance=10, swing=2, offset=2, multipliers=(2, 3, 4, 1, 0, 5)),
    "amble_gait": GaitTable(stance=2, swing=1, offset=1, multipliers=(1, 2, 0, 1, 2, 0)),
    "ripple_gait": GaitTable(stance=4, swing=2, offset=1, multipliers=(2, 0, 4, 1, 3, 5)),
    "tripod_gait": GaitTable(stance=2, swing=2, offset=2, multipliers=(0, 1, 0, 1, 0, 1)),
    "bipod_gait": GaitTable(stance=2, swing=4, offset=2, multipliers=(0, 1, 2, 0, 1, 2)),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class StepCycle:
    """Ticks; swing is [swing_start, swing_end)."""

    period: int
    frequency: float  # Hz, really stepped
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

    @staticmethod
    def of(gait: str, step_frequency: float, dt: float) -> StepCycle:
        """The cycle of a named gait. Raises ConfigurationError that names the known ones."""
        if gait not in GAITS:
            raise ConfigurationError(f"gait {gait!r} is not one of OpenSHC's; known are {', '.join(GAITS)}")
        table = GAITS[gait]
        base = table.stance + table.swing
        raw = (1.0 / step_frequency) / dt / (table.swing / base)
        period = even_up(raw / base) * base
        part = period // base
        swing_start = int(table.stance * 0.5) * part
        swing_period = table.swing * part
        return StepCycle(
            period=period,
            frequency=1.0 / (period * dt),
            swing_start=swing_start,
            swing_end=swing_start + swing_period,
            swing_period=swing_period,
            stance_period=table.stance * part,
            offsets=tuple(table.offset * part * multiplier % period for multiplier in table.multipliers),
        )


def even_up(value: float) -> int:
    """Truncate, then add one if the result is odd."""
    whole = int(value)
    return whole + whole % 2
