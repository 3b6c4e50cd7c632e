"""From terrain to gait parameters (ICRA'17 III-E, eqs. 9-11)."""
