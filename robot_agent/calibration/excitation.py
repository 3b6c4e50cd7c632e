"""Whether the rig was turned enough for camera and IMU to be told apart."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.errors import InputError

LEAST_RATE = 0.15
"""rad/s rms about each of two axes; hand-held recordings have 0.5 to 1."""

LEAST_SECONDS = 10.0
"""For which so much has to go on; what is longer may rest meanwhile."""

AXES = ("x", "y", "z")


def check_excitation(rates: NDArray[np.float64], seconds: float) -> None:
    """Raises InputError naming the axes about which angular rates (n, 3) rad/s, in the IMU's frame, show no turning.

    The lever between camera and IMU shows in turns across it only, and the turn between them needs two axes.
    """
    lasting = np.sqrt(max(1.0, seconds / LEAST_SECONDS))
    spread = lasting * np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(rates.T)), 0.0))
    if spread[1] >= LEAST_RATE:
        return
    each = lasting * rates.std(axis=0)
    weak = [axis for axis, rate in zip(AXES, each, strict=True) if rate < LEAST_RATE]
    told = ", ".join(f"{axis} {rate:.2f}" for axis, rate in zip(AXES, each, strict=True))
    about = f"the IMU's {' and '.join(weak)} axis" if weak else "a second axis"
    raise InputError(
        f"the motion is too poor for the camera-IMU part: hardly any turning about {about} (rms in rad/s: {told}; "
        f"{LEAST_RATE} about two axes is the least): turn the rig quickly about every axis, and push it to and fro"
    )
