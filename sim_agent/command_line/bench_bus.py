"""`weaver bench bus`: what a cycle with all servos takes, ours beside the vendor's group read, in the same run.

Weaver's 30 servos hang on two emulated buses, in a process of their own, that keep the wire's timing. A cycle writes
all goals and reads all servos; CPU is that of the thread that does it.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import numpy as np
from dynamixel_sdk import COMM_SUCCESS, GroupSyncRead, GroupSyncWrite, PacketHandler, PortHandler
from tqdm import tqdm

from robot_agent.body import JointTargets
from robot_agent.hardware.hardware_body import HardwareBody
from robot_agent.hardware.opening import open_body
from robot_agent.hardware.servos.health_block import READ_ADDRESS, READ_TYPE, WRITTEN_ADDRESS, WRITTEN_TYPE
from robot_agent.hardware.wiring import Wiring
from sim_agent.servo_bus.serving import served
from sim_agent.servo_bus.twin import KIND
from sim_agent.servo_bus.twin_wiring import twin_wiring
from weaver_shared.config.hardware import ServoSettings
from weaver_shared.robots import load_robot

BLOCK = 25
"""Cycles of one kind before the next kind's turn, so that whatever else the computer does meets both."""
PAUSE = 0.01  # s between cycles
SETTLING = 0.5  # s between blocks: answers for which one kind did not wait must not reach the next
SETTINGS = ServoSettings(answer_margin=5.0, watchdog=2.5, start_time=0.1)
"""A busy computer delivers late; a cycle that waits for nobody ends as soon as the last servo has answered."""
GOAL_CPU_MS = 1.2

Cycle = Callable[[], bool]


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="weaver bench bus", description=__doc__)
    parser.add_argument("--cycles", type=int, default=300, help="cycles of each kind")
    parser.add_argument("--baud", type=int, default=3_000_000, help="bit/s")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args(arguments)
    figures = measure(options.cycles, options.baud)
    if options.json:
        print(json.dumps({"bus": figures, "servos": 30, "buses": 2, "baud": options.baud, "goal_cpu_ms": GOAL_CPU_MS}))
        return 0
    print("cycle of              CPU median      p10     p90   time median      p10   failed")
    for name, figure in figures.items():
        print(
            f"{name:20} {figure['cpu_ms_median']:8.2f} ms {figure['cpu_ms_p10']:8.2f} {figure['cpu_ms_p90']:7.2f}"
            f" {figure['cycle_ms_median']:10.2f} ms {figure['cycle_ms_p10']:8.2f} {figure['failed']:5d}"
            f" of {figure['cycles']}"
        )
    return 0


def measure(cycles: int, baud: int) -> dict[str, dict[str, float]]:
    """Figures by kind of cycle: CPU and wall time in ms, and cycles in which a servo's answer was missing."""
    robot = load_robot("weaver")
    with tempfile.TemporaryDirectory() as folder:
        wiring = Wiring(twin_wiring(robot, Path(folder), baud=baud, settings=SETTINGS), robot)
        with served(wiring), closing(open_body(wiring, kind=KIND)) as body:
            body.prepare()
            stock = _Stock(wiring)
            kinds: dict[str, Cycle] = {"exchange": _exchange(body), "stock": stock.cycle}
            taken: dict[str, list[tuple[float, float, bool]]] = {name: [] for name in kinds}
            for _ in tqdm(range(-(-cycles // BLOCK)), disable=not sys.stderr.isatty()):
                for name, cycle in kinds.items():
                    time.sleep(SETTLING)
                    taken[name] += [_timed(cycle) for _ in range(BLOCK)]
            taken["body"] = _bodies(body, cycles)
            stock.close()
    return {name: _summary(values) for name, values in taken.items()}


def _exchange(body: HardwareBody) -> Cycle:
    """Ours: goals to all, blocks of health from all, what of them can be believed."""
    goals = np.zeros(body.robot.joint_count, dtype=WRITTEN_TYPE)
    goals["current"], goals["position"] = 500, 2048

    def cycle() -> bool:
        body.exchange.write(goals)
        body.exchange.read()
        return bool(body.exchange.answered.all())

    return cycle


class _Stock:
    """The vendor's group classes as they come, one bus after the other."""

    def __init__(self, wiring: Wiring) -> None:
        packets = PacketHandler(2.0)
        self._ports, self._reads, self._writes = [], [], []
        goal = np.array([(500, 2048)], dtype=WRITTEN_TYPE).tobytes()
        for bus in wiring.config.buses:
            port = PortHandler(bus.port)
            port.baudrate = bus.baud
            port.openPort()
            read = GroupSyncRead(port, packets, READ_ADDRESS, READ_TYPE.itemsize)
            write = GroupSyncWrite(port, packets, WRITTEN_ADDRESS, WRITTEN_TYPE.itemsize)
            for joint in wiring.joints_of(bus.name):
                read.addParam(wiring.ids[joint])
                write.addParam(wiring.ids[joint], goal)
            self._ports.append(port)
            self._reads.append(read)
            self._writes.append(write)

    def cycle(self) -> bool:
        written = [write.txPacket() for write in self._writes]
        return [read.txRxPacket() for read in self._reads] + written == [COMM_SUCCESS] * 2 * len(self._ports)

    def close(self) -> None:
        for port in self._ports:
            port.closePort()


def _bodies(body: HardwareBody, cycles: int) -> list[tuple[float, float, bool]]:
    """A whole control tick of the body: exchange, judgement of every joint, feet, readings, orders."""
    body.wait_next()
    joints = body.robot.joint_count
    targets = JointTargets(
        stamp_ns=0, position=body.read().joint_position, torque_limit=np.full(joints, 5.0), torque_on=True
    )

    def tick() -> bool:
        body.wait_next()
        valid = bool(body.read().joint_valid.all())
        body.write(targets)
        return valid

    for _ in range(20):
        tick()
    return [_timed(tick, pause=False) for _ in range(cycles)]


def _timed(cycle: Cycle, *, pause: bool = True) -> tuple[float, float, bool]:
    """CPU time and wall time in ms, and whether everybody answered."""
    if pause:
        time.sleep(PAUSE)
    cpu, wall = time.thread_time_ns(), time.monotonic_ns()
    good = cycle()
    return (time.thread_time_ns() - cpu) * 1e-6, (time.monotonic_ns() - wall) * 1e-6, good


def _summary(values: list[tuple[float, float, bool]]) -> dict[str, float]:
    cpu, wall = np.array([value[:2] for value in values]).T
    return {
        "cpu_ms_median": round(float(np.median(cpu)), 3),
        "cpu_ms_p10": round(float(np.percentile(cpu, 10)), 3),
        "cpu_ms_p90": round(float(np.percentile(cpu, 90)), 3),
        "cycle_ms_median": round(float(np.median(wall)), 3),
        "cycle_ms_p10": round(float(np.percentile(wall, 10)), 3),
        "failed": sum(not value[2] for value in values),
        "cycles": len(values),
    }
