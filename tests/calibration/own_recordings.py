"""Rendered recordings of a target as files: an ASL folder, and the same as a robot's own recording."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from robot_agent.calibration.pictures import open_pictures
from robot_agent.recording import RecordingWriter
from sim_agent.targets.recording import TargetRecording
from sim_agent.targets.waved_robot import felt_ticks
from weaver_shared import topics
from weaver_shared.clock import SimulatedClock
from weaver_shared.messages import StereoFrame
from weaver_shared.robots import RobotDescription, load_robot

SIZE = (320, 240)
ROBOT = load_robot()


def small_eyed() -> RobotDescription:
    """Weaver with cameras of `SIZE`, about as they are."""
    camera = ROBOT.camera.model_copy(update={"width": SIZE[0], "height": SIZE[1], "focal_length": 225.0})
    return ROBOT.model_copy(update={"stereo": camera})


def write_asl(folder: Path, made: TargetRecording) -> None:
    for eye in range(2):
        (folder / "mav0" / f"cam{eye}" / "data").mkdir(parents=True)
    for stamp, pictures in made:
        for eye, picture in enumerate(pictures):
            cv2.imwrite(str(folder / "mav0" / f"cam{eye}" / "data" / f"{stamp}.png"), picture)
    (folder / "mav0" / "imu0").mkdir()
    rows = np.concatenate([made.inertia.angular_velocity_in_imu, made.inertia.specific_force_in_imu], axis=1)
    lines = [
        f"{stamp}," + ",".join(f"{x:.9g}" for x in row) for stamp, row in zip(made.inertia.stamp_ns, rows, strict=True)
    ]
    (folder / "mav0" / "imu0" / "data.csv").write_text("#timestamp\n" + "\n".join(lines) + "\n")


def write_own(asl: Path, path: Path) -> Path:
    """An ASL folder's pictures and inertia as a robot would have recorded them."""
    writer = RecordingWriter(path, robot_id="sim-1", robot=small_eyed(), clock=SimulatedClock(), started="now")
    samples = open_pictures(asl).inertia
    assert samples is not None
    eyes = [asl / "mav0" / eye / "data" for eye in ("cam0", "cam1")]
    seen = []
    for sequence, picture in enumerate(sorted(eyes[0].glob("*.png"))):
        left, right = (cv2.imread(str(eye / picture.name), cv2.IMREAD_GRAYSCALE) for eye in eyes)
        seen.append(StereoFrame(stamp_ns=int(picture.stem), sequence=sequence, left=left, right=right))
    for message in sorted([*felt_ticks(samples, ROBOT), *seen], key=lambda told: told.stamp_ns):
        writer.write((topics.STEREO if isinstance(message, StereoFrame) else topics.PROPRIOCEPTION).key, message)
    writer.close()
    return path
