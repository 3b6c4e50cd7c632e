"""Pictures of ground given as a function of x and y, as mapping gets them from perception."""

from dataclasses import dataclass

import numpy as np

from weaver_shared.messages import OdometryEstimate
from weaver_shared.transforms import Pose


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
    return OdometryEstimate.at_rest(Pose.of([x, y, 0.165]), stamp_ns)
