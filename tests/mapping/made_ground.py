"""Pictures of ground given as a function of x and y, as mapping gets them from perception."""

from dataclasses import dataclass

import numpy as np

from weaver_shared.messages import OdometryEstimate, OdometryQuality


@dataclass
class Patch:
    row0: int
    column0: int
    cell: float
    elevation: np.ndarray
    variance: np.ndarray
    upper: np.ndarray
    ceiling: np.ndarray


@dataclass
class Seen:
    stamp_ns: int
    grid: Patch
    sensor_in_world: np.ndarray


def seen(elevation, x=(-1.0, 1.0), y=(-1.0, 1.0), sigma=0.003, stamp_ns=0, cell=0.02, sensor=(0.0, 0.0, 0.35)):
    rows = np.arange(round(x[0] / cell), round(x[1] / cell))
    columns = np.arange(round(y[0] / cell), round(y[1] / cell))
    z = elevation(*np.meshgrid((rows + 0.5) * cell, (columns + 0.5) * cell, indexing="ij")).astype(np.float32)
    patch = Patch(rows[0], columns[0], cell, z, np.full_like(z, sigma**2), z, np.full_like(z, np.nan))
    return Seen(stamp_ns, patch, np.array(sensor))


def at(x=0.0, y=0.0, stamp_ns=0):
    return OdometryEstimate(
        stamp_ns=stamp_ns,
        position_in_world=np.array([x, y, 0.165]),
        wxyz=np.array([1.0, 0.0, 0.0, 0.0]),
        velocity_in_world=np.zeros(3),
        angular_velocity_in_body=np.zeros(3),
        gyro_bias=np.zeros(3),
        accel_bias=np.zeros(3),
        covariance=np.eye(6) * 1e-6,
        quality=OdometryQuality.GOOD,
        reason="",
        tracked_features=100,
    )
