"""Each servo's own settings and health, before and after it is made ready as for a walk."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from robot_agent.hardware.doctor.finding import Finding, Verdict, named, not_tested
from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.servos.port import ServoPort
from robot_agent.hardware.servos.preparation import Preparation
from robot_agent.hardware.servos.registers import Register
from robot_agent.hardware.wiring import Wiring
from weaver_shared.config.safety import SafetyLimits
from weaver_shared.errors import ResourceError

LOW_RAIL = 10.5
"""V at the servos; they shut down at 9.5."""


@dataclass(slots=True)
class ServoState:
    """Joint by joint: what was read before anything was written, and who can take part in the cyclic reading."""

    ready: NDArray[np.bool_]
    found: dict[int, Callable[[Register], int]] = field(default_factory=dict)
    refusals: list[str] = field(default_factory=list)

    @property
    def holding(self) -> bool:
        """Whether any servo has torque: the robot may stand on it."""
        return any(found(r.TORQUE_ENABLE) for found in self.found.values())


def make_ready(wiring: Wiring, ports: Mapping[str, ServoPort]) -> ServoState:
    """Look at every servo on these buses and make it ready, which is done at every start of a robot."""
    state = ServoState(ready=np.zeros(len(wiring.ids), dtype=np.bool_))
    for bus, port in ports.items():
        for joint in map(int, wiring.joints_of(bus)):
            preparation = Preparation(port, wiring.place(joint))
            try:
                state.found[joint] = preparation.look()
                preparation.run()
            except ResourceError as error:
                state.refusals.append(str(error))
            else:
                state.ready[joint] = True
    return state


def judge_readiness(state: ServoState) -> Finding:
    ready, wired = int(state.ready.sum()), state.ready.size
    # A sentence of these says what to do itself.
    return Finding(
        check="servos made ready",
        verdict=Verdict.WRONG if state.refusals else Verdict.GOOD if ready == wired else Verdict.ATTENTION,
        found="; ".join([f"{ready} of {wired} are ready", *state.refusals[:4]]),
        fix="see each servo above" if state.refusals else "",
        figures={"ready": ready, "wired": wired, "refusals": state.refusals},
    )


def judge_return_delay(wiring: Wiring, state: ServoState) -> Finding:
    check = "return delay time"
    if not state.found:
        return not_tested(check, "no servo answers")
    delays = {joint: found(r.RETURN_DELAY) * r.RETURN_DELAY_UNIT * 1e6 for joint, found in state.found.items()}
    slow = [joint for joint, delay in delays.items() if delay > 0.0]
    left = [joint for joint in slow if not state.ready[joint]]
    names = named([wiring.robot.joint_names[joint] for joint in slow])
    if not slow:
        return Finding(check=check, verdict=Verdict.GOOD, found="0 µs everywhere", figures={"longest_us": 0.0})
    longest = max(delays.values())
    return Finding(
        check=check,
        verdict=Verdict.WRONG if left else Verdict.ATTENTION,
        found=f"{len(slow)} servos waited {longest:.0f} µs before they answered ({names})",
        fix="mend what keeps them from being made ready; that sets it to 0" if left else "set to 0 now, and it lasts",
        figures={"longest_us": longest, "slow": len(slow), "left": len(left)},
    )


def judge_supply(wiring: Wiring, state: ServoState, limits: SafetyLimits) -> Finding:
    check = "servo supply and heat"
    if not state.found:
        return not_tested(check, "no servo answers")
    volts = {joint: found(r.PRESENT_VOLTAGE) * r.VOLTAGE_UNIT for joint, found in state.found.items()}
    heat = {joint: found(r.PRESENT_TEMPERATURE) for joint, found in state.found.items()}
    low, hot = min(volts.values()), max(heat.values())
    names = wiring.robot.joint_names
    fixes = []
    if low < LOW_RAIL:
        fixes.append(f"{names[min(volts, key=volts.__getitem__)]} has too little voltage: check converter and plugs")
    if hot >= limits.temperature_warn:
        fixes.append(f"let {names[max(heat, key=heat.__getitem__)]} cool and look for what it pushes against")
    return Finding(
        check=check,
        verdict=Verdict.WRONG if fixes else Verdict.GOOD,
        found=f"{low:.1f} to {max(volts.values()):.1f} V at the servos, the hottest at {hot} °C",
        fix="; ".join(fixes),
        figures={"lowest_v": round(low, 1), "highest_v": round(max(volts.values()), 1), "hottest_c": hot},
    )
