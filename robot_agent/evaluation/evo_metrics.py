"""Absolute and relative trajectory errors by the evo library, as other people's results are given."""

from __future__ import annotations

from dataclasses import dataclass

from robot_agent.evaluation.trajectory import Trajectory

SAME_INSTANT = 0.02
"""s between an estimated and a true pose that are compared."""

STRETCH = 1.0
"""m of path over which relative errors are taken."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EvoErrors:
    """None where the recording is too short, or stands, for the figure to have a meaning."""

    ate_rmse: float | None  # m, all positions after the best rigid alignment (Umeyama)
    ate_max: float | None  # m
    rpe_rmse: float | None  # m over 1 m of path
    rpe_rotation_deg: float | None  # likewise


def evo_errors(estimated: Trajectory, truth: Trajectory) -> EvoErrors | None:
    """None when the library is not installed (extra `study`)."""
    try:
        from evo.core import filters, metrics, sync
        from evo.core.geometry import GeometryException
        from evo.core.trajectory import PoseTrajectory3D
    except ImportError:
        return None

    def converted(trajectory: Trajectory) -> PoseTrajectory3D:
        return PoseTrajectory3D(trajectory.position, trajectory.wxyz, trajectory.stamp_ns * 1e-9)

    def relative(relation: metrics.PoseRelation) -> float | None:
        rpe = metrics.RPE(relation, delta=STRETCH, delta_unit=metrics.Unit.meters, all_pairs=True)
        try:
            rpe.process_data((reference, estimate))
        except (metrics.MetricsException, filters.FilterException):
            return None
        return float(rpe.get_statistic(metrics.StatisticsType.rmse))

    try:
        reference, estimate = sync.associate_trajectories(converted(truth), converted(estimated), max_diff=SAME_INSTANT)
    except sync.SyncException:
        return EvoErrors(ate_rmse=None, ate_max=None, rpe_rmse=None, rpe_rotation_deg=None)
    rpe = relative(metrics.PoseRelation.translation_part)
    turn = relative(metrics.PoseRelation.rotation_angle_deg)
    try:
        estimate.align(reference)
    except GeometryException:  # a robot that stands has no directions to align
        return EvoErrors(ate_rmse=None, ate_max=None, rpe_rmse=rpe, rpe_rotation_deg=turn)
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data((reference, estimate))
    return EvoErrors(
        ate_rmse=float(ape.get_statistic(metrics.StatisticsType.rmse)),
        ate_max=float(ape.get_statistic(metrics.StatisticsType.max)),
        rpe_rmse=rpe,
        rpe_rotation_deg=turn,
    )
