"""What OpenSHC'20 gives in numbers: Table IV, and what its text says of Figs. 14 to 16, whose curves are pictures."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Power:
    """Mean power (W) at the supply: standing and walking in the air, standing on the ground."""

    stance_air: float
    walk_air: float
    stance_ground: float


TABLE_4: dict[tuple[str, str], Power] = {
    ("bullet_a_mammalian", "tripod"): Power(stance_air=27.7, walk_air=51.0, stance_ground=48.6),
    ("bullet_b_mammalian", "tripod"): Power(stance_air=30.4, walk_air=47.1, stance_ground=46.7),
    ("bullet_a_insectoid", "tripod"): Power(stance_air=30.4, walk_air=61.9, stance_ground=58.3),
    ("bullet_a_insectoid", "bipod"): Power(stance_air=30.4, walk_air=72.3, stance_ground=58.3),
    ("bullet_b_insectoid", "tripod"): Power(stance_air=31.1, walk_air=62.9, stance_ground=56.0),
}
"""Walking in the air is at a step frequency of 1 Hz and 100 % of the stride length."""

TABLE_4_FREQUENCY = 1.0  # Hz

BODY_HEIGHT = {"a_mammalian": 0.30, "b_mammalian": 0.30, "a_insectoid": 0.20, "b_insectoid": 0.25}  # m, Table III
STRIDE_HEIGHT = {"a_mammalian": 0.12, "b_mammalian": 0.08, "a_insectoid": 0.15, "b_insectoid": 0.10}  # m, Table III
STRIDE_LENGTH = {"a_mammalian": 0.207, "b_mammalian": 0.210, "a_insectoid": 0.287, "b_insectoid": 0.348}  # m, Table II

OPTIMUM = {
    "14": "least at 1 Hz and 100 % stride; rises greatly above 1 Hz; at 1.4 Hz feet slip, slower than at 1.2 Hz",
    "15": "insectoid tripod least at 1.8 Hz; bipod falls on to 2.2 Hz and is nowhere above tripod; bipod 30 % faster",
    "16": "least at 3 Hz in both postures; mammalian below insectoid of the same stride from 2 Hz on, but slower; "
    "insectoid 100 % at its joint limits from 2 Hz, mammalian from 3.5 Hz",
}
"""What the text says of each figure."""
BIPOD_FASTER = 1.30
