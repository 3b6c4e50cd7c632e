"""Legs in our order, clockwise from the front right, and short names for them and their joints."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from weaver_shared.robots.urdf.branches import Branch

OTHER = re.compile(r"[^A-Za-z0-9]+")


def clockwise(legs: Sequence[Branch]) -> list[Branch]:
    """By where a leg's joints and foot are about the middle of all, seen from above, clockwise from ahead."""
    middles = np.array([np.vstack([leg.points, leg.foot]).mean(axis=0)[:2] for leg in legs])
    x, y = (middles - middles.mean(axis=0)).T
    bearing = np.round(np.arctan2(-y, x) % (2.0 * np.pi), 6)
    return [legs[i] for i in np.lexsort((np.arange(len(legs)), bearing))]


def names(legs: Sequence[Branch]) -> tuple[list[str], list[str]]:
    """Of the legs and of a leg's joints: what the URDF's names share in a leg, and what of them is in every leg."""
    words = [[OTHER.sub("_", joint.name).strip("_").split("_") for joint in leg.joints] for leg in legs]
    for part, first in ((_beginning, True), (_ending, False)):
        shared = [part(leg) for leg in words]
        rests = [
            ["_".join(name[len(own) :] if first else name[: len(name) - len(own)]) for name in leg]
            for leg, own in zip(words, shared, strict=True)
        ]
        leg_names = ["_".join(own) for own in shared]
        alike = all(one == rests[0] for one in rests) and all(rests[0]) and len(set(rests[0])) == len(rests[0])
        if alike and all(leg_names) and len(set(leg_names)) == len(leg_names):
            return leg_names, rests[0]
    return [f"leg{i + 1}" for i in range(len(legs))], [f"joint{i + 1}" for i in range(len(legs[0].joints))]


def _beginning(leg: list[list[str]]) -> list[str]:
    shared: list[str] = []
    for column in zip(*leg, strict=False):
        if len(set(column)) > 1:
            break
        shared.append(column[0])
    return shared


def _ending(leg: list[list[str]]) -> list[str]:
    return _beginning([name[::-1] for name in leg])[::-1]
