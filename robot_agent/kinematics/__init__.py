"""Leg kinematics at control rate."""
