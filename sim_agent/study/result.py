"""One line of the study: a robot in one gait doing one thing, with what it was asked for and what came of it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

SLOWEST = 0.8
"""Share of the asked speed that counts as walking as told."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Result:
    """Speeds in m/s (turn: rad/s). Margins are None where the gait never has three feet down, or nothing was walked."""

    robot: str
    gait: str
    world: str
    manoeuvre: str  # forward, sideways, turn, or over: up and down all that the world has
    stood: bool
    fell: bool
    sat: bool | None  # None: not tried
    belly_on_ground: bool | None  # when it sat
    asked: float
    achieved: float
    static_margin_mm: float | None  # lowest
    energy_margin_mm: float | None
    largest_tilt_deg: float
    torque_share: float  # largest motor torque over what the servo has
    touches: int  # ticks with anything but a foot on the ground
    seconds: float  # simulated
    real_time_factor: float  # simulated over processor time

    @property
    def ratio(self) -> float:
        return self.achieved / self.asked if self.asked else 0.0

    @property
    def passed(self) -> bool:
        return self.stood and not self.fell and self.sat is not False and self.ratio >= SLOWEST

    def as_dict(self) -> dict[str, Any]:
        return {**asdict(self), "ratio": self.ratio, "passed": self.passed}
