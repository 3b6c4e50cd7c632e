"""Finds an AprilGrid's corners: OpenCV decodes tags, the grid tells where the others must be, saddles are refined."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from robot_agent.calibration.sightings import Picture, Sighting
from robot_agent.calibration.tags import BORDER_CELLS, CODE_CELLS, TAG_CELLS, family, tag_cells
from robot_agent.calibration.target import AprilGrid

Array = NDArray[np.float64]

LEAST_TAGS = 4
"""Fewer decoded tags are rather a chance find than a target."""

MOST_WRONG_CELLS = 8
"""Of 100 cells; two tags of the family differ in 11 or more."""

NEIGHBOURS = 4
"""Tags whose common homography predicts another one: few enough that lens distortion does not matter."""

_REFINED = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 40, 1e-3)


class GridDetector:
    def __init__(self, grid: AprilGrid) -> None:
        parameters = cv2.aruco.DetectorParameters()
        parameters.markerBorderBits = BORDER_CELLS
        parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_NONE
        parameters.minMarkerPerimeterRate = 0.06
        self._grid = grid
        # Compared with the grid's own tags only: six times faster than with the whole family, and no chance finds.
        known = cv2.aruco.Dictionary(family().bytesList[: grid.tags], CODE_CELLS, family().maxCorrectionBits)
        self._detector = cv2.aruco.ArucoDetector(known, parameters)
        self._points = grid.points[:, :2]
        self._cells = np.array([tag_cells(tag) for tag in range(grid.tags)])
        self._centres = np.array([self._points[grid.corners_of(tag)].mean(axis=0) for tag in range(grid.tags)])

    def detect(self, picture: Picture) -> Sighting | None:
        """Corners seen, refined; None where fewer than four tags are there."""
        found = self._decoded(picture)
        if len(found) < LEAST_TAGS:
            return None
        self._complete(picture, found)
        corners, pixels = [], []
        for tag in sorted(found):
            refined, sharp = _refine(picture, found[tag])
            corners.append(self._grid.corners_of(tag)[sharp])
            pixels.append(refined[sharp])
        if sum(map(len, corners)) < 4 * LEAST_TAGS:
            return None
        return Sighting(corners=np.concatenate(corners), pixels=np.concatenate(pixels))

    def _decoded(self, picture: Picture) -> dict[int, Array]:
        """Corners (4, 2) of every tag OpenCV reads; a tag seen twice is nobody's."""
        quads, tags, _ = self._detector.detectMarkers(picture)
        found: dict[int, Array] = {}
        twice: set[int] = set()
        for quad, tag in zip(quads, [] if tags is None else tags.ravel().tolist(), strict=True):
            if tag in found:
                twice.add(tag)
            # OpenCV's first corner is the lower right one of Kalibr's print, and it goes on clockwise.
            found[tag] = np.asarray(quad, dtype=np.float64).reshape(4, 2)[[1, 0, 3, 2]]
        for tag in twice:
            del found[tag]
        return self._consistent(found)

    def _consistent(self, found: dict[int, Array]) -> dict[int, Array]:
        """Without the tags that lie on another place of the plane than the grid says, as good as the lens lets tell."""
        if len(found) < LEAST_TAGS:
            return {}
        tags = np.array(sorted(found))
        seen = np.array([found[tag].mean(axis=0) for tag in tags])
        plane, _ = cv2.findHomography(seen, self._centres[tags], cv2.RANSAC, 0.5 * self._grid.pitch)
        if plane is None:
            return {}
        off = np.linalg.norm(_through(plane, seen) - self._centres[tags], axis=1)
        return {int(tag): found[int(tag)] for tag in tags[off < 0.8 * self._grid.pitch]}

    def _complete(self, picture: Picture, found: dict[int, Array]) -> None:
        """Add the tags that were not decoded but are where the grid expects them, spreading from those found."""
        height, width = picture.shape
        missing = set(range(self._grid.tags)) - set(found)
        grown = True
        while grown and missing:
            grown = False
            for tag in sorted(missing):
                quad = self._predict(tag, found)
                if quad is None or (quad < 3.0).any() or (quad > (width - 4.0, height - 4.0)).any():
                    continue
                if self._reads(picture, tag, quad):
                    found[tag] = quad
                    missing.discard(tag)
                    grown = True

    def _predict(self, tag: int, found: dict[int, Array]) -> Array | None:
        """Where the nearest tags expect this one's corners (4, 2); None with too few of them near."""
        tags = np.array(sorted(found))
        if len(tags) < 2:
            return None
        distance = np.linalg.norm(self._centres[tags] - self._centres[tag], axis=1)
        near = tags[np.argsort(distance, kind="stable")[:NEIGHBOURS]]
        if np.sort(distance)[0] > 2.2 * self._grid.pitch:
            return None
        source = np.concatenate([self._points[self._grid.corners_of(other)] for other in near])
        homography, _ = cv2.findHomography(source, np.concatenate([found[other] for other in near]))
        if homography is None:
            return None
        return _through(homography, self._points[self._grid.corners_of(tag)])

    def _reads(self, picture: Picture, tag: int, quad: Array) -> bool:
        """Whether the picture shows this tag's cells inside `quad`."""
        middles = (np.arange(TAG_CELLS) + 0.5) / TAG_CELLS
        grid = np.stack([axis.ravel() for axis in np.meshgrid(middles, middles)], axis=1)
        corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        homography = cv2.getPerspectiveTransform(corners.astype(np.float32), quad.astype(np.float32))
        at = _through(homography, grid).astype(np.float32)
        values = cv2.remap(picture, at[:, 0], at[:, 1], cv2.INTER_LINEAR).ravel().astype(np.float64)
        white = self._cells[tag].ravel() > 0
        bright, dark = values[white].mean(), values[~white].mean()
        if bright - dark < 20.0:
            return False
        return int(np.count_nonzero((values > 0.5 * (bright + dark)) != white)) <= MOST_WRONG_CELLS


def _refine(picture: Picture, quad: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Saddle points (4, 2) next to a tag's corners, and which of them can be trusted."""
    sides = np.linalg.norm(quad - np.roll(quad, 1, axis=0), axis=1)
    # The saddle reaches as far as the tag's black border: two cells of ten.
    reach = int(np.clip(0.17 * sides.min(), 2, 8))
    height, width = picture.shape
    inside = ((quad >= reach + 2) & (quad <= (width - reach - 3, height - reach - 3))).all(axis=1)
    refined = quad.copy()
    if inside.any():
        start = quad[inside].astype(np.float32).reshape(-1, 1, 2)
        moved = cv2.cornerSubPix(picture, start, (reach, reach), (-1, -1), _REFINED).reshape(-1, 2)
        refined[inside] = moved.astype(np.float64)
    near = np.linalg.norm(refined - quad, axis=1) < max(2.0, 0.12 * sides.min())
    return refined, inside & near


def _through(homography: Array, points: Array) -> Array:
    return np.asarray(cv2.perspectiveTransform(points.reshape(-1, 1, 2), homography)).reshape(-1, 2)


def _area(quad: Array) -> float:
    x, y = quad[:, 0], quad[:, 1]
    return float(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
