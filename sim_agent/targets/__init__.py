"""Recordings of calibration targets, drawn and moved with all their truth known."""
