"""A robot of Dynamixel servos behind the same face as a simulated one.

One thread talks to all buses, and only when the control loop calls: when the loop stalls, nothing is sent, and the
servos' own watchdogs stop and hold them. Nothing here switches torque off but an order to.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from robot_agent.body import JointTargets, Trouble
from robot_agent.hardware.cycle_pace import CyclePace
from robot_agent.hardware.derating import derated
from robot_agent.hardware.foot_touch import FootTouch
from robot_agent.hardware.joint_watch import JointState, JointWatch
from robot_agent.hardware.servos import registers as r
from robot_agent.hardware.servos.exchange import BusExchange, CyclicExchange
from robot_agent.hardware.servos.health_block import WRITTEN_TYPE
from robot_agent.hardware.servos.port import LineClock, ServoPort
from robot_agent.hardware.servos.preparation import Preparation
from robot_agent.hardware.soft_start import SoftStart
from robot_agent.hardware.sources import InertialSource, PowerReading, PowerSource
from robot_agent.hardware.stuck_watch import StuckWatch
from robot_agent.hardware.wiring import Wiring
from weaver_shared.errors import ResourceError
from weaver_shared.messages import ImuBatch, Proprioception, SafetyAction

logger = logging.getLogger(__name__)

CONTROL_RATE = 100.0
TICK_NS = round(1e9 / CONTROL_RATE)
POWER_AGE = 0.2
"""s for which a reading of the power monitor stands."""
MENDING_NS = 500_000_000
"""Between attempts to make a servo ready again; each takes a tick or two."""
UP_BLEND = 0.02
"""Share of each tick's specific force in what is taken for upwards."""


class HardwareBody:
    """Servos, IMU and power of a real robot; a `robot_agent.body.Body`. `ports` are open, by the names of the buses."""

    def __init__(
        self,
        wiring: Wiring,
        ports: Mapping[str, ServoPort],
        clock: LineClock,
        *,
        kind: str = "REAL",
        imu: InertialSource | None = None,
        power: PowerSource | None = None,
    ) -> None:
        self.robot = wiring.robot
        self.kind = kind
        self._wiring = wiring
        self._settings = wiring.config.servos
        self._clock = clock
        self._imu, self._power = imu, power
        self._buses = [
            BusExchange(
                ports[bus.name],
                [wiring.ids[joint] for joint in wiring.joints_of(bus.name)],
                wiring.joints_of(bus.name),
                baud=bus.baud,
            )
            for bus in wiring.config.buses
        ]
        self.exchange = CyclicExchange(self._buses, clock, answer_margin=self._settings.answer_margin)
        self.watch = JointWatch(wiring, self._settings, 1.0 / CONTROL_RATE)
        self._touch = FootTouch(self.robot, 1.0 / CONTROL_RATE)
        self._start = SoftStart(self._settings)
        self._up = np.array([0.0, 0.0, 1.0])
        self._all = np.arange(self.robot.joint_count)
        self._everybody = np.ones(self.robot.joint_count, dtype=np.bool_)
        self._torque_on = False
        self._switched = 0
        self._retry_ns = 0
        self._stamp_ns = self._next_ns = clock.now_ns()
        self._samples = ImuBatch.empty()
        self._battery: PowerReading | None = None
        self._contact = np.zeros(self.robot.leg_count, dtype=np.bool_)
        self._refused = False
        self._stuck = StuckWatch(self.robot.joint_count)
        self._pace = CyclePace()
        self._mend_ns = 0
        self._unmended = ""
        self._told: list[str] = []

    def prepare(self) -> None:
        """Make every servo ready. Raises ResourceError that names the first which is not what it has to be."""
        for bus in self._buses:
            for joint in bus.joints:
                Preparation(bus.port, self._wiring.place(int(joint))).run()
        self.exchange.read()
        self._torque_on = bool((self.exchange.block["torque_on"][self.exchange.answered] == 1).all())
        self._judge(self._clock.now_ns())
        if self._torque_on:
            self._start.begin(self.watch.position, holding=True)
            self._feed_watchdogs(self._everybody)
        self._next_ns = self._clock.now_ns()

    def wait_next(self) -> int:
        """Sleep until the next tick of 10 ms, hear all servos and return the tick's stamp."""
        # Ticks begin with full hundredths of a second; one that was missed is not made up for.
        self._next_ns = max(self._next_ns + TICK_NS, self._clock.now_ns()) // TICK_NS * TICK_NS
        self._clock.sleep_until(self._next_ns)
        self._stamp_ns = now_ns = self._clock.now_ns()
        if now_ns >= self._retry_ns:
            self._retry(now_ns)
        self._switched += 1
        # Before the buses are asked: what has come is the later stamped the later it is taken.
        self._samples = self._imu.take(now_ns) if self._imu is not None else ImuBatch.empty()
        self.exchange.read()
        self._pace.add(
            self.exchange.taken,
            complete=bool(self.exchange.answered.all()),
            late=any(bus.late for bus in self._buses),
        )
        self._judge(now_ns)
        if self._power is not None and (reading := self._power.take(self._clock.now_ns())) is not None:
            self._battery = reading
        self._feel()
        self._ask_those_who_answer(everybody=False)
        return now_ns

    def read(self) -> Proprioception:
        watch, battery = self.watch, self._battery
        fresh = battery is not None and self._stamp_ns - battery.stamp_ns <= POWER_AGE * 1e9
        voltage, current = (battery.voltage, battery.current) if battery is not None and fresh else (np.nan, np.nan)
        drawn = voltage * current * self.robot.power.converter_efficiency
        return Proprioception(
            stamp_ns=self._stamp_ns,
            joint_position=watch.position.copy(),
            joint_velocity=watch.velocity.copy(),
            joint_torque=watch.torque.copy(),
            joint_valid=watch.valid.copy(),
            joint_temperature=watch.temperature.copy(),
            foot_contact=self._contact,
            imu=self._samples,
            battery_voltage=float(voltage),
            supply_current=float(current),
            motor_power=float(drawn - self.robot.power.electronics_power),
        )

    def write(self, targets: JointTargets) -> None:
        """Send goals; torque comes softly when it is first ordered, and only when every joint is well."""
        if targets.torque_on != self._torque_on:
            if targets.torque_on and not self.watch.valid.all():
                self._refused = True
                return
            self._switch(on=targets.torque_on)
        self._refused = False
        if not self._torque_on:
            self._mend()
            return
        stopped = self.watch.state == JointState.STOPPED
        if stopped.any():
            self._go_on(stopped)
        position, allowed = self._start.limit(targets.position, targets.torque_limit, 1.0 / CONTROL_RATE)
        allowed = self._stuck.ease(derated(allowed, self.watch.temperature))
        self._stuck.step(position, self.watch.position, self.watch.torque, allowed, 1.0 / CONTROL_RATE)
        self._send(position, allowed)

    @property
    def holding(self) -> bool:
        return self._torque_on

    def recover(self) -> None:
        """Make servos that shut down or lost their settings ready again; only while torque is off.

        Raises ResourceError that names a servo which can not be helped, or says that torque is on.
        """
        for bus in self._buses:
            for joint in bus.joints:
                if self.watch.state[joint] in (JointState.RESET, JointState.SHUT_DOWN):
                    preparation = Preparation(bus.port, self._wiring.place(int(joint)))
                    if self.watch.state[joint] == JointState.SHUT_DOWN:
                        preparation.reboot(self._clock)
                    preparation.run()
        self._ask_those_who_answer(everybody=True)

    def findings(self) -> list[Trouble]:
        """What is wrong with servos and buses."""
        names = self.robot.joint_names
        unheard = np.zeros(self._all.size, dtype=np.bool_)
        for bus in self._buses:
            unheard[bus.joints] = not bus.up
        holds = [f"bus {bus.port.port_name} is down" for bus in self._buses if not bus.up]
        holds += [f"joint {names[joint]} is stuck" for joint in np.flatnonzero(self._stuck.stuck)]
        said = ["torque stays off until every servo is well"] if self._refused else []
        said += [self._unmended] if self._unmended else []
        if self._pace.slow:
            said.append(
                "reading all servos takes longer than a tick leaves: "
                "set the adapters' latency timer to 1 ms and the servos' return delay to 0"
            )
        return [
            *(Trouble(text=text, action=SafetyAction.HOLD) for text in holds),
            *self.watch.findings(unheard),
            *(Trouble(text=text, action=SafetyAction.ALLOW) for text in said),
        ]

    def joint_faults(self) -> tuple[str, ...]:
        """By the servos' own error bits and by what is heard of them."""
        return tuple(
            fault or ("is stuck" if stuck else "")
            for fault, stuck in zip(self.watch.faults(), self._stuck.stuck, strict=True)
        )

    def troubles(self) -> Sequence[str]:
        """The same, one sentence each."""
        return [trouble.text for trouble in self.findings()]

    def close(self) -> None:
        """Stop talking. Servos with torque hold where they are, by their watchdogs."""
        for bus in self._buses:
            bus.port.closePort()
        for source in (self._imu, self._power):
            if source is not None:
                source.close()

    def _judge(self, now_ns: int) -> None:
        self.watch.judge(self.exchange, now_ns, torque_ordered=self._torque_on, switching=self._switched)
        texts = self.troubles()
        for text in texts:
            if text not in self._told:
                logger.warning("%s", text)
        self._told = list(texts)

    def _feel(self) -> None:
        if self._samples.stamp_ns.size:
            force = self._samples.specific_force_in_imu.mean(axis=0)
            self._up += UP_BLEND * (force / max(float(np.linalg.norm(force)), 1e-6) - self._up)
        up = self._up / np.linalg.norm(self._up)
        self._contact = self._touch.step(self.watch.position, self.watch.velocity, self.watch.torque, up)

    def _mend(self) -> None:
        """With torque off nothing hangs on a servo: make one ready that shut down or lost its settings."""
        broken = np.flatnonzero(np.isin(self.watch.state, (JointState.RESET, JointState.SHUT_DOWN)))
        if not broken.size:
            self._unmended = ""
        elif self._stamp_ns >= self._mend_ns:
            # Each in its turn: one that can not be helped must not keep the others waiting.
            joint = int(broken[self._switched % broken.size])
            bus = next(bus for bus in self._buses if joint in bus.joints)
            preparation = Preparation(bus.port, self._wiring.place(joint))
            try:
                if self.watch.state[joint] == JointState.SHUT_DOWN:
                    preparation.begin_reboot()
                    self._mend_ns = self._stamp_ns + MENDING_NS
                else:
                    preparation.run()
                self._unmended = ""
            except ResourceError as error:
                self._unmended = str(error)
                self._mend_ns = self._stamp_ns + MENDING_NS

    def _switch(self, *, on: bool) -> None:
        self._torque_on = on
        self._stuck.clear()
        self._switched = 0
        if on:
            self._start.begin(self.watch.position)
            position, torque = self._start.limit(self.watch.position, self._stall_torque(), 0.0)
            self._send(position, torque)
            self._feed_watchdogs(self._everybody)
        else:
            self.exchange.tell(r.BUS_WATCHDOG.address, np.zeros(self._all.size, dtype=np.int8), self._everybody)
        flags = np.full(self._all.size, on, dtype=np.uint8)
        self.exchange.tell(r.TORQUE_ENABLE.address, flags, self._everybody)

    def _go_on(self, stopped: NDArray[np.bool_]) -> None:
        """After their watchdogs stopped servos: from where they stand, slowly, with the torque that bears the robot."""
        self._start.begin(self.watch.position, holding=True)
        self.exchange.tell(r.BUS_WATCHDOG.address, np.zeros(self._all.size, dtype=np.int8), stopped)
        self._feed_watchdogs(stopped)

    def _feed_watchdogs(self, which: NDArray[np.bool_]) -> None:
        units = round(self._settings.watchdog / r.WATCHDOG_UNIT)
        self.exchange.tell(r.BUS_WATCHDOG.address, np.full(self._all.size, units, dtype=np.int8), which)

    def _send(self, position: NDArray[np.float64], torque: NDArray[np.float64]) -> None:
        goals = np.zeros(self._all.size, dtype=WRITTEN_TYPE)
        goals["position"] = self._wiring.counts(position, self._all)
        goals["current"] = self._wiring.current(torque, self._all)
        self.exchange.write(goals)

    def _retry(self, now_ns: int) -> None:
        """Look again for servos that are lost and for buses that are down."""
        self._retry_ns = now_ns + round(self._settings.retry_period * 1e9)
        for bus in self._buses:
            if not bus.up:
                bus.up = bus.port.reopen()
        self._ask_those_who_answer(everybody=True)

    def _ask_those_who_answer(self, *, everybody: bool) -> None:
        gone = (self.watch.misses >= self._settings.lost_after) & ~np.bool_(everybody)
        for bus in self._buses:
            bus.ask_only(~gone[bus.joints])

    def _stall_torque(self) -> NDArray[np.float64]:
        stall = [self.robot.servos[joint.servo].stall_torque for joint in self.robot.joints]
        return np.tile(stall, self.robot.leg_count)
