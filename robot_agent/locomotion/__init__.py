"""From body velocity to joint targets (ICRA'17 III-C, OpenSHC)."""
