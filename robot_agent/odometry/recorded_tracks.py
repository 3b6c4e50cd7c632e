"""A front end for recordings whose features somebody else has followed: the left eye's tracks, no pictures."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.landmarks import LEFT
from robot_agent.odometry.outlier_rejection import consistent, unit_rays
from robot_agent.odometry.own_legs import OwnLegs
from robot_agent.odometry.tracks import Tracks
from weaver_shared.messages import StereoFrame
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
Sightings = tuple[NDArray[np.int64], Array]
"""Identities (n,) and undistorted points (n, 2) on the plane z = 1."""


HYPOTHESES, FEWEST_TO_JUDGE = 60, 8
EPIPOLAR_GATE = 3.0
"""px off the epipolar plane: tracks that somebody else has followed are noisier than ours."""


class RecordedTracks:
    """Hands out what the left eye saw at each stamp; a track the back end gave up never comes back."""

    def __init__(self, sightings: Mapping[int, Sightings], focal_length: float) -> None:
        """`sightings` by stamp in ns; `focal_length` in px turns motion on the plane into flow."""
        self._sightings = sightings
        self._focal_length = focal_length
        self._before: Sightings = (np.zeros(0, dtype=np.int64), np.zeros((0, 2)))
        self._wrong: set[int] = set()
        self._random = np.random.default_rng(7)

    def step(self, frame: StereoFrame, left_from_previous: Pose, legs: OwnLegs | None = None) -> Tracks:
        """The tracks of the frame's stamp, whatever its pictures and the predicted motion."""
        found = self._sightings.get(frame.stamp_ns)
        if found is None:
            return Tracks.none("no tracks at this instant")
        keep = np.array([int(name) not in self._wrong for name in found[0]], dtype=np.bool_)
        identity, plane = found[0][keep], found[1][keep]
        _, old, new = np.intersect1d(self._before[0], identity, return_indices=True)
        before, after = self._before[1][old], plane[new]
        flow = self._focal_length * float(np.median(np.linalg.norm(after - before, axis=1))) if len(new) else np.nan
        self._before = identity, plane
        if len(new) >= FEWEST_TO_JUDGE:
            pairs = self._random.integers(0, len(new), (HYPOTHESES, 2))
            turned = unit_rays(before) @ left_from_previous.rotation.T
            good = consistent(turned, unit_rays(after), pairs, EPIPOLAR_GATE / self._focal_length)
            kept = np.ones(len(identity), dtype=np.bool_)
            kept[new] = good
            self.forget(identity[~kept])
            identity, plane = identity[kept], plane[kept]
        observation = np.zeros((len(identity), 2, 2))
        observation[:, 0] = plane
        seen = np.full(len(identity), LEFT, dtype=np.uint8)
        return Tracks(identity=identity, observation=observation, seen=seen, flow=flow, problem="")

    def forget(self, identities: NDArray[np.int64]) -> None:
        self._wrong.update(int(name) for name in identities)
