"""What the paper reports of its testbed experiment (ICRA'17 IV-C, Tables II and III), to be set beside ours."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class PaperSegment:
    """Reductions in % of the adaptive against the fixed set."""

    cost: float
    roll_variance: float
    pitch_variance: float


SEGMENTS = {
    "A": PaperSegment(cost=65.82, roll_variance=81.41, pitch_variance=87.70),
    "B": PaperSegment(cost=36.93, roll_variance=34.86, pitch_variance=-155.26),
    "C": PaperSegment(cost=12.87, roll_variance=2.4, pitch_variance=-23.00),
    "D": PaperSegment(cost=27.11, roll_variance=-2.28, pitch_variance=22.91),
    "E": PaperSegment(cost=15.76, roll_variance=13.85, pitch_variance=53.91),
    "F": PaperSegment(cost=16.01, roll_variance=3.77, pitch_variance=3.50),
}
COST_ADAPTIVE = (36.43, 1.68)  # mean and standard deviation over 15 walks
COST_FIXED = (51.74, 3.46)
COST_REDUCTION = 29.59  # %
WALKS, REACHED = 30, 30
ODOMETRY_ERROR = 0.36  # m at the course's end, mean of the 30 walks
FASTEST = 0.35  # m/s
LOWEST_COST = 10.0
