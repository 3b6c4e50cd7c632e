"""One point of the study: mean power at the supply, where it goes, and the speed it buys (OpenSHC'20 VII, eq. 22)."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim_agent.bullet_study.machine import bullet
from sim_agent.bullet_study.points import SWING, Point
from sim_agent.study.rig import DT, Rig
from sim_agent.worlds import make_world
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import Proprioception
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

STAND = 1.0  # m of the body over the ground, on the stand
LONGEST_RISE = 30.0  # s
SETTLING = 1.0  # s
IN_PLACE = 2e-4  # m/s: to step in place is to walk at hardly any speed
FALLEN = 0.6  # rad of tilt
RUN_UP = 2.0  # strides


@dataclass(frozen=True, slots=True, kw_only=True)
class Measured:
    """Means over the measured time; parts of the power are those of the servos, before the converter's losses."""

    point: Point
    power: float  # W at the supply, motors alone
    idle: float  # W that the servos' electronics draw
    heat: float  # W in the windings
    work: float  # W beyond, done on joints and friction
    speed: float  # m/s over the ground, by truth; 0 where it does not walk
    asked: float  # m/s
    granted: float  # m/s after the walker's limits
    cost: float  # of transport, dimensionless; NaN where it does not walk on the ground
    tilt: float  # rad, largest
    at_largest_speed: float  # share of the time in which a servo was
    fell: bool

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def measure(point: Point) -> Measured:
    """Stand the robot up and do what the point asks."""
    robot = bullet(point.robot, point.variant)
    in_air = point.scenario in ("SA", "WA")
    rig = Rig(robot, make_world("flat", point.seed), point.seed, held_at=STAND if in_air else None)
    try:
        return _measured(rig, point)
    finally:
        rig.close()


def _measured(rig: Rig, point: Point) -> Measured:
    robot, gait = rig.robot, point.gait
    frequency = (point.frequency or 1.0) * SWING[gait]
    height = robot.adaptation.height_polynomial[0]
    rig.parameters = replace(rig.parameters, stride_frequency=frequency, stride_height=height)
    for _ in range(round(LONGEST_RISE / DT)):
        rig.step(gait=gait)
        if rig.out.posture == "standing":
            break
    asked = point.stride * robot.locomotion.largest_stride * frequency / (1.0 - SWING[gait])
    if point.walks:
        _run(rig, gait, asked, RUN_UP / frequency)
        strides = max(round(point.seconds * frequency), 1)
        return _mean(rig, point, gait, asked, strides / frequency)
    if point.scenario == "SG":
        _run(rig, gait, IN_PLACE, 1.0 / frequency)  # the paper's robot walked once in place before it was measured
    _run(rig, gait, 0.0, SETTLING + 1.0 / frequency)
    return _mean(rig, point, gait, 0.0, point.seconds)


def _run(rig: Rig, gait: str, speed: float, seconds: float) -> None:
    for _ in range(round(seconds / DT)):
        rig.step(gait=gait, velocity=np.array([speed, 0.0, 0.0]))


def _mean(rig: Rig, point: Point, gait: str, asked: float, seconds: float) -> Measured:
    ticks = max(round(seconds / DT), 1)
    begin, rows = rig.truth().position, []
    fastest = 0
    for _ in range(ticks):
        sensed = rig.step(gait=gait, velocity=np.array([asked, 0.0, 0.0]))
        rows.append((sensed.motor_power, winding_heat(rig.robot, sensed), rig.tilt(), float(rig.out.velocity[0])))
        fastest += any("largest speed" in reason for reason in rig.out.reasons)
    motors, heat, tilt, granted = np.array(rows).T
    moved = rig.truth().position - begin
    speed = float(np.hypot(moved[0], moved[1])) / (ticks * DT) if point.scenario == "WG" else 0.0
    power = float(motors.mean()) / rig.robot.power.converter_efficiency
    idle = sum(rig.robot.servos[joint.servo].idle_power for joint in rig.robot.joints) * rig.robot.leg_count
    return Measured(
        point=point,
        power=power,
        idle=idle,
        heat=float(heat.mean()),
        work=float(motors.mean() - heat.mean()) - idle,
        speed=speed,
        asked=asked,
        granted=float(granted.mean()),
        cost=cost_of_transport(power, rig.robot.mass, speed),
        tilt=float(tilt.max()),
        at_largest_speed=fastest / ticks,
        fell=bool(tilt.max() > FALLEN),
    )


def cost_of_transport(power: float, mass: float, speed: float) -> float:
    """Eq. 22: energy (W at the supply) over weight (kg) and way (m/s); NaN without any way."""
    return power / (mass * GRAVITY * speed) if speed > 1e-3 else float("nan")


def winding_heat(robot: RobotDescription, sensed: Proprioception) -> float:
    """W that all servos turn into heat by their present current."""
    servos = [robot.servos[joint.servo] for joint in robot.joints] * robot.leg_count
    constant = np.array([servo.torque_constant for servo in servos])
    resistance = np.array([servo.resistance for servo in servos])
    current: Array = sensed.joint_torque / constant
    return float((current**2 * resistance).sum())
