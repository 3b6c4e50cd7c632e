"""Notices ground that bears the feet elsewhere than it looks, and tells the operator once when that begins or ends."""

from __future__ import annotations

from robot_agent.mapping import Cover
from weaver_shared.messages import Event, Severity

NOTICED = 0.025
"""m; on the simulated testbed footholds agree with the pictures to 2 mm."""
GONE = 0.5
"""Share of it under which the ground counts as bare again."""


class CoverWatch:
    def __init__(self) -> None:
        self._covered = False

    def step(self, cover: Cover, stamp_ns: int) -> Event | None:
        """Judge what the footholds up to `stamp_ns` say; None while nothing changes or too little is known."""
        height = abs(cover.height)
        if not self._covered and height > max(NOTICED, cover.spread):
            self._covered = True
            what = (
                "what is seen is soft, such as grass or sand"
                if cover.height > 0.0
                else "the map lies too low, or the feet stand on what is not seen"
            )
            side = "below" if cover.height > 0.0 else "above"
            text = f"the feet are borne {1000 * height:.0f} mm {side} what is seen: {what}"
            return Event(stamp_ns=stamp_ns, severity=Severity.WARNING, source="vision", text=text)
        if self._covered and height < GONE * NOTICED:
            self._covered = False
            text = "the feet are borne where the ground is seen again"
            return Event(stamp_ns=stamp_ns, severity=Severity.INFO, source="vision", text=text)
        return None
