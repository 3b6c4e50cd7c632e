"""Stereo cameras: GenICam, whatever OpenCV opens, and recordings."""

from robot_agent.hardware.cameras.pairing import Eye, PairCounts, Pairing, Picture

__all__ = ["Eye", "PairCounts", "Pairing", "Picture"]
