"""From waypoints to body velocity (ICRA'17 III-B, eqs. 1-5)."""
