"""Stereo-inertial odometry: a keyframe sliding window over corners and preintegrated inertia (ICRA'17 III-A)."""

from robot_agent.odometry.estimator import StereoInertialOdometry
from robot_agent.odometry.followed import Followed
from robot_agent.odometry.own_legs import OwnLegs
from robot_agent.odometry.propagator import NavigationState, StatePropagator
from robot_agent.odometry.recorded_tracks import RecordedTracks
from robot_agent.odometry.warming import warm_up

__all__ = [
    "Followed",
    "NavigationState",
    "OwnLegs",
    "RecordedTracks",
    "StatePropagator",
    "StereoInertialOdometry",
    "warm_up",
]
