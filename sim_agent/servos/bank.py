"""All servos of a robot: what they are told, what they do, what they say about it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.body import JointTargets
from sim_agent.servos.motor import RAD_PER_TICK, servo_torque
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]

SPEED_UNIT = 0.114 * 2.0 * np.pi / 60.0  # rad/s, "present speed" of the MX series (data sheet)
CURRENT_UNIT = 3.36e-3  # A, "present current" (data sheet)
AMBIENT = 25.0  # degrees Celsius
THERMAL_RESISTANCE = 3.0  # K/W from winding to air (chosen: a standing robot settles near 35 degrees)
THERMAL_TIME = 600.0  # s


class ServoBank:
    """Joint order is `RobotDescription.joint_names`. Without torque the joints are held by their friction alone."""

    def __init__(self, robot: RobotDescription, dt: float) -> None:
        servos = [robot.servos[joint.servo] for joint in robot.joints] * robot.leg_count
        self._parameters = np.array(
            [
                [
                    servo.torque_constant,
                    servo.resistance,
                    servo.supply_voltage,
                    servo.position_gain,
                    servo.stall_torque,
                    servo.coulomb_friction,
                    servo.viscous_friction,
                ]
                for servo in servos
            ]
        )
        self._lower, self._upper = (np.tile(robot.joint_limits[:, side], robot.leg_count) for side in (0, 1))
        self._idle_power = sum(servo.idle_power for servo in servos)
        self._dt = dt
        count = len(servos)
        self._bristle = np.zeros(count)
        self._goal = np.zeros(count)
        self._torque_limit = np.zeros(count)
        self._torque_on = False
        self._current = np.zeros(count)
        self._power = np.zeros(count)
        self._energy = 0.0
        self._heat = np.zeros(count)
        self._elapsed = 0.0
        self._temperature = np.full(count, AMBIENT)

    def command(self, targets: JointTargets) -> None:
        """Take over one tick's order; goals beyond a joint's limits end at the limit, as in the firmware."""
        self._goal = np.clip(targets.position, self._lower, self._upper)
        self._torque_limit = np.ascontiguousarray(targets.torque_limit, dtype=np.float64)
        self._torque_on = targets.torque_on

    def torque(self, position: Array, velocity: Array, torque: Array) -> None:
        """Fill the torques (joints,) in N m that act on the joints during the next physics step."""
        servo_torque(
            self._goal,
            position,
            velocity,
            self._torque_limit,
            self._torque_on,
            self._parameters,
            self._bristle,
            self._dt,
            torque,
            self._current,
            self._power,
        )
        self._energy += float(self._power.sum()) * self._dt
        self._heat += self._current**2 * self._dt
        self._elapsed += self._dt

    def end_of_tick(self) -> float:
        """Mean electrical power of all servos since the last call, in W, idle included; also warms the windings."""
        power = self._energy / self._elapsed + self._idle_power
        losses = self._heat / self._elapsed * self._parameters[:, 1]
        settled = AMBIENT + THERMAL_RESISTANCE * losses
        self._temperature += (settled - self._temperature) * (self._elapsed / THERMAL_TIME)
        self._energy, self._elapsed = 0.0, 0.0
        self._heat[:] = 0.0
        return power

    def present_torque(self) -> Array:
        """Torque (joints,) in N m by the measured current, as the servos can tell it: friction included."""
        measured = np.round(self._current / CURRENT_UNIT) * CURRENT_UNIT
        torque: Array = measured * self._parameters[:, 0]
        return torque

    def present_temperature(self) -> Array:
        """Winding temperature (joints,) in whole degrees Celsius."""
        return np.round(self._temperature)


def encoder_position(position: Array) -> Array:
    """Joint angles in rad as the 4096 ticks of a turn can tell them."""
    return np.round(position / RAD_PER_TICK) * RAD_PER_TICK


def encoder_velocity(velocity: Array) -> Array:
    """Joint speeds in rad/s in the servos' own steps."""
    return np.round(velocity / SPEED_UNIT) * SPEED_UNIT
