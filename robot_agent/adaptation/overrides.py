"""What an operator sets instead of the adaptation, for a time, and the preset that changes all of it."""

from __future__ import annotations

import dataclasses
import math

from robot_agent.adaptation.controller import rate_limited
from robot_agent.adaptation.polynomials import PARAMETERS
from weaver_shared.config.adaptation import USUAL, AdaptationConfig
from weaver_shared.errors import InputError
from weaver_shared.messages import AdaptationReport

UNITS = {"virtual_stiffness": "N/m", "stride_frequency": "Hz", "stride_height": "m"}


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Override:
    """A held value and the robot's time it ends at."""

    value: float
    until_ns: int


class ParameterOverrides:
    """Holds overrides by name; taking hold and handing back are limited in rate, so the gait never jumps."""

    def __init__(self, config: AdaptationConfig = AdaptationConfig()) -> None:  # noqa: B008
        self._config = config
        self._held: dict[str, Override] = {}
        self._preset = USUAL
        self._applied: dict[str, float] = {}
        self._stamp_ns: int | None = None

    def set(self, name: str, value: float, until_ns: int) -> None:
        """Hold `name` at `value` until the robot's time `until_ns`.

        Raises InputError for an unknown name or a value outside its range, naming what is valid.
        """
        if name not in PARAMETERS:
            raise InputError(f"parameter {name!r} is unknown; known are {', '.join(PARAMETERS)}")
        bounds = getattr(self._config, name)
        if not math.isfinite(value) or not bounds.lower <= value <= bounds.upper:
            raise InputError(f"{name} {value:g} is outside {bounds.lower:g} to {bounds.upper:g} {UNITS[name]}")
        self._held[name] = Override(value=float(value), until_ns=until_ns)

    def clear(self, name: str) -> None:
        """Hand `name` back to the adaptation; nothing happens if it was not held. Raises InputError if unknown."""
        if name not in PARAMETERS:
            raise InputError(f"parameter {name!r} is unknown; known are {', '.join(PARAMETERS)}")
        self._held.pop(name, None)

    def choose(self, preset: str) -> None:
        """Change the adaptation by a preset until another is chosen. Raises InputError if unknown."""
        if preset not in self._config.presets:
            raise InputError(f"preset {preset!r:.40} is unknown; known are {', '.join(self._config.presets)}")
        self._preset = preset

    @property
    def held(self) -> dict[str, Override]:
        return dict(self._held)

    def apply(self, report: AdaptationReport, stamp_ns: int) -> AdaptationReport:
        """The report with `applied` and `overridden` filled in for the time `stamp_ns`."""
        dt = 0.0 if self._stamp_ns is None else max(0.0, (stamp_ns - self._stamp_ns) * 1e-9)
        self._stamp_ns = stamp_ns
        self._held = {name: held for name, held in self._held.items() if stamp_ns < held.until_ns}
        for name in PARAMETERS:
            desired = self._by_preset(name, getattr(report.desired, name))
            wanted = self._held[name].value if name in self._held else desired
            step = getattr(self._config, name).rate * dt
            self._applied[name] = rate_limited(self._applied.get(name, desired), wanted, step)
        return dataclasses.replace(
            report,
            stamp_ns=stamp_ns,
            applied=dataclasses.replace(report.desired, stamp_ns=stamp_ns, **self._applied),
            overridden=tuple(name for name in PARAMETERS if name in self._held),
            preset=self._preset,
        )

    def _by_preset(self, name: str, value: float) -> float:
        """What the preset makes of an adapted value, within its range."""
        preset, bounds = self._config.presets[self._preset], getattr(self._config, name)
        changed = {
            "virtual_stiffness": preset.stiffness * value,
            "stride_frequency": preset.frequency * value,
            "stride_height": value + preset.height,
        }
        return float(min(max(changed[name], bounds.lower), bounds.upper))
