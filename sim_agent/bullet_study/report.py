"""The study as Markdown and as one HTML page that needs nothing beside it."""

from __future__ import annotations

import base64
import html
from collections.abc import Sequence
from pathlib import Path

from sim_agent.bullet_study.measure import Measured
from sim_agent.bullet_study.reasons import reasons
from sim_agent.bullet_study.tables import Table, curve_tables, optimum_table, parts_table, power_table, variant_table
from weaver_shared.errors import InputError

TITLE = "Bullet: power and cost of transport"
CAPTIONS = {
    "power": "Mean power in stance and walking in the air, beside the paper's Table IV.",
    "14": "Mammalian, arrangement A, tripod gait, at three stride lengths (the paper's Fig. 14).",
    "15": "Arrangement A: insectoid bipod and tripod, mammalian tripod (Fig. 15).",
    "16": "Arrangement B, tripod gait (Fig. 16); insectoid at 60 % has the mammalian's stride in metres.",
}
STYLE = (
    "body{font:16px/1.5 sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem}table{border-collapse:collapse}"
    "td,th{padding:.2rem .6rem;border-bottom:1px solid #ddd;text-align:right}td:first-child,th:first-child"
    "{text-align:left}img{max-width:100%}"
)


def sections(measured: Sequence[Measured]) -> list[tuple[str, Table]]:
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
    try:
        markdown, page = folder / "report.md", folder / "report.html"
        markdown.write_text(_markdown(measured, pictures), encoding="utf-8")
        page.write_text(_html(measured, pictures), encoding="utf-8")
    except OSError as error:
        raise InputError(f"the report can not be written to {folder}: {error.strerror}") from error
    return [markdown, page]


def _markdown(measured: Sequence[Measured], pictures: dict[str, Path]) -> str:
    lines = [f"# {TITLE}", ""]
    for name, path in pictures.items():
        lines += [f"![{CAPTIONS[name]}]({path.name})", "", CAPTIONS[name], ""]
    lines += ["## Where simulation and paper differ, and why", "", *(f"- {text}" for text in reasons(measured)), ""]
    for title, (head, *rows) in sections(measured):
        lines += [f"## {title}", "", _row(head), _row(("---",) * len(head)), *map(_row, rows), ""]
    return "\n".join(lines)


def _html(measured: Sequence[Measured], pictures: dict[str, Path]) -> str:
    body = [f"<h1>{TITLE}</h1>"]
    for name, path in pictures.items():
        data = base64.b64encode(path.read_bytes()).decode()
        caption = html.escape(CAPTIONS[name])
        body.append(
            f'<figure><img alt="{caption}" src="data:image/png;base64,{data}">'
            f"<figcaption>{caption}</figcaption></figure>"
        )
    body.append("<h2>Where simulation and paper differ, and why</h2><ul>")
    body += [f"<li>{html.escape(text)}</li>" for text in reasons(measured)]
    body.append("</ul>")
    for title, (head, *rows) in sections(measured):
        body.append(f"<h2>{html.escape(title)}</h2><table><thead>{_cells(head, 'th')}</thead><tbody>")
        body += [_cells(row, "td") for row in rows]
        body.append("</tbody></table>")
    before = f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{TITLE}</title>'
    return f"{before}<style>{STYLE}</style></head><body>{''.join(body)}</body></html>\n"


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"


def _cells(cells: Sequence[str], tag: str) -> str:
    return f"<tr>{''.join(f'<{tag}>{html.escape(cell)}</{tag}>' for cell in cells)}</tr>"
