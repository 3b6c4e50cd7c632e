"""Pictures: the robot's stereo camera and an observer beside it."""

from sim_agent.rendering.observer import Observer
from sim_agent.rendering.stereo import StereoRenderer, frame_sequence

__all__ = ["Observer", "StereoRenderer", "frame_sequence"]
