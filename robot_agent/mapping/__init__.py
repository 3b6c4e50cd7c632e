"""The terrain map in the world frame (ICRA'17 III-E)."""
