"""What the sensors say, stamped on the robot's clock."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, kw_only=True)
class ImuBatch:
    """Consecutive inertial samples, oldest first; each is the mean over the interval that ends at its stamp."""

    stamp_ns: NDArray[np.int64]  # (n,)
    angular_velocity_in_imu: Array  # (n, 3) rad/s
    specific_force_in_imu: Array  # (n, 3) m/s^2, +g on z at rest

    @staticmethod
    def empty() -> "ImuBatch":
        return ImuBatch(
            stamp_ns=np.zeros(0, dtype=np.int64),
            angular_velocity_in_imu=np.zeros((0, 3)),
            specific_force_in_imu=np.zeros((0, 3)),
        )

    @staticmethod
    def join(batches: "list[ImuBatch]") -> "ImuBatch":
        if not batches:
            return ImuBatch.empty()
        return ImuBatch(
            stamp_ns=np.concatenate([b.stamp_ns for b in batches]),
            angular_velocity_in_imu=np.concatenate([b.angular_velocity_in_imu for b in batches]),
            specific_force_in_imu=np.concatenate([b.specific_force_in_imu for b in batches]),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class StereoFrame:
    """A synchronised pair of grey pictures, stamped at mid-exposure."""

    stamp_ns: int
    sequence: int
    left: NDArray[np.uint8]  # (height, width)
    right: NDArray[np.uint8]  # (height, width)


@dataclass(frozen=True, slots=True, kw_only=True)
class Proprioception:
    """What the body feels in one control tick. Joint order is `RobotDescription.joint_names`, leg order its legs."""

    stamp_ns: int
    joint_position: Array  # (joints,) rad
    joint_velocity: Array  # (joints,) rad/s
    joint_torque: Array  # (joints,) N m
    joint_valid: NDArray[np.bool_]  # (joints,) False: this tick's reading is missing, values are the last known
    joint_temperature: Array  # (joints,) degrees Celsius
    foot_contact: NDArray[np.bool_]  # (legs,) sensed ground contact
    imu: ImuBatch  # samples since the previous tick
    battery_voltage: float
    supply_current: float  # A drawn from the battery
    motor_power: float  # W, servos alone


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraPicture:
    """One picture for people: JPEG bytes."""

    stamp_ns: int
    name: str
    jpeg: bytes
