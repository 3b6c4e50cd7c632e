"""The `--plot` form of `weaver gait`: reach, speed limits, foot paths and timing of a gait on one page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robot_agent.kinematics import LegModel
from robot_agent.locomotion.trajectory import TrajectoryTick
from robot_agent.locomotion.walker import Walker
from robot_agent.locomotion.walker_memory import GROUND_HEIGHTS
from robot_agent.locomotion.walkspace import velocity_scale
from robot_agent.locomotion.workspace import workspace
from weaver_shared.errors import InputError, ResourceError
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import RobotDescription
from weaver_shared.robots.gaits import Gait

Array = NDArray[np.float64]

KINDS = (".png", ".svg", ".pdf")
INK, QUIET, WALKED, AIR = "#22303c", "#9aa7b1", "#2a9d8f", "#e76f51"
SHADES = ("#c6d4e1", "#7f9fbd", "#3d648c")
"""Of the workspaces on lower, level and higher ground."""
FAST = 50.0
"""m/s, more than any limit."""


def write(
    target: str, robot: RobotDescription, gait: Gait, ticks: list[TrajectoryTick], parameters: GaitParameters, dt: float
) -> None:
    """Draw to a file. Raises InputError for other kinds of file, ResourceError where it can not be written."""
    if Path(target).suffix not in KINDS:
        raise InputError(f"--plot {target!r} is not valid; the file's name has to end with {', '.join(KINDS)}")
    try:
        import matplotlib
    except ImportError as error:
        raise ResourceError("--plot needs matplotlib, which is part of the extra `study`") from error
    matplotlib.use("Agg")
    from matplotlib import pyplot

    walker = Walker(robot, robot.locomotion, dt)
    figure = pyplot.figure(figsize=(12.0, 10.0), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=(1.35, 1.0))
    figure.suptitle(
        f"{robot.name}: {gait.name} at {parameters.stride_frequency:g} Hz, duty factor {gait.duty:.2f}", fontsize=14
    )
    try:
        _draw_reach(figure.add_subplot(grid[0, 0]), robot, walker)
        _draw_speed(figure.add_subplot(grid[0, 1], projection="polar"), robot, walker, gait, parameters)
        _draw_path(figure.add_subplot(grid[1, 0]), robot, ticks, parameters, dt)
        _draw_timing(figure.add_subplot(grid[1, 1]), robot, gait, parameters)
        figure.savefig(target, dpi=140)
    except OSError as error:
        raise ResourceError(f"{target} can not be written: {error.strerror}") from error
    finally:
        pyplot.close(figure)


def _draw_reach(axes: Any, robot: RobotDescription, walker: Walker) -> None:
    """From above, x forward and up the page."""
    model, stance, radius = LegModel.of_robot(robot), robot.stance_in_body, walker.leg_reach.radius
    heights = model.reach * np.array(GROUND_HEIGHTS)
    reach = workspace(model, stance, heights, model.reach)
    for leg, (x, y, _) in enumerate(stance):
        for layer, height in enumerate(heights):
            edge = _closed(reach[leg, layer])
            label = f"workspace, ground {100 * height:+.0f} cm" if leg == 0 else None
            axes.plot(y + edge[:, 1], x + edge[:, 0], color=SHADES[layer], lw=1.2, label=label)
        edge = _closed(radius[leg])
        axes.fill(y + edge[:, 1], x + edge[:, 0], color=WALKED, alpha=0.35, lw=0, label=None if leg else "walkspace")
        axes.plot(y, x, "+", color=INK, ms=9)
        axes.annotate(robot.leg_names[leg], (y, x), textcoords="offset points", xytext=(5, 5), color=INK)
    hips = np.array([*robot.hips_in_body, robot.hips_in_body[0]])
    axes.fill(hips[:, 1], hips[:, 0], color=QUIET, alpha=0.4, lw=0)
    axes.annotate("", (0.0, 0.12 * model.reach), (0.0, -0.12 * model.reach), arrowprops={"arrowstyle": "->"})
    axes.set(aspect="equal", xlabel="y, to the left (m)", ylabel="x, forward (m)", title="Where the feet can go")
    axes.invert_xaxis()
    axes.grid(alpha=0.25)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=2, fontsize=8, frameon=False)


def _closed(radius: Array) -> Array:
    """Edge (bearings + 1, 2), m, of radii (bearings,) about the origin."""
    angles = 2.0 * np.pi * np.arange(radius.size + 1) / radius.size
    along: Array = np.append(radius, radius[0])[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return along


def _draw_speed(axes: Any, robot: RobotDescription, walker: Walker, gait: Gait, parameters: GaitParameters) -> None:
    """Largest speed in every direction, alone and while turning."""
    config, directions = robot.locomotion, np.radians(np.arange(0.0, 361.0, 1.0))
    largest_turn = _limit(robot, walker, gait, parameters, np.array([0.0, 0.0, FAST])) * FAST
    for share, color in ((0.0, WALKED), (0.5, AIR)):
        turn = share * largest_turn
        speeds = [_speed_beside(robot, walker, gait, parameters, direction, turn) for direction in directions]
        label = "without turning" if share == 0.0 else f"turning {turn:.2f} rad/s"
        axes.plot(directions, np.minimum(speeds, config.largest_speed), color=color, label=label)
        axes.fill(directions, np.minimum(speeds, config.largest_speed), color=color, alpha=0.12)
    axes.plot(directions, np.full_like(directions, config.largest_speed), "--", color=QUIET, label="largest allowed")
    axes.set_theta_zero_location("N")
    axes.set_title("Speed limit by direction (m/s), forward is up", pad=18)
    axes.set_rlabel_position(67.5)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.07), ncol=3, fontsize=8, frameon=False)


def _limit(robot: RobotDescription, walker: Walker, gait: Gait, parameters: GaitParameters, velocity: Array) -> float:
    reach = walker.leg_reach
    return float(
        velocity_scale(
            velocity,
            robot.stance_in_body,
            reach.radius,
            np.zeros(robot.leg_count),
            gait.duty,
            parameters.stride_frequency,
            robot.locomotion.largest_stride,
        )
    )


def _speed_beside(
    robot: RobotDescription, walker: Walker, gait: Gait, parameters: GaitParameters, direction: float, turn: float
) -> float:
    """Largest speed, m/s, in a direction while turning at `turn` rad/s, found by halving."""
    along, low, high = np.array([np.cos(direction), np.sin(direction), 0.0]), 0.0, 2.0 * robot.locomotion.largest_speed
    for _ in range(30):
        middle = 0.5 * (low + high)
        fits = _limit(robot, walker, gait, parameters, middle * along + [0.0, 0.0, turn]) >= 1.0
        low, high = (middle, high) if fits else (low, middle)
    return low


def _draw_path(
    axes: Any, robot: RobotDescription, ticks: list[TrajectoryTick], parameters: GaitParameters, dt: float
) -> None:
    """The first leg's foot over the last stride, from the side."""
    count = min(round(1.0 / (parameters.stride_frequency * dt)) + 2, len(ticks))
    last = [tick.walk for tick in ticks[-count:] if tick.walk is not None]
    feet = np.array([walk.foot_in_body[0] for walk in last]) - robot.stance_in_body[0]
    swing = np.array([walk.swing[0] for walk in last])
    for mask, color, label in ((swing, AIR, "swing"), (~swing, WALKED, "stance")):
        axes.plot(*np.where(mask[:, None], 1000.0 * feet[:, [0, 2]], np.nan).T, ".-", color=color, ms=3, label=label)
    axes.axhline(0.0, color=QUIET, lw=0.8)
    axes.set(xlabel="forward of the stance (mm)", ylabel="above the stance (mm)")
    axes.set_title(f"Foot {robot.leg_names[0]} seen from the body, a point a tick of {1000 * dt:g} ms")
    axes.grid(alpha=0.25)
    axes.legend(fontsize=8, frameon=False)


def _draw_timing(axes: Any, robot: RobotDescription, gait: Gait, parameters: GaitParameters) -> None:
    """Two strides: bars while a foot is in the air."""
    period = 1.0 / parameters.stride_frequency
    for leg, offset in enumerate(gait.offsets):
        axes.barh(leg, 2.0 * period, color=WALKED, alpha=0.35, height=0.7)
        for stride in range(-1, 3):
            begin = (stride - offset) * period
            start, end = max(begin, 0.0), min(begin + gait.swing * period, 2.0 * period)
            if end > start:
                axes.barh(leg, end - start, left=start, color=AIR, height=0.7)
    axes.set_yticks(range(robot.leg_count), robot.leg_names)
    axes.invert_yaxis()
    axes.set(xlim=(0.0, 2.0 * period), xlabel="time (s), two strides", title="Swing (orange) and stance (green)")
