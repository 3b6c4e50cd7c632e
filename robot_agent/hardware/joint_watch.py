"""What is believed of every joint, and for how long it has been so."""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from robot_agent.body import Trouble
from robot_agent.hardware.servos.exchange import CyclicExchange
from robot_agent.hardware.servos.health_block import HARDWARE_ERRORS
from robot_agent.hardware.servos.registers import WATCHDOG_TRIPPED
from robot_agent.hardware.wiring import Wiring
from weaver_shared.config.hardware import ServoSettings
from weaver_shared.messages import SafetyAction

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

JUMP_SPEEDS = 3.0
"""An angle that would have taken more than so many times the servo's highest speed is a reading gone wrong."""
JUMPED_CYCLES = 6
"""A joint may tell impossible angles for so long, 60 ms, before the robot holds."""
SWITCHING_CYCLES = 3
"""After an order to switch torque, servos may still report the old state."""


class JointState(IntEnum):
    WELL = 0
    MISSING = 1  # no sound answer for less than `lost_after` cycles
    LOST = 2  # longer
    RESET = 3  # it lost power for a moment, and its settings with it
    SHUT_DOWN = 4  # it reports a hardware error
    STOPPED = 5  # its bus watchdog tripped
    LIMP = 6  # without torque though it was ordered
    JUMPED = 7  # an angle it can not have reached


class JointWatch:
    """Last believed readings in joint order; `valid` says which are of this cycle and of a joint that obeys."""

    def __init__(self, wiring: Wiring, settings: ServoSettings, period: float) -> None:
        self._wiring = wiring
        self._settings = settings
        self._farthest = JUMP_SPEEDS * wiring.no_load_speed * period
        count = len(wiring.ids)
        self.position, self.velocity, self.torque = np.zeros((3, count))
        self.temperature = np.full(count, np.nan)
        self.rail_voltage = np.full(count, np.nan)
        self.valid = np.zeros(count, dtype=np.bool_)
        self.state = np.full(count, JointState.LOST, dtype=np.int64)
        self.believed_ns = np.zeros(count, dtype=np.int64)
        self.hardware_error = np.zeros(count, dtype=np.uint8)
        self.misses = np.zeros(count, dtype=np.int64)
        """Cycles since the last sound answer."""
        self._jumping = np.zeros(count, dtype=np.int64)
        self._known = np.zeros(count, dtype=np.bool_)
        self._all = np.arange(count)

    def judge(self, exchange: CyclicExchange, now_ns: int, *, torque_ordered: bool, switching: int) -> None:
        """Take over a cycle's answers; `switching` counts the cycles since torque was last ordered on or off."""
        answered, block = exchange.answered, exchange.block
        position = self._wiring.angle(block["position"], self._all)
        # A joint goes on moving in the cycles in which nothing was heard of it.
        reach = self._farthest * (1 + self.misses)
        jumped = answered & self._known & (np.abs(position - self.position) > reach)
        self.misses = np.where(answered, 0, self.misses + 1)
        taken = answered & ~jumped
        self._keep(taken, position, exchange, now_ns)
        self.hardware_error[answered] = block["hardware_error"][answered]
        lost = self.misses >= self._settings.lost_after
        # Where nothing drives the joints, somebody may have turned them.
        self._known[lost if torque_ordered else lost | jumped] = False
        self._jumping = np.where(jumped, self._jumping + 1, 0)
        limp = answered & (block["torque_on"] == 0) & torque_ordered & (switching > SWITCHING_CYCLES)
        stopped = answered & (block["watchdog"] == WATCHDOG_TRIPPED)
        state = np.zeros_like(self.state)
        for flags, found in (
            (~answered, JointState.MISSING),
            (lost, JointState.LOST),
            (jumped, JointState.JUMPED),
            (limp, JointState.LIMP),
            (stopped, JointState.STOPPED),
            (answered & (self.hardware_error != 0), JointState.SHUT_DOWN),
            (exchange.forgetful, JointState.RESET),
            (~answered & (self.state == JointState.RESET), JointState.RESET),
        ):
            state[flags] = found
        self.state = state
        self.valid = taken & (state == JointState.WELL)

    def findings(self, unheard: Flags) -> list[Trouble]:
        """What is wrong with which joints, but for those `unheard` (joints,) of; the robot holds for each."""
        if (self.state == JointState.RESET).all():
            return [Trouble(text="the servos' supply has failed: none knows its settings", action=SafetyAction.CUT)]
        faults = zip(self._wiring.robot.joint_names, self.faults(), unheard, strict=True)
        return [
            Trouble(text=f"servo {name} {fault}", action=SafetyAction.HOLD)
            for name, fault, silent in faults
            if fault and not silent
        ]

    def faults(self) -> tuple[str, ...]:
        """What is wrong with each joint's servo; empty where it is well, or only just missing."""
        faults = [""] * len(self.state)
        for joint in map(int, np.flatnonzero(self.state > JointState.MISSING)):
            faults[joint] = self._fault(joint)
        return tuple(faults)

    def _fault(self, joint: int) -> str:
        state = JointState(self.state[joint])
        if state is JointState.JUMPED and self._jumping[joint] < JUMPED_CYCLES:
            return ""
        return {
            JointState.LOST: "does not answer",
            JointState.RESET: "has lost power for a moment and its settings with it",
            JointState.SHUT_DOWN: f"has shut down: {self._errors(joint)}",
            JointState.STOPPED: "has stopped: nothing was heard from the computer",
            JointState.LIMP: "has no torque though it was ordered",
            JointState.JUMPED: "tells an angle it can not have reached",
        }[state]

    def _keep(self, taken: Flags, position: Array, exchange: CyclicExchange, now_ns: int) -> None:
        block, joints = exchange.block[taken], self._all[taken]
        self.position[taken] = position[taken]
        self.velocity[taken] = self._wiring.rate(block["velocity"], joints)
        self.torque[taken] = self._wiring.torque(block["current"], joints)
        self.temperature[taken] = block["temperature"]
        self.rail_voltage[taken] = block["voltage"] * 0.1
        self.believed_ns[taken] = now_ns
        self._known[taken] = True

    def _errors(self, joint: int) -> str:
        bits = self.hardware_error[joint]
        return ", ".join(name for bit, name in HARDWARE_ERRORS.items() if bits & bit) or "unknown"
