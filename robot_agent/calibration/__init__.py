"""Calibration of cameras and IMU: lenses, the eyes' places, and where and how late the IMU is.

Nothing heavy is loaded with the package: the calibrator waits beside a robot for what may never be asked of it.
"""

__all__ = ["warm_up"]


def warm_up() -> None:
    """Compile the kernels ahead."""
    from robot_agent.calibration.warming import warm_up as compile_all

    compile_all()
