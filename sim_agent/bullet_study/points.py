"""The points of the study: which robot walks or stands how, and where its figures go."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from sim_agent.bullet_study import paper

SCENARIOS = {"SA": "stance in air", "WA": "walk in air", "SG": "stance on ground", "WG": "walk on ground"}
SWING = {"tripod": 1.0 / 2.0, "bipod": 2.0 / 3.0}
"""Part of a stride that OpenSHC's gaits swing (2:2 and 2:4); its step frequency is one over the swing time."""
FREQUENCIES = {
    "14": (0.6, 0.8, 1.0, 1.2, 1.4),
    "15": (0.6, 1.0, 1.4, 1.8, 2.2),
    "16": (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5),
}
"""Step frequencies in Hz; the paper's own sets are lost, their ends are in its text."""
QUICK_FREQUENCIES = {"14": (0.6, 1.0, 1.4), "15": (0.6, 1.4, 2.2), "16": (1.0, 2.0, 3.0)}
CURVES: dict[str, tuple[tuple[str, str, float], ...]] = {
    "14": tuple(("bullet_a_mammalian", "tripod", share) for share in (0.6, 0.8, 1.0)),
    "15": (
        ("bullet_a_insectoid", "bipod", 1.0),
        ("bullet_a_insectoid", "tripod", 1.0),
        ("bullet_a_mammalian", "tripod", 1.0),
    ),
    "16": (
        ("bullet_b_mammalian", "tripod", 1.0),
        ("bullet_b_insectoid", "tripod", 0.6027),
        ("bullet_b_insectoid", "tripod", 1.0),
    ),
}
"""Robot, gait and share of the stride length, of every curve of a figure."""
VARIANTS = ("", "no_friction", "heavy_legs", "stiff")
"""What else differs: servos without friction, legs half as heavy again, servos of twice the position gain."""
PROBED = ("bullet_a_mammalian", "bullet_a_insectoid", "bullet_b_mammalian", "bullet_b_insectoid")


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """`frequency` is the paper's step frequency (Hz), `stride` a share of the stride length; both 0 where it stands."""

    robot: str
    gait: str
    scenario: str
    frequency: float = 0.0
    stride: float = 0.0
    variant: str = ""
    seconds: float
    seed: int

    @property
    def walks(self) -> bool:
        return self.scenario in ("WA", "WG")

    @property
    def key(self) -> str:
        """The same for the same point of another run."""
        return "/".join(f"{value:g}" if isinstance(value, float) else str(value) for value in asdict(self).values())

    def as_dict(self) -> dict[str, Any]:
        return asdict(self)


def points_of(seconds: float, seed: int, *, quick: bool) -> list[Point]:
    """All points of the study, every one once."""
    found: list[Point] = []

    def add(
        robot: str, gait: str, scenario: str, frequency: float = 0.0, stride: float = 0.0, variant: str = ""
    ) -> None:
        found.append(
            Point(
                robot=robot,
                gait=gait,
                scenario=scenario,
                frequency=frequency,
                stride=stride,
                variant=variant,
                seconds=seconds,
                seed=seed,
            )
        )

    for robot, gait in paper.TABLE_4:
        add(robot, gait, "WA", paper.TABLE_4_FREQUENCY, 1.0)
        add(robot, "tripod", "SA")
        add(robot, "tripod", "SG")
    for figure, curves in CURVES.items():
        for robot, gait, share in curves:
            for frequency in (QUICK_FREQUENCIES if quick else FREQUENCIES)[figure]:
                add(robot, gait, "WG", frequency, share)
    for robot in () if quick else PROBED:
        for variant in VARIANTS[1:]:
            add(robot, "tripod", "SG", variant=variant)
            add(robot, "tripod", "WA", paper.TABLE_4_FREQUENCY, 1.0, variant)
    return list(dict.fromkeys(found))
