"""A calibrated pair as the `[camera]` of a robot's file: what it is once both pictures are rectified."""

from __future__ import annotations

from robot_agent.calibration.rig import Rig
from robot_agent.vision.camera import StereoCalibration
from robot_agent.vision.rectification import Rectifier


def camera_table(rig: Rig) -> str:
    """TOML lines; the mounting (position_in_body, pitch_down) and the rate are not a calibration's to know."""
    left, right = rig.cameras
    rectified = Rectifier(StereoCalibration(left=left, right=right))
    return (
        "# Calibrated; put into the robot's file beside position_in_body, pitch_down and rate.\n"
        "[camera]\n"
        f"width = {rectified.width}  # px\n"
        f"height = {rectified.height}  # px\n"
        f"focal_length = {rectified.fx:.3f}  # px, rectified\n"
        f"baseline = {rectified.baseline:.6f}  # m\n"
    )
