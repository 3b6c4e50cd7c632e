"""Posing: where the body is carried against where walking alone would carry it (OpenSHC'20 IV-B)."""
