"""Every limit a robot is stopped for, in one place."""

from pydantic import BaseModel, ConfigDict


class SafetyLimits(BaseModel):
    """Thresholds of the safety supervisor. Times in s, angles in rad, temperatures in degrees Celsius."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    operator_silence: float = 0.75  # pages retain their lease at 4 Hz; still within 1.5 s, as legs need up to 0.7 s
    hold_before_sit: float = 60.0
    tilt_hold: float = 0.61  # 35 degrees; the robot is meant to climb 30
    tilt_cut: float = 1.05  # 60 degrees: it has fallen over
    attitude_age: float = 0.05  # from then on nothing answers to the attitude that was last known
    imu_age: float = 0.2
    odometry_age: float = 0.5
    joints_missing: float = 0.1  # five cycles of 20 ms
    power_warn: float = 1.0
    power_age: float = 5.0
    temperature_warn: float = 60.0
    temperature_sit: float = 75.0  # the servo's own shutdown is at 80
    battery_warn: float = 24.5  # V of a 7-cell pack
    battery_sit: float = 23.1
    battery_off: float = 21.0  # once it sits
