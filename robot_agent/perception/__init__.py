"""From a stereo pair to the shape of the ground ahead (ICRA'17 III-D)."""
