"""Camera and IMU as it goes along: sightings of the target and what the IMU felt meanwhile, and what still lacks."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

from robot_agent.calibration.excitation import LEAST_SECONDS as WANTED_SECONDS
from robot_agent.calibration.felt_motion import LEAST, FeltMotion
from robot_agent.calibration.guidance import Wish
from robot_agent.calibration.inertial_calibration import InertialEstimate, calibrate_imu
from robot_agent.calibration.inertial_start import LONGEST_GAP
from robot_agent.calibration.instants import at_instants
from robot_agent.calibration.looking import LEAST_CORNERS, called, detector_of, sized
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.sightings import Sighting, View
from robot_agent.calibration.target import Target
from robot_agent.calibration.verdicts import Verdict, judge_imu
from weaver_shared.errors import InputError
from weaver_shared.messages import CalibrationMotion, ImuBatch, StereoFrame
from weaver_shared.robots.description import Imu

LEAST_SECONDS = 5.0
ENOUGH_SECONDS = 20.0
MOST_SECONDS = 90.0
"""With the target in view; more is not kept, as solving takes as long as was recorded."""

LONGEST = 180.0
"""From the first sighting to the last, s."""

BEFORE = 100
"""Batches of samples kept before the first sighting."""

LOOKS = 12
"""Pictures by which it is told how often one comes."""

HOW = {
    ("turn", "x"): "roll it, left side up, right side up",
    ("turn", "y"): "nod it, front up, front down",
    ("turn", "z"): "turn it to its left and to its right",
    ("push", "x"): "push it forward and back",
    ("push", "y"): "push it to its left and to its right",
    ("push", "z"): "push it up and down",
}
"""By the IMU's axes, which are the body's."""


class GuidedInertial:
    """`lenses` are known, and by whom is told in `told_by`; `imu` is what its data sheet says."""

    def __init__(self, target: Target, lenses: Rig, told_by: str, imu: Imu) -> None:
        self.target = target
        self.lenses = lenses
        self.imu = imu
        self._told_by = told_by
        self._detector = detector_of(target)
        self._views: list[View] = []
        self._felt: list[ImuBatch] = []
        self._motion = FeltMotion()
        self._seen_ns = -1
        self._looked_ns: deque[int] = deque(maxlen=LOOKS)
        self.samples = 0
        self.pictures = 0
        self.seconds = 0.0  # with the target in view
        self.sightings: tuple[Sighting | None, ...] = (None,) * lenses.eyes

    @property
    def views(self) -> int:
        return len(self._views)

    @property
    def full(self) -> bool:
        """Nothing more is kept."""
        return self.seconds >= MOST_SECONDS or (
            bool(self._views) and (self._views[-1].stamp_ns - self._views[0].stamp_ns) * 1e-9 >= LONGEST
        )

    def look(self, frame: StereoFrame) -> bool:
        """Look for the target; whether it was there. Raises InputError for pictures of another size."""
        self.pictures += 1
        self._looked_ns.append(frame.stamp_ns)
        self.sightings = tuple(
            self._detector.detect(sized(picture, size, self._told_by)) if picture.size else None
            for picture, size in zip((frame.left, frame.right), self.lenses.sizes, strict=True)
        )
        if self._most_corners() < LEAST_CORNERS or self.full or (self._views and frame.stamp_ns <= self._seen_ns):
            return False
        gap = (frame.stamp_ns - self._seen_ns) * 1e-9
        self.seconds += gap if self._views and gap < LONGEST_GAP else 0.0
        self._seen_ns = frame.stamp_ns
        self._views.append(View(stamp_ns=frame.stamp_ns, eyes=self.sightings, name=f"picture {frame.sequence}"))
        return True

    def feel(self, samples: ImuBatch) -> None:
        """What the IMU felt, as the robot tells it, oldest first."""
        if not len(samples.stamp_ns):
            return
        late = (int(samples.stamp_ns[-1]) - self._seen_ns) * 1e-9
        self._motion.feel(samples, counts=bool(self._views) and late < 2.0 * LONGEST_GAP)
        if not self.full:
            self._felt.append(samples)
            self.samples += len(samples.stamp_ns)
        if not self._views:
            del self._felt[:-BEFORE]

    def motions(self) -> list[CalibrationMotion]:
        return [
            CalibrationMotion(
                kind="turn" if k < 3 else "push",
                axis="xyz"[k % 3],
                now=float(now),
                least=float(LEAST[k]),
                unit="rad/s" if k < 3 else "m/s^2",
                seconds=float(seconds),
                wanted=WANTED_SECONDS,
                met=bool(seconds >= WANTED_SECONDS - 1e-6),
            )
            for k, (now, seconds) in enumerate(zip(self._motion.now, self._motion.seconds, strict=True))
        ]

    def wishes(self) -> list[Wish]:
        more = max(0.0, ENOUGH_SECONDS - self.seconds)
        pace = self._pace()
        return [
            Wish(
                what=f"{self.samples} samples of the IMU",
                met=self.samples > 0,
                advice="no samples of the IMU come: is the robot switched on, was its IMU recorded?",
            ),
            Wish(
                what=f"{pace:.1f} pictures a second",
                met=pace > 1.0 / LONGEST_GAP,
                advice="pictures are looked at too seldom: record the motion first, and calibrate from the recording",
            ),
            Wish(
                what=f"{self.seconds:.0f} s with the target in view",
                met=more == 0.0,
                advice=f"keep moving for {more:.0f} s more, the target in view",
            ),
        ]

    def advice(self) -> str:
        """What to do next, in words."""
        felt, often, lasted = self.wishes()
        if self.pictures and not felt.met:
            return felt.advice
        if self.full:
            return "no more is kept: solve, or start again"
        if self.pictures and self._most_corners() < LEAST_CORNERS:
            return f"bring the target into the picture and keep it there: looking for {called(self.target)}"
        if len(self._looked_ns) == LOOKS and not often.met:
            return often.advice
        for motion in self.motions():
            if not motion.met:
                return (
                    f"{HOW[motion.kind, motion.axis]}, quickly, with {motion.least:g} {motion.unit} or more, "
                    f"for {motion.wanted - motion.seconds:.0f} s more"
                )
        return "all of it is there: solve" if lasted.met else lasted.advice

    def solve(self, tell: Callable[[str], None] = lambda _: None) -> tuple[InertialEstimate, Verdict]:
        """Where the IMU is and how late the pictures are. Raises InputError where too little was felt or seen."""
        if not self.samples:
            raise InputError("there are no samples of the IMU; its place can not be found without them")
        if not self._views:
            raise InputError(
                f"the target was seen in none of {self.pictures} pictures: looked for {called(self.target)}"
            )
        if self.seconds < LEAST_SECONDS:
            raise InputError(
                f"the target was in view for {self.seconds:.1f} s; at least {LEAST_SECONDS:g} s are needed, "
                f"{ENOUGH_SECONDS:g} s or more are good"
            )
        inertia = at_instants(ImuBatch.join(list(self._felt)), self.imu.rate)
        estimate = calibrate_imu(self.lenses, list(self._views), self.target, inertia, self.imu, tell=tell)
        return estimate, judge_imu(estimate)

    def _pace(self) -> float:
        """Of the pictures looked at last, 1/s."""
        span = self._looked_ns[-1] - self._looked_ns[0] if self._looked_ns else 0
        return (len(self._looked_ns) - 1) / (span * 1e-9) if span > 0 else 0.0

    def _most_corners(self) -> int:
        return max(len(sighting) if sighting else 0 for sighting in self.sightings)
