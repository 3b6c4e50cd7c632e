"""What the window remembers of frames it let go: a quadratic in the states, linearised where they first were.

First-estimate Jacobians keep the four directions no measurement can see (position and heading in world) free of
information that inconsistent linearisation would invent.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robot_agent.odometry.window_state import COMMON, STATE, Frames, copy_common, copy_slot, difference, unknowns

Array = NDArray[np.float64]

FIXED_SIGMA = 1e-9
"""s, rad, m: of what is not to be estimated."""


class Prior:
    """Cost 1/2 d^T H d + g^T d of the difference d between the states and their first estimates `origin`."""

    def __init__(self, slots: int) -> None:
        self.origin = Frames.of(slots)
        self.fixed = np.zeros(slots, dtype=np.bool_)  # frames whose origin is held
        self.hessian = np.zeros((unknowns(0), unknowns(0)))
        self.gradient = np.zeros(unknowns(0))
        self.count = 0

    def begin(self, frames: Frames, information: Array, common_sigmas: Array) -> None:
        """Start with one frame of which `information` (15, 15) is known, and the common unknowns' sigmas (COMMON,).

        What has a sigma of 0 never moves.
        """
        self.count = 1
        self.fixed[:] = False
        self.fixed[0] = True
        copy_slot(frames, self.origin, 0)
        copy_common(frames, self.origin)
        self.hessian = np.zeros((unknowns(1), unknowns(1)))
        self.hessian[:STATE, :STATE] = information
        self.hessian[STATE:, STATE:] = np.diag(1.0 / np.maximum(common_sigmas, FIXED_SIGMA) ** 2)
        self.gradient = np.zeros(unknowns(1))

    def append_frame(self) -> None:
        """Make room for one more frame, of which nothing is known yet."""
        self.hessian, self.gradient = _insert(self.hessian, self.gradient, STATE * self.count)
        self.count += 1

    def linearise_at(self, frames: Frames) -> None:
        """Let the origin of frames that are not held follow their estimates."""
        for k in range(self.count):
            if not self.fixed[k]:
                copy_slot(frames, self.origin, k)
        self.origin.rate[:] = frames.rate

    def add_to(self, frames: Frames, hessian: Array, gradient: Array) -> float:
        """Add to a system at `frames`; returns the cost relative to the origin's."""
        d = difference(frames, self.origin, self.count)
        pulled = self.hessian @ d
        hessian += self.hessian
        gradient += self.gradient + pulled
        return float(d @ (0.5 * pulled + self.gradient))

    def replace(self, frames: Frames, hessian: Array, gradient: Array) -> None:
        """Take a system at `frames` over as what is remembered; frames it ties are held from now on."""
        self.linearise_at(frames)
        blocks = np.abs(hessian[:-COMMON]).sum(axis=1).reshape(self.count, STATE).sum(axis=1)
        self.fixed[: self.count] = blocks > 0.0
        self.hessian = hessian
        self.gradient = gradient - hessian @ difference(frames, self.origin, self.count)

    def remove_frame(self, slot: int) -> None:
        """Close the gap of a frame that is no longer in the system (eliminated, or never tied)."""
        begin, end = STATE * slot, STATE * (slot + 1)
        kept = ((slice(0, begin), slice(0, begin)), (slice(end, None), slice(begin, None)))
        self.hessian = _copied(self.hessian, unknowns(self.count - 1), kept)
        self.gradient = np.concatenate([self.gradient[:begin], self.gradient[end:]])
        self.origin.remove(slot)
        self.fixed[slot:-1] = self.fixed[slot + 1 :].copy()
        self.fixed[-1] = False
        self.count -= 1


def eliminate(hessian: Array, gradient: Array, slot: int) -> tuple[Array, Array]:
    """Schur complement that removes a frame's unknowns from a system but leaves their (zero) rows in place."""
    gone = slice(STATE * slot, STATE * (slot + 1))
    block = hessian[gone, gone]
    # Scaling to a unit diagonal first: the unknowns differ by ten orders of magnitude in information.
    scale = 1.0 / np.sqrt(np.maximum(np.diag(block), 1e-12))
    values, vectors = np.linalg.eigh(block * np.outer(scale, scale))
    values = np.where(values > 1e-10, 1.0 / np.maximum(values, 1e-10), 0.0)
    inverse = (vectors * values) @ vectors.T * np.outer(scale, scale)
    coupling = hessian[:, gone]
    kept = hessian - coupling @ inverse @ coupling.T
    reduced = 0.5 * (kept + kept.T)
    remaining = gradient - coupling @ (inverse @ gradient[gone])
    reduced[gone, :] = reduced[:, gone] = 0.0
    remaining[gone] = 0.0
    return reduced, remaining


def _insert(hessian: Array, gradient: Array, at: int) -> tuple[Array, Array]:
    kept = ((slice(0, at), slice(0, at)), (slice(at, None), slice(at + STATE, None)))
    longer = np.concatenate([gradient[:at], np.zeros(STATE), gradient[at:]])
    return _copied(hessian, len(longer), kept), longer


def _copied(source: Array, size: int, kept: tuple[tuple[slice, slice], ...]) -> Array:
    """A square matrix of `size` with the rows and columns `kept` of another at new places, zero elsewhere."""
    target = np.zeros((size, size))
    for rows, new_rows in kept:
        for columns, new_columns in kept:
            target[new_rows, new_columns] = source[rows, columns]
    return target
