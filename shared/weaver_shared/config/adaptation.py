"""Settings of the gait adaptation (ICRA'17 III-E, eqs. 9-11)."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, model_validator

Positive = Annotated[float, Field(gt=0.0)]


class Bounds(BaseModel):
    """Inclusive limits of one parameter and how fast it may change per second."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    lower: Positive
    upper: Positive
    rate: Positive

    @model_validator(mode="after")
    def _ordered(self) -> "Bounds":
        if self.lower >= self.upper:
            raise ValueError(f"lower bound {self.lower} is not below the upper bound {self.upper}")
        return self


class Preset(BaseModel):
    """A change of the whole adaptation that an operator chooses by name."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    stiffness: Positive = 1.0  # factor of the virtual stiffness
    frequency: Positive = 1.0  # factor of the stride frequency
    height: float = 0.0  # m on top of the stride height


USUAL = "usual"
PRESETS = {
    USUAL: Preset(),
    "careful": Preset(stiffness=0.8, frequency=0.6, height=0.02),
    "high steps": Preset(height=0.04),
    "soft": Preset(stiffness=0.5),
}
"""Careful: for ground that gives way or must not be touched; high steps: grass and rubbish that cameras see through."""


class AdaptationConfig(BaseModel):
    """Polynomials over roughness r and step height h, both 0..1, and what keeps the gait calm.

    Flat ground: 2500 N/m, 1.0 Hz, 5 cm. Rough ground: 400 N/m, 0.3 Hz, 14 cm. A foot that carries a third of the
    robot then sinks 1.3 and 8.4 cm.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    stiffness_polynomial: tuple[float, float, float, float] = (2500.0, -4200.0, 3150.0, -1050.0)  # b_0..b_3, N/m
    frequency_polynomial: tuple[float, float, float] = (1.0, -1.1, 0.4)  # c_0..c_2, Hz
    height_polynomial: tuple[float, float, float] = (0.05, 0.06, 0.03)  # d_0, d_1 of h, d_2 of r, m
    virtual_stiffness: Bounds = Bounds(lower=400.0, upper=2500.0, rate=1500.0)  # N/m
    stride_frequency: Bounds = Bounds(lower=0.3, upper=1.0, rate=0.35)  # Hz
    stride_height: Bounds = Bounds(lower=0.05, upper=0.14, rate=0.06)  # m
    presets: dict[str, Preset] = PRESETS
    backlash: Annotated[float, Field(ge=0.0, lt=1.0)] = 0.03  # r and h fall only by what exceeds it; they rise at once
    smallest_health: Annotated[float, Field(ge=0.0, le=1.0)] = 0.3  # of the pictures, below which the gait is safe
    health_time: Positive = 0.5  # s, smooths the health
    full_sigma: Positive = 0.3  # of roughness or step height, at which confidence is gone
