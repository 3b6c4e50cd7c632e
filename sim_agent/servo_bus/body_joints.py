"""The joints of a simulated robot as what emulated servos turn."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from robot_agent.body import Body, JointTargets
from robot_agent.hardware.wiring import Wiring
from sim_agent.servo_bus.servo import EmulatedServo
from weaver_shared.messages import Proprioception

TICK_NS = 10_000_000


class BodyJoints:
    """Moves a body tick by tick to the time of the bus; servos in joint order. `heard` gets each tick's readings."""

    def __init__(
        self,
        servos: Sequence[EmulatedServo],
        body: Body,
        wiring: Wiring,
        *,
        heard: Callable[[int, Proprioception], None] = lambda now_ns, sensed: None,
    ) -> None:
        self.body = body
        self._servos = servos
        self._wiring = wiring
        self._heard = heard
        self._now_ns: int | None = None
        self._feel(body.read())
        for servo, position in zip(servos, wiring.shaft(body.read().joint_position), strict=True):
            servo.start_at(position)

    def advance(self, now_ns: int) -> None:
        if self._now_ns is None:
            self._now_ns = now_ns
        while self._now_ns + TICK_NS <= now_ns:
            self._now_ns += TICK_NS
            for servo in self._servos:
                servo.elapse(self._now_ns)
            # What servos were told since the last tick is on their shafts with this one, as with the simulated body.
            self.body.write(self._orders(self._now_ns))
            self.body.wait_next()
            sensed = self.body.read()
            self._feel(sensed)
            self._heard(self._now_ns, sensed)

    def _feel(self, sensed: Proprioception) -> None:
        shaft = self._wiring.shaft(sensed.joint_position)
        turning = self._wiring.shaft(sensed.joint_position + sensed.joint_velocity) - shaft
        drawn = self._wiring.drawn(sensed.joint_torque)
        for index, servo in enumerate(self._servos):
            servo.feel(position=shaft[index], velocity=turning[index], current=drawn[index])

    def _orders(self, stamp_ns: int) -> JointTargets:
        orders = [servo.order() for servo in self._servos]
        limit = self._wiring.torque_of(np.array([order.current_limit for order in orders]))
        on = np.array([order.torque_on for order in orders])
        return JointTargets(
            stamp_ns=stamp_ns,
            position=self._wiring.angle_of_shaft(np.array([order.position for order in orders])),
            torque_limit=np.where(on, limit, 0.0),
            torque_on=bool(on.any()),
        )
