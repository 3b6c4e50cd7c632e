"""What people are shown of the features that the odometry follows: as often as pictures, and of the same ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry import Followed
from weaver_shared import topics
from weaver_shared.messages import StereoFrame, TrackedFeatures

LATE = 1.5
"""Periods after which features are shown of a picture that people are not: better a moment beside it than none."""


class FeatureView:
    def __init__(self, rate: float) -> None:
        """`rate` Hz of the cameras."""
        self._every = max(round(rate / topics.CAMERA.rate), 1)
        self._latest_ns = round(LATE * 1e9 / topics.CAMERA.rate)
        self._shown_ns: int | None = None

    def of(self, frame: StereoFrame, followed: Followed) -> TrackedFeatures | None:
        """What is shown of this picture; None for those between."""
        late = self._shown_ns is None or frame.stamp_ns - self._shown_ns >= self._latest_ns
        if frame.sequence % self._every and not late:
            return None
        self._shown_ns = frame.stamp_ns
        height, width = frame.left.shape
        return TrackedFeatures(
            stamp_ns=frame.stamp_ns,
            width=width,
            height=height,
            both_eyes=_whole(followed.pixel[followed.both]),
            one_eye=_whole(followed.pixel[~followed.both]),
            rejected=_whole(followed.rejected),
        )


def _whole(pixel: NDArray[np.float64]) -> NDArray[np.int16]:
    return np.rint(pixel).astype(np.int16)
