"""What may change while OpenSHC runs: parameters that can be adjusted, and whether the ground is felt (facts 3.16)."""

from __future__ import annotations

from robot_agent.locomotion.openshc.configuration import Configuration
from weaver_shared.errors import ConfigurationError

ADJUSTABLE = (
    "step_frequency",
    "swing_height",
    "swing_width",
    "step_depth",
    "stance_span_modifier",
    "virtual_mass",
    "virtual_stiffness",
    "virtual_damping_ratio",
    "force_gain",
)


class Settings:
    """Present values; `description` keeps the defaults and their bounds."""

    def __init__(self, description: Configuration) -> None:
        self.description = description
        self.dt = description.time_delta
        self.step_frequency = description.step_frequency.default
        self.swing_height = description.swing_height.default
        self.swing_width = description.swing_width.default
        self.step_depth = description.step_depth.default
        self.stance_span_modifier = description.stance_span_modifier.default
        self.virtual_mass = description.virtual_mass.default
        self.virtual_stiffness = description.virtual_stiffness.default
        self.virtual_damping_ratio = description.virtual_damping_ratio.default
        self.force_gain = description.force_gain.default
        self.rough_terrain_mode = description.rough_terrain_mode
        self.force_normal_touchdown = description.force_normal_touchdown
        self.feels_ground = False  # until the first contact message

    def adjusted(self, name: str, change: float) -> float:
        """The value of `name` after a request to change it, within its bounds."""
        if name not in ADJUSTABLE:
            raise ConfigurationError(f"{name!r} can not be adjusted; valid are {', '.join(ADJUSTABLE)}")
        bounds = getattr(self.description, name)
        return float(min(max(getattr(self, name) + change, bounds.min), bounds.max))
