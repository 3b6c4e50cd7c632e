"""Corners followed from picture to picture and from the left eye to the right (grid FAST, pyramidal Lucas-Kanade).

Pictures stay raw, only points are undistorted. Every search starts where inertia and the last known depth say the
feature went, so that small windows and few pyramid levels do.

From picture to picture each search adds its small error to the last one's. Where the view hardly changes that is all
that moves, so there a feature is looked for once more, from an earlier picture that is kept: errors do not add up, and
a robot that sways on one spot stays there.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.corner_grid import CornerGrid
from robot_agent.odometry.depth_plane import fit_inverse_depth, inverse_depth
from robot_agent.odometry.exposure import matched, picture_problem
from robot_agent.odometry.followed import Followed
from robot_agent.odometry.ground_warp import carried, ground_warp, inverted, warped
from robot_agent.odometry.landmarks import LEFT, RIGHT
from robot_agent.odometry.outlier_rejection import consistent, unit_rays
from robot_agent.odometry.own_legs import Cover, OwnLegs, hidden
from robot_agent.odometry.tracks import Tracks
from robot_agent.vision.camera import PinholeCamera, StereoCalibration
from robot_agent.vision.distortion import normalise, project
from weaver_shared.config.odometry import FrontEndConfig
from weaver_shared.messages import StereoFrame
from weaver_shared.transforms import Pose

Array = NDArray[np.float64]
Picture = NDArray[np.uint8]
Mask = NDArray[np.bool_]

HYPOTHESES = 60
"""Pairs tried for the direction of travel: 99.9 % sure of one good pair at 65 % good tracks."""

FEW = 0.4
"""Of the tracks; where fewer survive a picture, it was not looked for them in the right place."""

FIRST_INVERSE_DEPTHS = (0.02, 0.8, 1.6, 2.5)
"""1/m, where the right eye is searched while no depth is known at all."""

_STOP = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 20, 0.01)


class FrontEnd:
    """Follows features through a stereo sequence; `step` wants the predicted motion of the left eye."""

    def __init__(self, calibration: StereoCalibration, config: FrontEndConfig) -> None:
        self._left, self._right = calibration.left, calibration.right
        self._config = config
        self._grid = CornerGrid(self._left.width, self._left.height, config)
        self._right_from_left = self._right.body_from_camera.inverse() @ self._left.body_from_camera
        self._random = np.random.default_rng(7)
        self._previous: Picture | None = None
        self._next_identity = 0
        self._identity = np.zeros(0, dtype=np.int64)
        self._pixel = np.zeros((0, 2))  # in the left picture
        self._depth = np.zeros(0)  # m along the left optical axis, NaN unknown
        self._ground: Array | None = None  # inverse depth over the picture, from the newest matched pair
        self._predictable = False  # the last picture's features were where they were expected
        self._kept: Picture | None = None  # an earlier picture of much the same view
        self._kept_pixel = np.zeros((0, 2))  # of the tracks in that picture, NaN of those found later
        self._rejected = np.zeros((0, 2))  # px in the newest picture
        self.followed = Followed.nothing()

    def step(self, frame: StereoFrame, left_from_previous: Pose, legs: OwnLegs | None = None) -> Tracks:
        """Follow features into `frame` and find new ones, none of them on the robot's own legs."""
        left_problem = picture_problem(frame.left, self._left.width, self._left.height, self._config)
        if left_problem:
            self.forget_all()
            return Tracks.none(f"left picture {left_problem}")
        right_problem = picture_problem(frame.right, self._right.width, self._right.height, self._config)
        left_cover, right_cover = (None if legs is None else legs.cover(eye) for eye in (self._left, self._right))
        flow = self._follow(frame.left, left_from_previous, left_cover)
        self._find_from_kept(frame.left)
        self._refill(frame.left, left_cover)
        self._keep_picture(frame.left)
        plane = normalise(self._left, self._pixel)
        observation = np.zeros((len(plane), 2, 2))
        observation[:, 0] = plane
        seen = np.full(len(plane), LEFT, dtype=np.uint8)
        if not right_problem:
            observation[:, 1], matches = self._match(frame.left, matched(frame.right, frame.left), plane, right_cover)
            seen[matches] |= RIGHT
        self._previous = frame.left
        self.followed = Followed(self._identity, self._pixel, seen == LEFT | RIGHT, self._rejected)
        return Tracks(
            identity=self._identity.copy(),
            observation=observation,
            seen=seen,
            flow=flow,
            problem=f"right picture {right_problem}" if right_problem else "",
        )

    def forget(self, identities: NDArray[np.int64]) -> None:
        """Give up tracks the back end found to be wrong."""
        if len(identities):
            self._keep(~np.isin(self._identity, identities))
            self.followed = self.followed.without(identities)

    def forget_all(self) -> None:
        self._keep(np.zeros(len(self._identity), dtype=np.bool_))
        self._previous = None
        self._kept = None
        self._ground = None
        self._predictable = False
        self.followed = Followed.nothing()

    def _keep(self, mask: Mask) -> None:
        self._identity, self._pixel, self._depth = self._identity[mask], self._pixel[mask], self._depth[mask]
        self._kept_pixel = self._kept_pixel[mask]

    def _follow(self, picture: Picture, left_from_previous: Pose, cover: Cover | None) -> float:
        """Move all tracks into the new picture; median motion in px."""
        self._rejected = np.zeros((0, 2))
        if self._previous is None or len(self._pixel) == 0:
            return float("nan")
        before = normalise(self._left, self._pixel)
        depth = self._assumed_depth(before)
        moved = left_from_previous.transform(np.column_stack([before, np.ones(len(before))]) * depth[:, None])
        guess = project(self._left, moved)
        guess = np.where(np.isfinite(guess), guess, self._pixel)
        warp = ground_warp(self._left, self._left, left_from_previous, self._ground, self._config.window)
        found, tracked, _ = self._search(
            self._previous, warped(picture, warp), warp, guess, predicted=self._predictable
        )
        good = self._plausible(before, found, tracked, left_from_previous, cover)
        if good.sum() < FEW * len(good):
            # The prediction was wrong: from where the features were, at all levels, and without a warp.
            again, refound, _ = self._search(self._previous, picture, None, self._pixel, predicted=False)
            plausible = self._plausible(before, again, refound, left_from_previous, cover)
            if plausible.sum() > good.sum():
                found, good, tracked = again, plausible, refound
        old, self._pixel, self._depth = self._pixel, found, np.where(good, moved[:, 2], np.nan)
        self._predictable = 2 * int(good.sum()) > len(good) and _median_distance(found, guess, good) < (
            self._config.surprise
        )
        self._rejected = found[tracked & ~good & self._inside(self._left, found)]
        flow = _median_distance(found, old, good)
        self._keep(good)
        return flow

    def _plausible(
        self, before: Array, found: Array, tracked: Mask, left_from_previous: Pose, cover: Cover | None
    ) -> Mask:
        """Which tracks, `before` on the plane z = 1, were found where one motion of the eye can have led them."""
        good = tracked & self._inside(self._left, found) & ~hidden(cover, found)
        rows = np.flatnonzero(good)
        if len(rows) >= 8:
            turned = unit_rays(before) @ left_from_previous.rotation.T
            pairs = self._random.integers(0, len(rows), (HYPOTHESES, 2))
            gate = self._config.epipolar_gate / self._left.fx
            good[rows] = consistent(turned[rows], unit_rays(normalise(self._left, found))[rows], pairs, gate)
        return np.asarray(good)

    def _search(
        self, first: Picture, second: Picture, warp: Array | None, guess: Array, *, predicted: bool
    ) -> tuple[Array, Mask, Array]:
        """Find the tracks of the first picture, near `guess` (n, 2), in the second, `warp`ed to look like it."""
        config = self._config
        levels = config.predicted_levels if predicted else config.levels
        back = None if warp is None else inverted(warp)
        found, tracked, error = _lucas_kanade(first, second, self._pixel, carried(back, guess), config.window, levels)
        return carried(warp, found), tracked, error

    def _find_from_kept(self, picture: Picture) -> None:
        """Put right what following from picture to picture has gathered since the kept one."""
        known = np.isfinite(self._kept_pixel[:, 0])
        if self._kept is None or not known.any():
            return
        rows = np.flatnonzero(known)
        found, tracked, _ = _lucas_kanade(
            self._kept, picture, self._kept_pixel[rows], self._pixel[rows], self._config.window, 0
        )
        near = np.linalg.norm(found - self._pixel[rows], axis=1) < self._config.largest_correction
        self._pixel[rows[tracked & near]] = found[tracked & near]

    def _keep_picture(self, picture: Picture) -> None:
        """Keep this picture instead, once the view has changed or most of its features are gone."""
        known = np.isfinite(self._kept_pixel[:, 0])
        change = _median_distance(self._pixel, self._kept_pixel, known)
        if not (change < self._config.same_view) or 2 * int(known.sum()) < len(known):
            self._kept, self._kept_pixel = picture, self._pixel.copy()

    def _refill(self, picture: Picture, cover: Cover | None) -> None:
        if len(self._pixel) > 0.92 * self._config.features:
            return
        corners = self._grid.refill(picture, self._pixel, cover)
        identities = np.arange(self._next_identity, self._next_identity + len(corners))
        self._next_identity += len(corners)
        self._identity = np.concatenate([self._identity, identities])
        self._pixel = np.concatenate([self._pixel, corners])
        self._depth = np.concatenate([self._depth, np.full(len(corners), np.nan)])
        self._kept_pixel = np.concatenate([self._kept_pixel, np.full((len(corners), 2), np.nan)])

    def _match(self, left: Picture, right: Picture, plane: Array, cover: Cover | None) -> tuple[Array, Mask]:
        """Find the tracks, at `plane` (n, 2) in the left eye, in the right one: where, and which are good."""
        if self._ground is None:
            guesses = [np.full(len(plane), guess) for guess in FIRST_INVERSE_DEPTHS]
        else:
            assumed = np.where(np.isfinite(self._depth), self._depth, 1.0 / inverse_depth(self._ground, plane))
            guesses = [1.0 / np.maximum(assumed, self._config.nearest)]
        best = np.zeros((len(plane), 2))
        best_error = np.full(len(plane), np.inf)
        best_depth = np.full(len(plane), np.nan)
        warp = ground_warp(self._left, self._right, self._right_from_left, self._ground, self._config.window)
        seen = warped(right, warp)
        for guess in guesses:
            where, error, depth = self._match_from(left, seen, warp, plane, guess)
            better = error < best_error
            best[better], best_error[better], best_depth[better] = where[better], error[better], depth[better]
        good = np.isfinite(best_error)
        if cover is not None:
            good &= ~hidden(cover, project(self._right, np.column_stack([best, np.ones(len(best))])))
        self._depth = np.where(good, best_depth, np.nan)
        self._ground = fit_inverse_depth(plane, self._depth)
        return best, good

    def _match_from(
        self, left: Picture, right: Picture, warp: Array | None, plane: Array, guess: Array
    ) -> tuple[Array, Array, Array]:
        """One search from a guessed inverse depth (n,): coordinates, error (infinite if wrong) and depth.

        `right` is the right picture, or what `warp` made of it.
        """
        rays = np.column_stack([plane, np.ones(len(plane))])
        start = project(self._right, self._right_from_left.transform(rays / guess[:, None]))
        start = np.where(np.isfinite(start), start, self._pixel)
        found, tracked, error = self._search(left, right, warp, start, predicted=self._ground is not None)
        where = normalise(self._right, found)
        depth, off = _stereo_depth(self._right_from_left, rays, where)
        good = tracked & self._inside(self._right, found) & (off * self._right.fx < self._config.epipolar_gate)
        good &= (depth > self._config.nearest) & (depth < 100.0)
        return where, np.where(good, error, np.inf), depth

    def _assumed_depth(self, plane: Array) -> Array:
        known = np.isfinite(self._depth)
        if self._ground is not None:
            return np.where(known, self._depth, 1.0 / inverse_depth(self._ground, plane))
        return np.where(known, self._depth, np.median(self._depth[known]) if known.any() else 1.0)

    def _inside(self, camera: PinholeCamera, pixel: Array) -> Mask:
        edge = 2.0
        return np.asarray(
            (pixel[:, 0] > edge)
            & (pixel[:, 1] > edge)
            & (pixel[:, 0] < camera.width - 1 - edge)
            & (pixel[:, 1] < camera.height - 1 - edge)
        )


def _lucas_kanade(
    first: Picture, second: Picture, pixel: Array, guess: Array, window: int, levels: int
) -> tuple[Array, Mask, Array]:
    """Where `pixel` (n, 2) of the first picture went, which were found, and their mean grey error."""
    found, status, error = cv2.calcOpticalFlowPyrLK(
        first,
        second,
        pixel.astype(np.float32).reshape(-1, 1, 2),
        guess.astype(np.float32).reshape(-1, 1, 2),
        winSize=(window, window),
        maxLevel=levels,
        criteria=_STOP,
        flags=cv2.OPTFLOW_USE_INITIAL_FLOW,
        minEigThreshold=1e-3,
    )
    tracked = status.ravel() == 1
    # OpenCV leaves the results of lost points as it found the memory.
    where, grey_error = np.zeros((len(pixel), 2)), np.zeros(len(pixel))
    where[tracked] = found.reshape(-1, 2)[tracked]
    grey_error[tracked] = error.ravel()[tracked]
    return where, tracked, grey_error


def _median_distance(first: Array, second: Array, chosen: Mask) -> float:
    """Of the `chosen` points (n, 2), in px; NaN when there are none."""
    return float(np.median(np.linalg.norm((first - second)[chosen], axis=1))) if chosen.any() else float("nan")


def _stereo_depth(right_from_left: Pose, rays: Array, where: Array) -> tuple[Array, Array]:
    """Depth (n,) in the left eye by least squares, and the distance (n,) of `where` from the epipolar line."""
    turned = rays @ right_from_left.rotation.T
    shift = right_from_left.position
    # x (turned_z d + shift_z) = turned_x d + shift_x, likewise for y, is linear in the depth d.
    a = where * turned[:, 2:] - turned[:, :2]
    b = shift[:2] - where * shift[2]
    depth = (a * b).sum(axis=1) / np.maximum((a * a).sum(axis=1), 1e-12)
    off = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / np.maximum(np.linalg.norm(a, axis=1), 1e-9)
    scale = np.abs(depth * turned[:, 2] + shift[2])
    return depth, off / np.maximum(scale, 1e-6)
