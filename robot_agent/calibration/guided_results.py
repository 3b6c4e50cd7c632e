"""What a guided calibration of the cameras leaves: figures in words, files in a folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from robot_agent.calibration.guidance import Wish
from robot_agent.calibration.guided import GuidedCalibration
from robot_agent.calibration.kalibr_files import write_camchain, write_target
from robot_agent.calibration.report import camera_sections, write_report
from robot_agent.calibration.rig_batch import RigEstimate
from robot_agent.calibration.robot_camera import camera_table
from robot_agent.calibration.verdicts import Verdict


def save(guided: GuidedCalibration, estimate: RigEstimate, wished: list[Wish], verdict: Verdict, folder: Path) -> None:
    """Kalibr's files, the robot's `[camera]` and the report. Raises OSError."""
    folder.mkdir(parents=True, exist_ok=True)
    write_target(guided.target, folder / "target.yaml")
    write_camchain(estimate.rig, folder / "camchain.yaml")
    (folder / "camera.toml").write_text(camera_table(estimate.rig), encoding="utf-8")
    write_report("Calibration of the cameras", verdict, camera_sections(estimate, guided.session, wished), folder)


def figures(estimate: RigEstimate) -> Iterator[str]:
    """The main results as lines."""
    for eye, name in enumerate(("left", "right")[: estimate.rig.eyes]):
        fx, fy, cx, cy = estimate.rig.intrinsics[eye, :4]
        rows = estimate.table.eye == eye
        rms = float(np.sqrt((estimate.residuals[rows] ** 2).sum(axis=1).mean()))
        yield (
            f"{name} eye: focal lengths {fx:.2f} and {fy:.2f} px, centre {cx:.2f}, {cy:.2f} px, "
            f"reprojection error {rms:.3f} px"
        )
    yield f"baseline {1e3 * estimate.rig.baseline:.3f} mm"
