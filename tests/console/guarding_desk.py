"""A robot at the wire whose commands are judged by the robot's own command desk, on a clock that only tests move."""

from __future__ import annotations

from wire_robot import WireRobot

from robot_agent.adaptation import ParameterOverrides
from robot_agent.commands import CommandDesk, Situation
from weaver_shared import topics
from weaver_shared.bus import MemoryBus
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import Answer, Command


class GuardedRobot:
    """`commands` are those that came, with what became of them."""

    def __init__(self, bus: MemoryBus) -> None:
        self.clock = SimulatedClock(1_000_000_000)
        self.wire = WireRobot(bus)
        description = self.wire.description
        self.desk = CommandDesk(
            robot=description, overrides=ParameterOverrides(description.adaptation), wall_clock_ns=self.clock.now_ns
        )
        self.desk.observe(Situation(stamp_ns=1, robot_xy=(0.0, 0.0), mode="STAND", settled=False, stand_blockers=()))
        self.commands: list[tuple[Command, Answer]] = []
        bus.serve(self.wire.robot_id, self._answer)
        bus.subscribe(self.wire.robot_id, topics.TELEOP, lambda _id, _key, frame: self.desk.teleoperate(frame))

    def _answer(self, command: Command) -> Answer:
        answer = self.desk.answer(command)
        self.commands.append((command, answer))
        return answer

    @property
    def moved(self) -> bool:
        """Whether anything but a stop has been carried out."""
        orders = self.desk.orders()
        untouched = not orders.stand and not orders.mission_active and orders.teleop_velocity is None
        return not untouched or bool(orders.legs) or bool(self.desk.mission(1).waypoints)
