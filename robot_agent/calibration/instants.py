"""What a robot's IMU tells, as samples at instants: the calibration's trajectory is smooth, not a row of means."""

from __future__ import annotations

import numpy as np

from weaver_shared.messages import ImuBatch


def at_instants(means: ImuBatch, rate: float) -> ImuBatch:
    """Means over the intervals that end at their stamps, as samples of the middles of these."""
    stamps, order = np.unique(means.stamp_ns, return_index=True)
    return ImuBatch(
        stamp_ns=stamps - round(0.5e9 / rate),
        angular_velocity_in_imu=means.angular_velocity_in_imu[order],
        specific_force_in_imu=means.specific_force_in_imu[order],
    )
