"""Compiles the kernels of OpenSHC's legs."""

from __future__ import annotations

from robot_agent.locomotion.openshc.leg import Leg
from robot_agent.locomotion.openshc.shipped import shipped


def warm_up() -> None:
    """One step of a leg, with and without a direction for its tip."""
    description = shipped("bullet_insectoid")
    leg = Leg(description.legs[0], description.time_delta, clamp_rate=True)
    leg.step_to(leg.tip(), leg.tip_frame()[:3, 2])
