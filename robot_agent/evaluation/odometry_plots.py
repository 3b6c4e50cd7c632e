"""Pictures of an odometry run: the path from above, and what it was off by over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from robot_agent.evaluation.trajectory import Trajectory, errors_over_time
from weaver_shared.errors import InputError
from weaver_shared.messages import OdometryEstimate


def draw(folder: Path, estimates: list[OdometryEstimate], trajectory: Trajectory, truth: Trajectory | None) -> None:
    """Write path.png and, with ground truth, errors.png. Raises InputError where that can not be done."""
    try:
        import matplotlib as mpl

        mpl.use("Agg")
        from matplotlib import pyplot as plt
    except ImportError as error:
        raise InputError("plots need matplotlib: install the extra `study`") from error
    compared = errors_over_time(trajectory, truth) if truth is not None else None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        figure, axes = plt.subplots(figsize=(7, 6), layout="constrained")
        if compared is None:
            axes.plot(trajectory.position[:, 0], trajectory.position[:, 1], label="estimated")
        else:
            axes.plot(compared.truth[:, 0], compared.truth[:, 1], "k--", label="true")
            axes.plot(compared.aligned[:, 0], compared.aligned[:, 1], label="estimated")
        axes.set(xlabel="x (m)", ylabel="y (m)", aspect="equal", title="Path from above")
        axes.legend()
        figure.savefig(folder / "path.png", dpi=120)
        plt.close(figure)
        if compared is None:
            return
        figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
        seconds = (compared.stamp_ns - compared.stamp_ns[0]) * 1e-9
        for axis, name in enumerate("xyz"):
            axes.plot(seconds, 1e3 * (compared.aligned - compared.truth)[:, axis], label=name)
        sigma = {e.stamp_ns: np.sqrt(np.trace(e.covariance[3:, 3:])) for e in estimates}
        band = 3e3 * np.array([sigma[int(stamp)] for stamp in compared.stamp_ns])
        axes.fill_between(seconds, -band, band, alpha=0.15, label="3 sigma as estimated")
        reach = 1.5e3 * float(np.abs(compared.aligned - compared.truth).max())
        axes.set(xlabel="time (s)", ylabel="error (mm)", title="Error of the position", ylim=(-reach, reach))
        axes.legend()
        figure.savefig(folder / "errors.png", dpi=120)
        plt.close(figure)
    except OSError as error:
        raise InputError(f"plots can not be written to {folder}: {error}") from error
