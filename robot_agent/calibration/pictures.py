"""Where pictures to calibrate with come from: a folder of them, of pairs, or a recording (ASL folder or MCAP)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np

from robot_agent.calibration.recorded_pictures import open_recorded_pictures
from robot_agent.calibration.sightings import Picture
from robot_agent.recording import is_recording
from weaver_shared.errors import InputError
from weaver_shared.messages import ImuBatch

SUFFIXES = (".png", ".jpg", ".jpeg", ".bmp", ".pgm", ".tif", ".tiff")

SAME_INSTANT_NS = 2_000_000
"""Pictures of both eyes within this are one view."""

_EYE = re.compile(r"^(left|right)(.*)$", re.IGNORECASE)


class Pictures(Protocol):
    """Pictures of one or two eyes by instant, and the inertia recorded with them, if any."""

    @property
    def folder(self) -> Path: ...

    @property
    def eyes(self) -> int: ...

    @property
    def inertia(self) -> ImuBatch | None:
        """Samples at the instants of their stamps."""
        ...

    def __len__(self) -> int: ...

    def sizes(self) -> tuple[tuple[int, int], ...]:
        """Width and height of each eye's pictures, px."""
        ...

    def __iter__(self) -> Iterator[tuple[int, str, tuple[Picture | None, ...]]]:
        """Stamp, name and pictures."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class PictureSource:
    """Files by instant; pictures are only loaded when they are asked for."""

    folder: Path
    eyes: int
    files: tuple[tuple[int, tuple[Path | None, ...]], ...]  # stamp (ns, or the number), one file per eye
    inertia: ImuBatch | None

    def __len__(self) -> int:
        return len(self.files)

    def sizes(self) -> tuple[tuple[int, int], ...]:
        """Width and height of each eye's first picture, px."""
        found = []
        for eye in range(self.eyes):
            first = next((files[eye] for _, files in self.files if files[eye] is not None), None)
            if first is None:
                raise InputError(f"{self.folder} has no picture of eye {eye}")
            height, width = load(first).shape
            found.append((width, height))
        return tuple(found)

    def __iter__(self) -> Iterator[tuple[int, str, tuple[Picture | None, ...]]]:
        """Stamp, name and pictures; raises InputError where an eye's pictures differ in size."""
        sizes = self.sizes()
        for stamp, files in self.files:
            pictures = tuple(None if file is None else load(file) for file in files)
            for picture, size, file in zip(pictures, sizes, files, strict=True):
                if picture is not None and picture.shape != size[::-1]:
                    height, width = picture.shape
                    raise InputError(
                        f"{file} is {width} x {height} px, the pictures before it {size[0]} x {size[1]}; one "
                        "calibration needs pictures of one size"
                    )
            yield stamp, next(file.name for file in files if file is not None), pictures


def open_pictures(folder: Path) -> Pictures:
    """A robot's own recording, ASL folder (mav0 or its parent), folder with left*/right* pairs, or one eye's pictures.

    Raises InputError that says what is missing.
    """
    if is_recording(folder):
        return open_recorded_pictures(folder)
    if not folder.is_dir():
        raise InputError(f"{folder} is not a folder; pictures or a recording with mav0/cam0 in it are needed")
    root = folder / "mav0" if (folder / "mav0").is_dir() else folder
    if (root / "cam0").is_dir():
        return _recording(folder, root)
    files = sorted(path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES)
    if not files:
        raise InputError(f"{folder} has no pictures ({', '.join(SUFFIXES)}) and no cam0 folder")
    return _pairs(folder, files)


def load(path: Path) -> Picture:
    picture = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if picture is None:
        raise InputError(f"{path} can not be read as a picture")
    return np.asarray(picture, dtype=np.uint8)


def _pairs(folder: Path, files: list[Path]) -> PictureSource:
    by_rest: dict[str, list[Path | None]] = {}
    for path in files:
        match = _EYE.match(path.stem)
        if match:
            by_rest.setdefault(match[2], [None, None])[match[1].lower() == "right"] = path
    if not by_rest:
        single = tuple((number, (path,)) for number, path in enumerate(files))
        return PictureSource(folder=folder, eyes=1, files=single, inertia=None)
    for eye, name in enumerate(("left", "right")):
        if all(pair[eye] is None for pair in by_rest.values()):
            raise InputError(f"{folder} has no {name}* pictures; the {name} eye is missing")
    pairs = tuple((number, tuple(by_rest[rest])) for number, rest in enumerate(sorted(by_rest)))
    return PictureSource(folder=folder, eyes=2, files=pairs, inertia=None)


def _recording(folder: Path, root: Path) -> PictureSource:
    left = _listing(root / "cam0")
    if not left:
        raise InputError(f"{folder} has no pictures in {root / 'cam0' / 'data'}")
    inertia = _inertia(root / "imu0" / "data.csv") if (root / "imu0" / "data.csv").is_file() else None
    if not (root / "cam1").is_dir():
        single = tuple((stamp, (path,)) for stamp, path in left.items())
        return PictureSource(folder=folder, eyes=1, files=single, inertia=inertia)
    right = _listing(root / "cam1")
    if not right:
        raise InputError(f"{folder} has no pictures in {root / 'cam1' / 'data'}: the right eye is missing")
    stamps = np.array(list(right), dtype=np.int64)
    files: list[tuple[int, tuple[Path | None, ...]]] = []
    for stamp, path in left.items():
        nearest = int(stamps[np.argmin(np.abs(stamps - stamp))])
        files.append((stamp, (path, right[nearest] if abs(nearest - stamp) <= SAME_INSTANT_NS else None)))
    return PictureSource(folder=folder, eyes=2, files=tuple(files), inertia=inertia)


def _listing(camera: Path) -> dict[int, Path]:
    """Pictures by stamp (ns): those of data.csv, or those whose names are stamps."""
    found = {
        int(path.stem): path
        for path in (camera / "data").glob("*")
        if path.stem.isdigit() and path.suffix.lower() in SUFFIXES
    }
    if (camera / "data.csv").is_file():
        for line in (camera / "data.csv").read_text().splitlines():
            stamp, _, name = line.strip().partition(",")
            path = camera / "data" / name.strip()
            if stamp.isdigit() and path.is_file():
                found[int(stamp)] = path
    return dict(sorted(found.items()))


def _inertia(path: Path) -> ImuBatch:
    """Samples at the instants of their stamps."""
    try:
        lines = [line.split(",") for line in path.read_text().splitlines() if line[:1].isdigit()]
        stamps = np.array([int(line[0]) for line in lines], dtype=np.int64)
        table = np.array([[float(x) for x in line[1:7]] for line in lines])
    except (OSError, ValueError) as error:
        raise InputError(f"{path} can not be read as stamp, 3 angular velocities, 3 accelerations: {error}") from error
    if table.ndim != 2 or table.shape[1] != 6:
        raise InputError(f"{path} holds no table of stamp, 3 angular velocities, 3 accelerations")
    good = np.isfinite(table).all(axis=1)
    order = np.flatnonzero(good)[np.unique(stamps[good], return_index=True)[1]]
    return ImuBatch(
        stamp_ns=stamps[order],
        angular_velocity_in_imu=table[order, :3],
        specific_force_in_imu=table[order, 3:],
    )
