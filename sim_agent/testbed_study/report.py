"""The study as Markdown and as one HTML page that needs nothing beside it."""

from __future__ import annotations

import base64
import html
import math
from pathlib import Path

from sim_agent.testbed_study import paper
from sim_agent.testbed_study.figures import KindFigures, StudyFigures
from weaver_shared.config.adaptation import AdaptationConfig
from weaver_shared.errors import InputError

Table = list[tuple[str, ...]]

CAPTIONS = {
    "9": "Odometry error along the course (the paper's Fig. 9, lower plot).",
    "10": "Cost of transport and gait parameters along the course (Fig. 10). Grey: one standard deviation, adaptive.",
    "11": "Sway: mean and one standard deviation of roll and pitch in the phase plane (Fig. 11).",
}
NOTES = (
    "The robot, its servos, its cameras and the course are simulated; pictures are rendered and everything the robot "
    "knows it estimates from them. Adaptive and fixed walks of a seed begin alike and differ in nothing but the "
    "adaptation.",
    "Cost of transport counts the whole supply with the computers, as the paper does; the motors alone are given "
    "beside it. The simulated robot walks faster than the paper's, so the fixed load of the computers weighs less and "
    "all costs are lower.",
    "Variances are of the true roll and pitch about each walk's own mean on the segment.",
)


def write_report(folder: Path, figures: StudyFigures, pictures: dict[str, Path]) -> list[Path]:
    """Write report.md and report.html into `folder`. Raises InputError when that can not be done."""
    sections = [
        ("Over the whole course", overall_table(figures)),
        ("By segment (the paper's Table III)", segment_table(figures)),
        ("Gait parameters (Table II)", parameter_table(AdaptationConfig())),
    ]
    try:
        markdown, page = folder / "report.md", folder / "report.html"
        markdown.write_text(_markdown(sections, pictures))
        page.write_text(_html(sections, pictures))
    except OSError as error:
        raise InputError(f"the report can not be written to {folder}: {error.strerror}") from error
    return [markdown, page]


def overall_table(figures: StudyFigures) -> Table:
    """Rows of text, the first one the head."""
    adaptive, fixed = figures.kinds["adaptive"], figures.kinds["fixed"]
    return [
        ("", "adaptive", "fixed", "paper adaptive", "paper fixed"),
        ("walks that reached the end", _share(adaptive), _share(fixed), "15 of 15", "15 of 15"),
        (
            "cost of transport, total",
            _pm(adaptive.cost_total),
            _pm(fixed.cost_total),
            _pm(paper.COST_ADAPTIVE),
            _pm(paper.COST_FIXED),
        ),
        ("cost of transport, motors", _pm(adaptive.cost_motors), _pm(fixed.cost_motors), "", ""),
        (
            "reduction of the total, %",
            _number(figures.cost_reduction, 1),
            "",
            _number(paper.COST_REDUCTION, 1),
            "",
        ),
        ("reduction of the motors', %", _number(figures.motor_cost_reduction, 1), "", "", ""),
        ("mean speed, m/s", _pm(adaptive.speed, 3), _pm(fixed.speed, 3), "", ""),
        ("duration, s", _pm(adaptive.duration, 1), _pm(fixed.duration, 1), "", ""),
        ("odometry drift, % of the way", _pm(adaptive.drift_percent, 3), _pm(fixed.drift_percent, 3), "", ""),
    ]


def segment_table(figures: StudyFigures) -> Table:
    rows: Table = [
        (
            "segment",
            "cost adaptive",
            "cost fixed",
            "cost reduction %",
            "paper",
            "roll variance reduction %",
            "paper",
            "pitch variance reduction %",
            "paper",
            "speed adaptive / fixed, m/s",
        )
    ]
    for name, segment in figures.segments.items():
        theirs = paper.SEGMENTS.get(name)
        rows.append(
            (
                name,
                _number(segment.cost_total[0], 2),
                _number(segment.cost_total[1], 2),
                _number(segment.cost_reduction, 1),
                _number(theirs.cost, 1) if theirs else "",
                _number(segment.roll_reduction, 1),
                _number(theirs.roll_variance, 1) if theirs else "",
                _number(segment.pitch_reduction, 1),
                _number(theirs.pitch_variance, 1) if theirs else "",
                " / ".join(_number(value, 3) for value in segment.speed),
            )
        )
    return rows


def parameter_table(config: AdaptationConfig) -> Table:
    """Ranges of the adaptive set and the fixed values; the paper's own are lost."""
    names = {
        "virtual_stiffness": ("virtual stiffness, N/m", config.virtual_stiffness.lower),
        "stride_frequency": ("stride frequency, Hz", config.stride_frequency.lower),
        "stride_height": ("stride height, m", config.stride_height.upper),
    }
    rows: Table = [("", "adaptive, from", "to", "fixed")]
    for name, (label, rough) in names.items():
        bounds = getattr(config, name)
        rows.append((label, f"{bounds.lower:g}", f"{bounds.upper:g}", f"{rough:g}"))
    return rows


def _markdown(sections: list[tuple[str, Table]], pictures: dict[str, Path]) -> str:
    lines = ["# Testbed: adaptive against fixed gait parameters", ""]
    for title, (head, *rows) in sections:
        lines += [f"## {title}", "", _row(head), _row(("---",) * len(head)), *map(_row, rows), ""]
    for number, path in pictures.items():
        lines += [f"![{CAPTIONS[number]}]({path.name})", "", CAPTIONS[number], ""]
    lines += ["## How to read this", "", *(f"- {note}" for note in NOTES), ""]
    return "\n".join(lines)


def _html(sections: list[tuple[str, Table]], pictures: dict[str, Path]) -> str:
    body = ["<h1>Testbed: adaptive against fixed gait parameters</h1>"]
    for title, (head, *rows) in sections:
        body.append(f"<h2>{html.escape(title)}</h2><table><thead>{_cells(head, 'th')}</thead><tbody>")
        body += [_cells(row, "td") for row in rows]
        body.append("</tbody></table>")
    for number, path in pictures.items():
        picture = base64.b64encode(path.read_bytes()).decode()
        caption = html.escape(CAPTIONS[number])
        body.append(
            f'<figure><img alt="{caption}" src="data:image/png;base64,{picture}">'
            f"<figcaption>{caption}</figcaption></figure>"
        )
    body.append("<h2>How to read this</h2><ul>" + "".join(f"<li>{html.escape(note)}</li>" for note in NOTES) + "</ul>")
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Testbed study</title><style>'
        "body{font:15px/1.5 system-ui,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem}"
        "table{border-collapse:collapse;display:block;overflow-x:auto}"
        "th,td{border:1px solid #bbb;padding:.25rem .6rem;text-align:right}"
        "th:first-child,td:first-child{text-align:left}img{max-width:100%}figure{margin:1.5rem 0}"
        "</style></head><body>" + "".join(body) + "</body></html>\n"
    )


def _row(cells: tuple[str, ...]) -> str:
    return "| " + " | ".join(cells) + " |"


def _cells(cells: tuple[str, ...], tag: str) -> str:
    return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"


def _share(figures: KindFigures) -> str:
    return f"{figures.reached} of {figures.walks}"


def _pm(value: tuple[float, float], digits: int = 2) -> str:
    return f"{_number(value[0], digits)} ± {_number(value[1], digits)}" if math.isfinite(value[0]) else "–"


def _number(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"
