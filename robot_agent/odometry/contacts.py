"""Feet on the ground in order, cut at the pictures' instants; a foot counts once it has stood for a moment."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weaver_shared.config.odometry import FeetConfig
from weaver_shared.foot_contacts import FootContacts

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


class ContactStream:
    """Instants wait here until a picture asks for all up to its own; the last one given opens the next stretch."""

    def __init__(self, config: FeetConfig) -> None:
        self._config = config
        self._waiting: FootContacts | None = None
        self._touch_ns: NDArray[np.int64] | None = None  # (legs,) since when each foot stands; -1 in the air

    def add(self, contacts: FootContacts) -> None:
        """Take instants in; what is not finite or not newer than all before it is left out."""
        newest = -(2**62) if self._waiting is None else int(self._waiting.stamp_ns[-1])
        past = np.maximum.accumulate(np.concatenate([[newest], contacts.stamp_ns]))[:-1]
        good = (contacts.stamp_ns > past) & np.isfinite(contacts.foot_in_body).all(axis=(1, 2))
        if not good.any():
            return
        part = _cut(contacts, good)
        part = FootContacts(
            stamp_ns=part.stamp_ns,
            foot_in_body=part.foot_in_body,
            sole_in_body=part.sole_in_body,
            touching=self._settled(part.stamp_ns, part.touching),
        )
        self._waiting = part if self._waiting is None else FootContacts.join([self._waiting, part])

    def take_until(self, stamp_ns: int) -> FootContacts | None:
        """From the instant that ended the last stretch to the newest not after `stamp_ns`; None if there are no two."""
        if self._waiting is None:
            return None
        end = int(np.searchsorted(self._waiting.stamp_ns, stamp_ns, side="right"))
        if end < 2:
            return None
        taken = _cut(self._waiting, np.arange(len(self._waiting.stamp_ns)) < end)
        self._waiting = _cut(self._waiting, np.arange(len(self._waiting.stamp_ns)) >= end - 1)
        return taken

    def _settled(self, stamps: NDArray[np.int64], touching: Mask) -> Mask:
        """Which feet have stood for long enough, (n, legs): a foot just set down still slides."""
        if self._touch_ns is None:
            self._touch_ns = np.full(touching.shape[1], -1, dtype=np.int64)
        settled = np.zeros_like(touching)
        for row, stamp in enumerate(stamps):
            began = touching[row] & (self._touch_ns < 0)
            self._touch_ns = np.where(touching[row], np.where(began, stamp, self._touch_ns), -1)
            settled[row] = touching[row] & ((stamp - self._touch_ns) * 1e-9 >= self._config.settling)
        return settled


def _cut(contacts: FootContacts, rows: Mask) -> FootContacts:
    return FootContacts(
        stamp_ns=contacts.stamp_ns[rows],
        foot_in_body=contacts.foot_in_body[rows],
        sole_in_body=contacts.sole_in_body[rows],
        touching=contacts.touching[rows],
    )
