"""Figures of a run (ICRA'17 IV, eqs. 12, 13)."""
