"""The study's tables and pictures in order, with what they show."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from sim_agent.bullet_study.measure import Measured
from sim_agent.bullet_study.reasons import reasons
from sim_agent.bullet_study.tables import curve_tables, optimum_table, parts_table, power_table, variant_table
from sim_agent.report_pages import Section, write_pages

TITLE = "Bullet: power and cost of transport"
CAPTIONS = {
    "power": "Mean power in stance and walking in the air, beside the paper's Table IV.",
    "14": "Mammalian, arrangement A, tripod gait, at three stride lengths (the paper's Fig. 14).",
    "15": "Arrangement A: insectoid bipod and tripod, mammalian tripod (Fig. 15).",
    "16": "Arrangement B, tripod gait (Fig. 16); insectoid at 60 % has the mammalian's stride in metres.",
}
WHY = "Where simulation and paper differ, and why"


def sections(measured: Sequence[Measured]) -> list[Section]:
    """Headings and tables of the report."""
    found = [
        ("Power in the four scenarios, W (Table IV)", power_table(measured)),
        ("Least costs", optimum_table(measured)),
        ("Where the power goes, W", parts_table(measured)),
        ("What the model's parts do", variant_table(measured)),
        *((f"Figure {figure}", table) for figure, table in curve_tables(measured).items()),
    ]
    return [(title, table) for title, table in found if len(table) > 1]


def write_report(folder: Path, measured: Sequence[Measured], pictures: dict[str, Path]) -> list[Path]:
    """Write report.md and report.html into `folder`. Raises InputError when that can not be done."""
    captioned = [(path, CAPTIONS[name]) for name, path in pictures.items()]
    return write_pages(folder, TITLE, sections(measured), captioned, tuple(reasons(measured)), about_notes=WHY)
