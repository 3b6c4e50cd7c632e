"""Pictures to calibrate with from a robot's own recording (MCAP)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from robot_agent.calibration.instants import at_instants
from robot_agent.calibration.sightings import Picture
from robot_agent.recording import Recording, open_recording
from weaver_shared import topics
from weaver_shared.errors import InputError
from weaver_shared.messages import ImuBatch, Proprioception, StereoFrame


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedPictures:
    """The pairs of a recording; they are only unpacked when they are asked for."""

    folder: Path  # the file
    inertia: ImuBatch | None
    pairs: int
    first_sizes: tuple[tuple[int, int], ...]
    recording: Recording

    @property
    def eyes(self) -> int:
        return len(self.first_sizes)

    def __len__(self) -> int:
        return self.pairs

    def sizes(self) -> tuple[tuple[int, int], ...]:
        """Width and height of each eye's pictures, px."""
        return self.first_sizes

    def __iter__(self) -> Iterator[tuple[int, str, tuple[Picture | None, ...]]]:
        """Stamp, name and pictures; raises InputError where an eye's pictures differ in size."""
        for _, _, frame in self.recording.messages(topics.STEREO):
            pictures = (frame.left, frame.right)
            for picture, (width, height) in zip(pictures, self.first_sizes, strict=True):
                if picture.size and picture.shape != (height, width):
                    raise InputError(
                        f"{self.folder} has pictures of {width} x {height} and of {picture.shape[1]} x "
                        f"{picture.shape[0]} px; one calibration needs pictures of one size"
                    )
            yield frame.stamp_ns, f"picture {frame.sequence}", tuple(p if p.size else None for p in pictures)


def open_recorded_pictures(path: Path) -> RecordedPictures:
    """Raises InputError that says what the file lacks."""
    recording = open_recording(path)
    inertia: list[ImuBatch] = []
    sizes: dict[int, tuple[int, int]] = {}
    pairs = 0
    for _, _, message in recording.messages(topics.STEREO, topics.PROPRIOCEPTION):
        if isinstance(message, Proprioception):
            inertia.append(message.imu)
        elif isinstance(message, StereoFrame):
            pairs += 1
            for eye, picture in enumerate((message.left, message.right)):
                if picture.size:
                    sizes.setdefault(eye, (picture.shape[1], picture.shape[0]))
    if not pairs:
        raise InputError(f"{path} has no pictures; it was recorded without them, or cut before the first one")
    for eye, name in enumerate(("left", "right")):
        if eye not in sizes:
            raise InputError(f"{path} has no {name} pictures; the {name} eye is missing")
    samples = ImuBatch.join(inertia)
    return RecordedPictures(
        folder=path,
        inertia=at_instants(samples, recording.robot.imu.rate) if len(samples.stamp_ns) > 1 else None,
        pairs=pairs,
        first_sizes=(sizes[0], sizes[1]),
        recording=recording,
    )
