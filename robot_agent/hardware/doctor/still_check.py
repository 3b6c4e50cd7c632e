"""The IMU of a robot that does not move: how often it speaks, how much noise it has, and what gravity it feels."""

from __future__ import annotations

import numpy as np

from robot_agent.hardware.doctor.finding import Finding, Verdict
from robot_agent.hardware.sources import InertialSource
from weaver_shared.clock import Clock
from weaver_shared.frames import GRAVITY
from weaver_shared.messages import ImuBatch
from weaver_shared.robots.description import Imu

CHECK = "IMU at rest"
POLL_NS = 10_000_000
FEWEST = 20
RATE_ERROR = 0.02
GRAVITY_ERROR = 0.15  # m/s^2
NOISE_RATIO = 3.0
"""Times the robot description's noise: more is a robot that moves, or a sensor that is not the described one."""
MOST_DRIFT = 0.02  # rad/s of a rate that should be 0
GAP_PERIODS = 2.5


def judge_imu(source: InertialSource, imu: Imu, clock: Clock, seconds: float) -> Finding:
    """Listen for so long. What is expected is what the robot's description says of its IMU."""
    batches, end_ns = [], clock.now_ns() + round(seconds * 1e9)
    while clock.now_ns() < end_ns:
        batches.append(source.take(clock.now_ns()))
        clock.sleep_until(clock.now_ns() + POLL_NS)
    stamps = np.concatenate([batch.stamp_ns for batch in batches])
    if stamps.size < FEWEST:
        return Finding(
            check=CHECK,
            verdict=Verdict.WRONG,
            found=f"{stamps.size} samples in {seconds:g} s",
            fix="check its cable, its port and its kind in the wiring file",
            figures={"samples": int(stamps.size)},
        )
    return _judged(stamps, batches, imu)


def _judged(stamps: np.ndarray, batches: list[ImuBatch], imu: Imu) -> Finding:
    force = np.concatenate([batch.specific_force_in_imu for batch in batches])
    turning = np.concatenate([batch.angular_velocity_in_imu for batch in batches])
    apart = np.diff(stamps) * 1e-9
    rate = float(1.0 / apart.mean())
    gaps = int((apart > GAP_PERIODS / imu.rate).sum())
    gravity = float(np.linalg.norm(force.mean(axis=0)))
    drift = float(np.linalg.norm(turning.mean(axis=0)))
    ratios = [
        float(values.std(axis=0).max() / (density * np.sqrt(imu.rate)))
        for values, density in ((turning, imu.gyro_noise_density), (force, imu.accel_noise_density))
    ]
    checks = (
        (
            abs(rate / imu.rate - 1.0) > RATE_ERROR or gaps > 0,
            f"it should be {imu.rate:g} Hz without gaps: check its cable and port",
        ),
        (abs(gravity - GRAVITY) > GRAVITY_ERROR, "calibrate its accelerometer, or let the robot stand still"),
        (max(ratios) > NOISE_RATIO, "more noise than described: let the robot stand still, with fans and motors off"),
        (drift > MOST_DRIFT, "its rate is not 0 at rest: let it warm up, then take its bias anew"),
    )
    fixes = [fix for wrong, fix in checks if wrong]
    return Finding(
        check=CHECK,
        verdict=Verdict.WRONG if fixes else Verdict.GOOD,
        found=f"{rate:.1f} Hz with {gaps} gaps, gravity {gravity:.3f} m/s², rate {drift:.4f} rad/s,"
        f" noise of gyroscope and accelerometer {ratios[0]:.1f} and {ratios[1]:.1f} times the described",
        fix="; ".join(fixes),
        figures={
            "samples": int(stamps.size),
            "rate_hz": round(rate, 2),
            "gaps": gaps,
            "gravity": round(gravity, 4),
            "drift": round(drift, 6),
            "gyro_noise_ratio": round(ratios[0], 3),
            "accel_noise_ratio": round(ratios[1], 3),
        },
    )
