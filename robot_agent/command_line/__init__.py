"""The robot's commands."""
