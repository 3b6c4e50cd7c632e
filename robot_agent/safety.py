"""Decides whether the robot may move: allow, hold, sit or cut. Pure: it sees ages and readings and keeps no clock.

The most severe verdict wins, every reason is listed, and a reason vanishes when its cause does. Only the operator's
stop is latched. The same supervisor wraps simulated and real robots.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import degrees, isfinite

from robot_agent.body import Trouble
from weaver_shared.config.safety import SafetyLimits
from weaver_shared.messages import SafetyAction

SEVERITY = {SafetyAction.ALLOW: 0, SafetyAction.HOLD: 1, SafetyAction.SIT: 2, SafetyAction.CUT: 3}


@dataclass(frozen=True, slots=True, kw_only=True)
class SafetyInputs:
    """What the supervisor looks at in one control tick. Ages and silences in s."""

    stop_level: str  # "", "settle" or "cut": the operator's latched stop
    upright: bool  # off its belly: standing up, standing, walking or lowering
    needs_odometry: bool  # a mission is being followed
    operator_silence: float  # since the holder of the lease was last heard; infinite when nobody holds it
    attended: bool  # some operator has been in control since the start
    tilt: float  # rad between the body's z axis and the vertical; NaN unknown
    imu_age: float
    odometry_age: float
    odometry_lost: bool
    joints_missing: float  # longest time any joint has not answered
    power_age: float
    temperature: float  # hottest servo, degrees Celsius
    battery_voltage: float
    troubles: tuple[Trouble, ...] = ()  # what the body itself finds wrong


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What is allowed and why not more; `warnings` do not restrict anything."""

    action: SafetyAction
    reasons: tuple[str, ...]
    warnings: tuple[str, ...]
    attitude_known: bool = True  # whether legs and body may answer to it


class SafetySupervisor:
    """Turns inputs into a verdict each tick; remembers only for how long it has been holding."""

    def __init__(self, limits: SafetyLimits | None = None) -> None:
        self._limits = limits or SafetyLimits()
        self._holding = 0.0

    def step(self, inputs: SafetyInputs, dt: float) -> Verdict:
        findings = list(self._findings(inputs))
        held = any(action is not SafetyAction.ALLOW for action, _ in findings) and inputs.upright and inputs.attended
        self._holding = self._holding + dt if held else 0.0
        if self._holding > self._limits.hold_before_sit:
            findings.append((SafetyAction.SIT, f"held for {self._limits.hold_before_sit:.0f} s"))
        restricting = [finding for finding in findings if finding[0] is not SafetyAction.ALLOW]
        action = max((f[0] for f in restricting), key=SEVERITY.__getitem__, default=SafetyAction.ALLOW)
        return Verdict(
            action=action,
            reasons=tuple(text for _, text in sorted(restricting, key=lambda f: -SEVERITY[f[0]])),
            warnings=tuple(text for kind, text in findings if kind is SafetyAction.ALLOW),
            attitude_known=inputs.imu_age <= self._limits.attitude_age,
        )

    def _findings(self, inputs: SafetyInputs) -> Iterator[tuple[SafetyAction, str]]:
        """Restrictions, and warnings marked ALLOW."""
        yield from self._stop(inputs)
        yield from self._attitude(inputs)
        yield from self._senses(inputs)
        yield from self._body(inputs)
        if inputs.upright and inputs.operator_silence > self._limits.operator_silence:
            yield (
                SafetyAction.HOLD,
                "no operator is in control"
                if not isfinite(inputs.operator_silence)
                else (f"the operator has been silent for {inputs.operator_silence:.1f} s"),
            )

    def _stop(self, inputs: SafetyInputs) -> Iterator[tuple[SafetyAction, str]]:
        if inputs.stop_level == "cut":
            yield SafetyAction.CUT, "stopped by the operator: torque is cut"
        elif inputs.stop_level:
            yield SafetyAction.SIT, "stopped by the operator"

    def _attitude(self, inputs: SafetyInputs) -> Iterator[tuple[SafetyAction, str]]:
        if inputs.imu_age > self._limits.imu_age:
            yield SafetyAction.HOLD, f"the IMU has been silent for {inputs.imu_age:.1f} s"
        if not isfinite(inputs.tilt):
            yield SafetyAction.HOLD, "the attitude is unknown"
        elif inputs.tilt > self._limits.tilt_cut:
            yield SafetyAction.CUT, f"tilted by {degrees(inputs.tilt):.0f} degrees: fallen over"
        elif inputs.tilt > self._limits.tilt_hold:
            yield SafetyAction.HOLD, f"tilted by {degrees(inputs.tilt):.0f} degrees"

    def _senses(self, inputs: SafetyInputs) -> Iterator[tuple[SafetyAction, str]]:
        if not inputs.needs_odometry:
            return
        if inputs.odometry_age > self._limits.odometry_age:
            yield SafetyAction.HOLD, "vision is silent: the robot does not know where it is"
        elif inputs.odometry_lost:
            yield SafetyAction.HOLD, "odometry is lost: the robot does not know where it is"

    def _body(self, inputs: SafetyInputs) -> Iterator[tuple[SafetyAction, str]]:
        limits = self._limits
        for trouble in inputs.troubles:
            yield trouble.action, trouble.text
        if inputs.joints_missing > limits.joints_missing:
            yield SafetyAction.HOLD, f"a servo has not answered for {inputs.joints_missing:.1f} s"
        if inputs.temperature >= limits.temperature_sit:
            yield SafetyAction.SIT, f"a servo is at {inputs.temperature:.0f} degrees Celsius"
        elif inputs.temperature >= limits.temperature_warn:
            yield SafetyAction.ALLOW, f"a servo is at {inputs.temperature:.0f} degrees Celsius"
        if inputs.power_age > limits.power_age:
            yield SafetyAction.SIT, f"the power monitor has been silent for {inputs.power_age:.0f} s"
        elif inputs.power_age > limits.power_warn:
            yield SafetyAction.ALLOW, f"the power monitor has been silent for {inputs.power_age:.0f} s"
        elif inputs.battery_voltage <= limits.battery_off and not inputs.upright:
            yield SafetyAction.CUT, f"the battery is at {inputs.battery_voltage:.1f} V: empty"
        elif inputs.battery_voltage <= limits.battery_sit:
            yield SafetyAction.SIT, f"the battery is at {inputs.battery_voltage:.1f} V"
        elif inputs.battery_voltage <= limits.battery_warn:
            yield SafetyAction.ALLOW, f"the battery is at {inputs.battery_voltage:.1f} V"
