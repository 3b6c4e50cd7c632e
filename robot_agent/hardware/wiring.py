"""Between a robot's joints and its servos: who hangs where, and counts against angles."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from robot_agent.hardware.servos.preparation import OPERATING_MODES, Place
from robot_agent.hardware.servos.registers import CENTRE, CURRENT_UNIT, MODELS, RAD_PER_COUNT, VELOCITY_UNIT, Model
from weaver_shared.config.hardware import HardwareConfig
from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription

Array = NDArray[np.float64]
Counts = NDArray[np.int32]

_MODELS = {model.name.replace("-", "").lower(): model for model in MODELS.values()}


def load_wiring(path: Path) -> HardwareConfig:
    """The calibration file of a real robot. Raises ConfigurationError in one sentence."""
    try:
        return HardwareConfig.model_validate(tomllib.loads(path.read_text()))
    except OSError as error:
        raise ConfigurationError(f"wiring {path}: {error.strerror}") from error
    except tomllib.TOMLDecodeError as error:
        raise ConfigurationError(f"wiring {path} is not valid TOML: {error}") from error
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "file"
        raise ConfigurationError(f"wiring {path}: {where}: {first['msg']}") from error


class Wiring:
    """A robot's joints as servos, all arrays in the order of `RobotDescription.joint_names`."""

    def __init__(self, config: HardwareConfig, robot: RobotDescription) -> None:
        self.config = config
        self.robot = robot
        wired = {joint.joint: joint for joint in config.joints}
        missing = [name for name in robot.joint_names if name not in wired]
        strange = [name for name in wired if name not in robot.joint_names]
        if missing or strange:
            what = f"has no servo for {missing[0]}" if missing else f"names {strange[0]}, which is no joint"
            raise ConfigurationError(f"wiring of {robot.name}: it {what}")
        order = [wired[name] for name in robot.joint_names]
        self.ids = [joint.id for joint in order]
        self.bus = [joint.bus for joint in order]
        self._sign = np.array([-1.0 if joint.reversed else 1.0 for joint in order])
        self._zero = np.array([joint.zero for joint in order], dtype=np.float64)
        kinds = [joint.servo for joint in robot.joints] * robot.leg_count
        self.models = [_model(kind) for kind in kinds]
        self._torque_constant = np.array([robot.servos[kind].torque_constant for kind in kinds])
        self._most_current = np.array([model.current_limit for model in self.models])
        self.no_load_speed = np.array([robot.servos[kind].no_load_speed for kind in kinds])
        self.lower = np.tile(robot.joint_limits[:, 0], robot.leg_count)
        self.upper = np.tile(robot.joint_limits[:, 1], robot.leg_count)

    def joints_of(self, bus: str) -> NDArray[np.int64]:
        """Which joints hang on a bus."""
        return np.flatnonzero(np.array(self.bus) == bus)

    def angle(self, counts: NDArray[np.int32], joints: NDArray[np.int64]) -> Array:
        """Joint angles in rad of servo positions."""
        angle: Array = self._sign[joints] * (counts - self._zero[joints]) * RAD_PER_COUNT
        return angle

    def rate(self, units: NDArray[np.int32], joints: NDArray[np.int64]) -> Array:
        """Joint speeds in rad/s of servo velocities."""
        rate: Array = self._sign[joints] * (units * VELOCITY_UNIT).astype(np.float64)
        return rate

    def torque(self, units: NDArray[np.int16], joints: NDArray[np.int64]) -> Array:
        """Joint torques in N m of servo currents, by the motors' torque constants: friction is in them."""
        torque: Array = self._sign[joints] * self._torque_constant[joints] * (units * CURRENT_UNIT).astype(np.float64)
        return torque

    def counts(self, angle: Array, joints: NDArray[np.int64]) -> Counts:
        """Servo positions of joint angles (rad), which end at the joints' limits."""
        within = np.clip(angle, self.lower[joints], self.upper[joints])
        return np.round(self._sign[joints] * within / RAD_PER_COUNT + self._zero[joints]).astype(np.int32)

    def current(self, torque: Array, joints: NDArray[np.int64]) -> NDArray[np.int16]:
        """Servo currents that make these torques (N m, not negative), at most what the servos may draw."""
        units = np.maximum(torque, 0.0) / self._torque_constant[joints] / CURRENT_UNIT
        current: NDArray[np.int16] = np.minimum(units, self._most_current[joints]).astype(np.int16)
        return current

    def shaft(self, angle: Array) -> Array:
        """Where the servos' shafts are, rad from the middle of their turn, at these joint angles (joints,)."""
        shaft: Array = self._sign * angle + (self._zero - CENTRE) * RAD_PER_COUNT
        return shaft

    def angle_of_shaft(self, shaft: Array) -> Array:
        """Joint angles (joints,) of shafts, the reverse of `shaft`."""
        angle: Array = self._sign * (shaft - (self._zero - CENTRE) * RAD_PER_COUNT)
        return angle

    def drawn(self, torque: Array) -> Array:
        """Currents (joints,) in A, with their signs at the servo, that make these joint torques in N m."""
        drawn: Array = self._sign * torque / self._torque_constant
        return drawn

    def torque_of(self, current: Array) -> Array:
        """Torques (joints,) in N m of currents' sizes in A."""
        torque: Array = current * self._torque_constant
        return torque

    def stops(self, joint: int) -> tuple[int, int]:
        """Least and greatest count of a joint's range."""
        ends = self.counts(np.array([self.lower[joint], self.upper[joint]]), np.array([joint, joint]))
        return int(ends.min()), int(ends.max())

    def place(self, joint: int) -> Place:
        """What the servo of a joint has to be."""
        return Place(
            joint=self.robot.joint_names[joint],
            id=self.ids[joint],
            model=self.models[joint],
            stops=self.stops(joint),
            operating_mode=OPERATING_MODES[self.config.servos.operating_mode],
        )


def _model(kind: str) -> Model:
    if kind not in _MODELS:
        raise ConfigurationError(f"servo {kind!r} is none that we can talk to; known are {', '.join(sorted(_MODELS))}")
    return _MODELS[kind]
