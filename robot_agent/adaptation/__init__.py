"""Vision-based adaptation of stiffness, stride frequency and stride height (ICRA'17 III-E)."""

from robot_agent.adaptation.controller import AdaptationController
from robot_agent.adaptation.overrides import ParameterOverrides
from robot_agent.adaptation.polynomials import gait_for, safe_gait

__all__ = ["AdaptationController", "ParameterOverrides", "gait_for", "safe_gait"]
