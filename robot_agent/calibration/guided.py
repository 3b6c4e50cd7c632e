"""A calibration as it goes along: picture after picture is looked at, and those that add something are kept."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.camera_calibration import calibrate_cameras, locate_views
from robot_agent.calibration.guidance import Wish, cover_of, wishes
from robot_agent.calibration.looking import LEAST_CORNERS, called, detector_of, sized
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.rig_batch import RigEstimate
from robot_agent.calibration.sightings import Session, Sighting, View
from robot_agent.calibration.target import Target
from robot_agent.calibration.verdicts import Verdict, judge_cameras
from robot_agent.vision.camera import Distortion
from weaver_shared.messages import StereoFrame
from weaver_shared.transforms import Pose, rotation_log

MOST_VIEWS = 80
ANOTHER_TURN = np.radians(7.0)
ANOTHER_WAY = 0.07
"""Of the distance to the target: a view is another one when it differs by this much from every one that was kept."""


class GuidedCalibration:
    """`guess` are lenses about right, such as the robot description's: good enough to tell one view from another."""

    def __init__(self, target: Target, guess: Rig) -> None:
        self.target = target
        self._guess = guess
        self._detector = detector_of(target)
        self._views: list[View] = []
        self._poses: list[Pose] = []
        self.pictures = 0
        self.sightings: tuple[Sighting | None, ...] = (None,) * guess.eyes

    @property
    def views(self) -> int:
        return len(self._views)

    @property
    def session(self) -> Session:
        return Session(views=tuple(self._views), sizes=self._guess.sizes, pictures=self.pictures)

    def look(self, frame: StereoFrame) -> bool:
        """Look for the target; whether the view was kept. Raises InputError for pictures of another size."""
        self.pictures += 1
        self.sightings = tuple(
            self._detector.detect(sized(picture, size, "the robot's description")) if picture.size else None
            for picture, size in zip((frame.left, frame.right), self._guess.sizes, strict=True)
        )
        view = View(stamp_ns=frame.stamp_ns, eyes=self.sightings, name=f"picture {frame.sequence}")
        if len(self._views) >= MOST_VIEWS or max(len(s) if s else 0 for s in self.sightings) < LEAST_CORNERS:
            return False
        located, poses = locate_views(self._guess, [view], self.target)
        if not located or not all(_differs(poses[0], known) for known in self._poses):
            return False
        self._views.append(view)
        self._poses.append(poses[0])
        return True

    def cover(self) -> NDArray[np.int64]:
        """(eyes, 6, 8) corners seen in each field of the picture."""
        return np.stack([cover_of(self.session, eye) for eye in range(self._guess.eyes)])

    def wishes(self) -> list[Wish]:
        """What a good set of views has; by the guessed lenses."""
        return wishes(self.session, self._poses)

    def advice(self) -> str:
        """What to do next, in words."""
        seen = max(len(s) if s else 0 for s in self.sightings)
        if self.pictures and seen == 0:
            return f"bring the target into the picture: looking for {called(self.target)}"
        if self.pictures and seen < LEAST_CORNERS:
            return f"show more of the target: {seen} corners are seen, {LEAST_CORNERS} are needed"
        missing = next((wish.advice for wish in self.wishes() if not wish.met), "")
        return missing or "all views are there: solve"

    def solve(
        self, model: Distortion, tell: Callable[[str], None] = lambda _: None
    ) -> tuple[RigEstimate, list[Wish], Verdict]:
        """Lenses and places of the eyes. Raises InputError where too little was seen."""
        session = self.session
        estimate = calibrate_cameras(session, self.target, model, tell)
        wished = wishes(session, estimate.first_from_target)
        return estimate, wished, judge_cameras(estimate, wished)


def _differs(pose: Pose, known: Pose) -> bool:
    turn = float(np.linalg.norm(rotation_log(pose.rotation.T @ known.rotation)))
    way = float(np.linalg.norm(pose.position - known.position))
    return turn > ANOTHER_TURN or way > ANOTHER_WAY * float(np.linalg.norm(known.position))
