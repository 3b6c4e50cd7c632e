"""A run of OpenSHC as rows of text, with the columns and the order of its recordings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from robot_agent.locomotion.openshc.body_pose import BodyPose
from robot_agent.locomotion.openshc.controller import Controller
from weaver_shared.transforms import wxyz_from_rotation

Array = NDArray[np.float64]

UNKNOWN = 2147483647.0
"""What OpenSHC says where nothing was ever set."""

BODY_COLUMNS = (
    *("tick", "robot_state", "walk_state", "in_vx", "in_vy", "in_wz", "vx", "vy", "wz"),
    *(f"odom_{part}" for part in ("x", "y", "z", "qw", "qx", "qy", "qz")),
    *(f"pose_{part}" for part in ("x", "y", "z", "qw", "qx", "qy", "qz")),
    *(f"auto_{part}" for part in ("x", "y", "z", "qw", "qx", "qy", "qz")),
    *(f"manual_{part}" for part in ("x", "y", "z", "qw", "qx", "qy", "qz")),
    *("imu_qw", "imu_qx", "imu_qy", "imu_qz", "incl_x", "incl_y", "plane_a", "plane_b", "plane_c"),
)


def leg_rows(tick: int, controller: Controller) -> Iterator[list[str]]:
    """One row a leg, with the columns of `trajectory_table.columns`."""
    for leg, name in enumerate(controller.description.leg_id):
        state = controller.walk.paths[leg].step_state
        yield [str(tick), name, str(state), *_texts(_leg_numbers(controller, leg))]


def _leg_numbers(controller: Controller, leg: int) -> Array:
    path, chain, admittance = controller.walk.paths[leg], controller.legs[leg], controller.admittance
    frame = chain.tip_frame()
    wanted = controller.wanted_tips[leg]
    timing = [path.phase, path.swing_progress, path.stance_progress]
    vectors = [path.tip, path.velocity, path.target, path.default, path.stride]
    vectors += [np.full(3, UNKNOWN) if wanted is None else wanted, frame[:3, 3]]
    force = np.zeros(3)  # no joint effort is simulated, in the recordings neither
    felt = [admittance.offsets[leg], [admittance.stiffness[leg]], force]
    joints = np.column_stack([chain.position, chain.rate]).ravel()
    return np.concatenate([timing, *vectors, _wxyz(frame[:3, :3]), *felt, joints])


def _wxyz(rotation: Array) -> Array:
    """With the sign Eigen gives: w positive where the trace is, else the largest diagonal element's component."""
    wxyz = wxyz_from_rotation(rotation)
    if np.trace(rotation) > 0.0:
        return wxyz
    return wxyz if wxyz[1 + int(np.argmax(np.diag(rotation)))] > 0.0 else -wxyz


def body_row(tick: int, controller: Controller) -> list[str]:
    """The body's row of a tick, with BODY_COLUMNS."""
    posing, walk = controller.posing, controller.walk
    auto = BodyPose() if posing.auto is None else posing.auto.pose
    numbers = np.concatenate(
        [
            [*controller.linear, controller.angular, *walk.velocity.linear, walk.velocity.angular],
            *(_pose(pose) for pose in (walk.odometry, posing.pose, auto, posing.manual)),
            wxyz_from_rotation(posing.imu.rotation),
            posing.inclination.position[:2],
            walk.plane,
        ]
    )
    return [str(tick), str(controller.robot_state), str(walk.state), *_texts(numbers)]


def _pose(pose: BodyPose) -> Array:
    return np.concatenate([pose.position, wxyz_from_rotation(pose.rotation)])


def _texts(numbers: Array) -> list[str]:
    return [f"{number:.10g}" for number in numbers + 0.0]
