"""From a wiring file's cameras to a source of stereo pairs."""

from __future__ import annotations

from robot_agent.hardware.cameras.genicam import GenicamStereo
from robot_agent.hardware.cameras.replayed import ReplayedStereo
from robot_agent.hardware.cameras.source import StereoSource
from robot_agent.hardware.cameras.video import VideoStereo
from weaver_shared.clock import Clock
from weaver_shared.config.hardware import GenicamCameras, ReplayedCameras, VideoCameras


def open_cameras(config: GenicamCameras | VideoCameras | ReplayedCameras, clock: Clock) -> StereoSource:
    """Raises ResourceError or InputError where they are not there."""
    match config:
        case GenicamCameras():
            return GenicamStereo(config, clock)
        case VideoCameras():
            return VideoStereo(config, clock)
        case ReplayedCameras():
            return ReplayedStereo(config, clock)
