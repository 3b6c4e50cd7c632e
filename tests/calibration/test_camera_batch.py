"""Cameras from corners: the truth is found, OpenCV agrees, wrong corners do no harm, too little is refused."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from target_scenes import GRID, Scene, made_up

from robot_agent.calibration.camera_calibration import calibrate_cameras, spread_views
from robot_agent.calibration.guidance import wishes
from robot_agent.calibration.rig_batch import RigEstimate
from robot_agent.calibration.sightings import Session, Sighting
from robot_agent.calibration.verdicts import judge_cameras
from weaver_shared.errors import InputError
from weaver_shared.transforms import rotation_log


@pytest.fixture(scope="module")
def estimate(scene: Scene) -> RigEstimate:
    return calibrate_cameras(scene.session, GRID, "radtan")


def test_lenses_and_baseline_come_out_as_they_are(scene: Scene, estimate: RigEstimate) -> None:
    truth = scene.truth.rig
    assert np.abs(estimate.rig.intrinsics[:, :2] / truth.intrinsics[:, :2] - 1.0).max() < 0.001
    assert np.abs(estimate.rig.intrinsics[:, 2:4] - truth.intrinsics[:, 2:4]).max() < 0.5
    assert abs(estimate.rig.baseline - truth.baseline) < 1e-4
    turned = estimate.rig.eye_from_first[1].rotation.T @ truth.eye_from_first[1].rotation
    assert np.degrees(np.linalg.norm(rotation_log(turned))) < 0.03
    assert estimate.sigma == pytest.approx(0.05, rel=0.1)


def test_the_covariance_is_honest(scene: Scene, estimate: RigEstimate) -> None:
    error = (estimate.rig.intrinsics - scene.truth.rig.intrinsics).ravel()
    squared = error @ np.linalg.solve(estimate.covariance[:16, :16], error)
    assert 4.0 < squared < 40.0  # chi squared with 16 degrees of freedom, 99.9 % band


def test_one_eye_agrees_with_opencv(scene: Scene) -> None:
    views = [view.eyes[0] for view in scene.session.views if view.eyes[0] is not None]
    single = Session(
        views=tuple(replace(view, eyes=view.eyes[:1]) for view in scene.session.views if view.eyes[0] is not None),
        sizes=scene.truth.rig.sizes[:1],
        pictures=len(views),
    )
    ours = calibrate_cameras(single, GRID, "radtan")
    start = np.array([[450.0, 0.0, 319.5], [0.0, 450.0, 239.5], [0.0, 0.0, 1.0]])
    rms, matrix, *_ = cv2.calibrateCamera(
        [GRID.points[view.corners].astype(np.float32) for view in views],
        [view.pixels.astype(np.float32) for view in views],
        scene.truth.rig.sizes[0],
        start,
        np.zeros(5),
        flags=cv2.CALIB_FIX_K3 | cv2.CALIB_USE_INTRINSIC_GUESS,
    )
    assert ours.rms == pytest.approx(rms, rel=0.02)
    np.testing.assert_allclose(ours.rig.intrinsics[0, :4], matrix[[0, 1, 0, 1], [0, 1, 2, 2]], atol=0.05)


def test_wild_corners_are_left_out(scene: Scene, estimate: RigEstimate) -> None:
    generator = np.random.default_rng(1)

    def spoiled(sighting: Sighting | None) -> Sighting | None:
        if sighting is None:
            return None
        wrong = generator.random(len(sighting)) < 0.05
        return replace(sighting, pixels=sighting.pixels + wrong[:, None] * generator.uniform(5.0, 40.0, (1, 2)))

    views = tuple(replace(view, eyes=tuple(map(spoiled, view.eyes))) for view in scene.session.views)
    disturbed = calibrate_cameras(replace(scene.session, views=views), GRID, "radtan")
    assert 0.03 < 1.0 - disturbed.used.mean() < 0.07
    change = disturbed.rig.intrinsics - estimate.rig.intrinsics
    assert (np.abs(change) < 3.0 * estimate.intrinsics_sigma).all()


def test_good_views_are_told_from_poor_ones(scene: Scene, estimate: RigEstimate) -> None:
    wished = wishes(scene.session, estimate.first_from_target)
    assert all(wish.met for wish in wished if "tilted" in wish.what)
    assert judge_cameras(estimate, wished).usable
    facing = [replace(pose, rotation=np.diag([1.0, -1.0, -1.0])) for pose in estimate.first_from_target]
    missing = [wish.advice for wish in wishes(scene.session, facing) if not wish.met]
    assert sum("tilt" in advice for advice in missing) == 4
    assert any("line of sight" in advice for advice in missing)


def test_too_few_views_are_refused_and_the_eye_is_named(scene: Scene) -> None:
    blind = tuple(replace(view, eyes=(view.eyes[0], None)) for view in scene.session.views)
    with pytest.raises(InputError, match=r"right eye sees the target in 0 of \d+ pictures"):
        calibrate_cameras(replace(scene.session, views=blind), GRID, "radtan")
    with pytest.raises(InputError, match="left eye sees the target in 3"):
        calibrate_cameras(replace(scene.session, views=scene.session.views[:3]), GRID, "radtan")


def test_a_long_recording_is_thinned_evenly(scene: Scene) -> None:
    chosen = spread_views(scene.views, 12)
    assert len(chosen) == 12
    stamps = [view.stamp_ns for view in chosen]
    assert stamps == sorted(stamps)
    assert max(np.diff(stamps)) < 4 * np.median(np.diff(stamps))


def test_a_fisheye_comes_out_as_it_is() -> None:
    fisheye = made_up(np.random.default_rng(8), seconds=5.0, model="equidistant", with_imu=False)
    views = tuple(replace(view, eyes=view.eyes[:1]) for view in fisheye.views[::4] if view.eyes[0] is not None)
    truth = fisheye.truth.rig
    estimate = calibrate_cameras(Session(views=views, sizes=truth.sizes[:1], pictures=len(views)), GRID, "equidistant")
    assert np.abs(estimate.rig.intrinsics[0, :2] / truth.intrinsics[0, :2] - 1.0).max() < 0.002
    assert np.abs(estimate.rig.intrinsics[0, 2:4] - truth.intrinsics[0, 2:4]).max() < 0.5
    assert estimate.sigma == pytest.approx(0.05, rel=0.1)
