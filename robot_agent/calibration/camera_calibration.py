"""Intrinsics of one or two eyes and where they stand to each other, from views of a target."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.corner_table import CornerTable
from robot_agent.calibration.first_guess import guess_between, guess_lens, locate
from robot_agent.calibration.rig import Rig
from robot_agent.calibration.rig_batch import RigEstimate, solve_rig
from robot_agent.calibration.sightings import Session, View
from robot_agent.calibration.target import Target
from robot_agent.vision.camera import Distortion
from weaver_shared.errors import InputError
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]

LEAST_VIEWS = 5
EYES = ("left", "right")


def calibrate_cameras(
    session: Session, target: Target, model: Distortion, tell: Callable[[str], None] = lambda _: None
) -> RigEstimate:
    """Each eye alone first, then both in one batch; `tell` hears which. Raises InputError where too little was seen."""
    for eye in range(session.eyes):
        seen = len(session.seen_by(eye))
        if seen < LEAST_VIEWS:
            raise InputError(
                f"the {EYES[eye]} eye sees the target in {seen} of {session.pictures} pictures; at least "
                f"{LEAST_VIEWS} are needed, 30 or more are good"
            )
    lenses = []
    for eye in range(session.eyes):
        tell(f"lens of the {EYES[eye]} eye")
        lenses.append(_alone(session, eye, target, model))
    if session.eyes == 1:
        return lenses[0]
    tell("both eyes together")
    rig = Rig(
        models=(model,) * session.eyes,
        intrinsics=np.concatenate([lens.rig.intrinsics for lens in lenses]),
        eye_from_first=(Pose.identity(), *(_between(session, target, lenses, eye) for eye in range(1, session.eyes))),
        sizes=session.sizes,
    )
    views, poses = locate_views(rig, session.views, target)
    return solve_rig(rig, poses, CornerTable.of(views, target, range(session.eyes)))


def spread_views(views: Sequence[View], count: int) -> tuple[View, ...]:
    """At most `count` views, evenly over the recording; of each stretch the one that shows most of the target."""
    if len(views) <= count:
        return tuple(views)
    stretches = np.array_split(np.arange(len(views)), count)
    return tuple(views[max(stretch, key=lambda k: views[k].seen)] for stretch in stretches)


def locate_views(rig: Rig, views: Sequence[View], target: Target) -> tuple[list[View], list[Pose]]:
    """first_from_target of every view in which one eye can tell it; the others are left out."""
    located, poses = [], []
    cameras = rig.cameras
    for view in views:
        best = max(
            (eye for eye, sighting in enumerate(view.eyes) if sighting is not None),
            key=lambda eye: len(view.eyes[eye] or ()),
            default=None,
        )
        sighting = None if best is None else view.eyes[best]
        pose = None if best is None or sighting is None else locate(cameras[best], sighting, target)
        if best is not None and pose is not None:
            located.append(view)
            poses.append(rig.eye_from_first[best].inverse() @ pose)
    return located, poses


def _alone(session: Session, eye: int, target: Target, model: Distortion) -> RigEstimate:
    views = session.seen_by(eye)
    rig = Rig(
        models=(model,),
        intrinsics=guess_lens(views, eye, target, model, session.sizes[eye])[None],
        eye_from_first=(Pose.identity(),),
        sizes=(session.sizes[eye],),
    )
    single = [View(stamp_ns=view.stamp_ns, eyes=(view.eyes[eye],), name=view.name) for view in views]
    located, poses = locate_views(rig, single, target)
    if len(located) < LEAST_VIEWS:
        raise InputError(f"the {EYES[eye]} eye's corners fit no plane: are target and its file the same?")
    return solve_rig(rig, poses, CornerTable.of(located, target, (0,)))


def _between(session: Session, target: Target, lenses: list[RigEstimate], eye: int) -> Pose:
    pairs = []
    cameras = [lenses[0].rig.cameras[0], lenses[eye].rig.cameras[0]]
    for view in session.views:
        sightings = (view.eyes[0], view.eyes[eye])
        poses = [
            locate(camera, sighting, target) if sighting is not None else None
            for camera, sighting in zip(cameras, sightings, strict=True)
        ]
        if poses[0] is not None and poses[1] is not None:
            pairs.append((poses[0], poses[1]))
    return guess_between(pairs)
