"""A study's tables, pictures and notes as Markdown and as one HTML page that needs nothing beside it."""

from __future__ import annotations

import base64
import html
from pathlib import Path

from sim_agent.markdown import row
from weaver_shared.errors import InputError

Table = list[tuple[str, ...]]
"""Rows of text, the first one the head."""
Section = tuple[str, Table]
Picture = tuple[Path, str]
"""A PNG file and what it shows."""

STYLE = (
    "body{font:15px/1.5 system-ui,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem}"
    "table{border-collapse:collapse;display:block;overflow-x:auto}"
    "th,td{border:1px solid #bbb;padding:.25rem .6rem;text-align:right}"
    "th:first-child,td:first-child{text-align:left}img{max-width:100%}figure{margin:1.5rem 0}"
)


def write_pages(
    folder: Path,
    title: str,
    sections: list[Section],
    pictures: list[Picture],
    notes: tuple[str, ...],
    about_notes: str = "How to read this",
) -> list[Path]:
    """Write report.md and report.html into `folder`. Raises InputError when that can not be done."""
    markdown, page = folder / "report.md", folder / "report.html"
    try:
        markdown.write_text(_markdown(title, sections, pictures, notes, about_notes), encoding="utf-8")
        page.write_text(_html(title, sections, pictures, notes, about_notes), encoding="utf-8")
    except OSError as error:
        raise InputError(f"the report can not be written to {folder}: {error.strerror}") from error
    return [markdown, page]


def in_columns(table: Table) -> str:
    """The table as lines of text for a terminal."""
    widths = [max(len(row[column]) for row in table) for column in range(len(table[0]))]
    return "\n".join(
        "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in table
    )


def _markdown(
    title: str, sections: list[Section], pictures: list[Picture], notes: tuple[str, ...], about_notes: str
) -> str:
    lines = [f"# {title}", ""]
    for heading, (head, *rows) in sections:
        lines += [f"## {heading}", "", row(head), row(("---",) * len(head)), *map(row, rows), ""]
    for path, caption in pictures:
        lines += [f"![{caption}]({path.name})", "", caption, ""]
    return "\n".join([*lines, f"## {about_notes}", "", *(f"- {note}" for note in notes), ""])


def _html(
    title: str, sections: list[Section], pictures: list[Picture], notes: tuple[str, ...], about_notes: str
) -> str:
    body = [f"<h1>{html.escape(title)}</h1>"]
    for heading, (head, *rows) in sections:
        body.append(f"<h2>{html.escape(heading)}</h2><table><thead>{_cells(head, 'th')}</thead><tbody>")
        body += [_cells(row, "td") for row in rows]
        body.append("</tbody></table>")
    for path, text in pictures:
        data, caption = base64.b64encode(path.read_bytes()).decode(), html.escape(text)
        body.append(
            f'<figure><img alt="{caption}" src="data:image/png;base64,{data}">'
            f"<figcaption>{caption}</figcaption></figure>"
        )
    body.append(
        f"<h2>{html.escape(about_notes)}</h2><ul>"
        + "".join(f"<li>{html.escape(note)}</li>" for note in notes)
        + "</ul>"
    )
    start = f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title>'
    return f"{start}<style>{STYLE}</style></head><body>{''.join(body)}</body></html>\n"


def _cells(cells: tuple[str, ...], tag: str) -> str:
    return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"
