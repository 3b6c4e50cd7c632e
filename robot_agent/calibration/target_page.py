"""A target as a PDF in true size: black squares as vectors, a bar of 100 mm to check the print with."""

from __future__ import annotations

import numpy as np

from robot_agent.calibration.tags import TAG_CELLS, tag_cells
from robot_agent.calibration.target import AprilGrid, Checkerboard, Target
from weaver_shared.errors import InputError

PAGES = {
    "a4": (0.210, 0.297),
    "a3": (0.297, 0.420),
    "a2": (0.420, 0.594),
    "a1": (0.594, 0.841),
    "a0": (0.841, 1.189),
    "letter": (0.2159, 0.2794),
}
"""Width and height, m."""

MARGIN = 0.010
"""Most printers leave this free, m."""

FOOT = 0.016
"""Room below the target for the scale bar and the caption, m."""

BAR = 0.100

POINTS_PER_METRE = 72.0 / 0.0254

Rectangle = tuple[float, float, float, float]  # left, bottom, width, height, m


def fitting_grid(page: str, columns: int, rows: int, spacing: float) -> AprilGrid:
    """The grid with the largest tags, in whole millimetres, that a page holds."""
    width, height = _size(page, columns > rows)
    room = min(
        (width - 2.0 * MARGIN) / (columns + (columns + 1) * spacing),
        (height - 2.0 * MARGIN - FOOT) / (rows + (rows + 1) * spacing),
    )
    tag_size = np.floor(1e3 * room) * 1e-3
    if tag_size < 0.005:
        raise InputError(f"{columns} x {rows} tags on {page} would be smaller than 5 mm; take a larger page")
    return AprilGrid(columns=columns, rows=rows, tag_size=round(float(tag_size), 3), spacing=spacing)


def fitting_board(page: str, columns: int, rows: int) -> Checkerboard:
    """The chessboard with the largest squares, in whole millimetres, that a page holds; a white rim of one is left."""
    width, height = _size(page, columns > rows)
    room = min((width - 2.0 * MARGIN) / (columns + 1), (height - 2.0 * MARGIN - FOOT) / (rows + 1))
    square = round(float(np.floor(1e3 * room) * 1e-3), 3)
    return Checkerboard(columns=columns, rows=rows, column_spacing=square, row_spacing=square)


def target_pdf(target: Target, page: str) -> bytes:
    """Raises InputError where the target does not fit on the page."""
    border = target.spacing * target.tag_size if isinstance(target, AprilGrid) else target.column_spacing
    width, height = _size(page, target.size[0] > target.size[1])
    needed = target.size[0] + 2.0 * border, target.size[1] + 2.0 * border
    if needed[0] > width - 2.0 * MARGIN + 1e-9 or needed[1] > height - 2.0 * MARGIN - FOOT + 1e-9:
        raise InputError(
            f"the {target} needs {1e3 * needed[0]:.0f} x {1e3 * needed[1]:.0f} mm, {page} leaves "
            f"{1e3 * (width - 2.0 * MARGIN):.0f} x {1e3 * (height - 2.0 * MARGIN - FOOT):.0f} mm"
        )
    left = 0.5 * (width - target.size[0])
    bottom = MARGIN + FOOT + 0.5 * (height - 2.0 * MARGIN - FOOT - target.size[1])
    squares = [(left + x, bottom + y, w, h) for x, y, w, h in ink_of(target)]
    bar = [(MARGIN, MARGIN + 0.006, BAR, 0.0006)]
    bar += [(MARGIN + at - 0.0002, MARGIN + 0.006, 0.0004, 0.003) for at in np.linspace(0.0, BAR, 11)]
    texts = [
        (MARGIN, MARGIN + 0.0105, "100 mm: measure this bar, and the tags, after printing at 100 %"),
        (MARGIN, MARGIN + 0.001, str(target)),
    ]
    return _pdf(width, height, [*squares, *bar], texts)


def ink_of(target: Target) -> list[Rectangle]:
    """What is black, as rectangles in the target's frame, m."""
    return _grid_ink(target) if isinstance(target, AprilGrid) else _board_ink(target)


def _grid_ink(grid: AprilGrid) -> list[Rectangle]:
    gap, cell = grid.spacing * grid.tag_size, grid.tag_size / TAG_CELLS
    ink = [
        (column * grid.pitch - gap, row * grid.pitch - gap, gap, gap)
        for row in range(grid.rows + 1)
        for column in range(grid.columns + 1)
    ]
    for tag in range(grid.tags):
        row, column = divmod(tag, grid.columns)
        # Runs of black cells in one piece: no hairlines between them.
        for j, cells in enumerate(tag_cells(tag) == 0):
            edges = np.flatnonzero(np.diff(np.concatenate([[False], cells, [False]]).astype(np.int8)))
            for begin, end in zip(edges[::2], edges[1::2], strict=True):
                x, y = column * grid.pitch + begin * cell, row * grid.pitch + j * cell
                ink.append((x, y, (end - begin) * cell, cell * 1.001 if j < TAG_CELLS - 1 else cell))
    return ink


def _board_ink(board: Checkerboard) -> list[Rectangle]:
    w, h = board.column_spacing, board.row_spacing
    return [
        (column * w, row * h, w, h)
        for row in range(-1, board.rows)
        for column in range(-1, board.columns)
        if (row + column) % 2 == 0
    ]


def _size(page: str, landscape: bool) -> tuple[float, float]:
    if page not in PAGES:
        raise InputError(f"page {page!r} is unknown; valid are {', '.join(PAGES)}")
    width, height = PAGES[page]
    return (height, width) if landscape else (width, height)


def _pdf(width: float, height: float, ink: list[Rectangle], texts: list[tuple[float, float, str]]) -> bytes:
    """One page by hand: a PDF is a handful of numbered objects and a table of where they begin."""
    k = POINTS_PER_METRE
    drawn = [f"{x * k:.4f} {y * k:.4f} {w * k:.4f} {h * k:.4f} re" for x, y, w, h in ink]
    written = [f"BT /F1 8 Tf {x * k:.2f} {y * k:.2f} Td ({text}) Tj ET" for x, y, text in texts]
    content = "\n".join(["0 g", *drawn, "f", *written]).encode("ascii")
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width * k:.4f} {height * k:.4f}] /Contents 4 0 R "
        "/Resources << /Font << /F1 5 0 R >> >> >>".encode("ascii"),
        b"<< /Length %d >>\nstream\n%s\nendstream" % (len(content), content),
        b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>",
    ]
    document, begins = b"%PDF-1.4\n", []
    for number, body in enumerate(objects, 1):
        begins.append(len(document))
        document += b"%d 0 obj\n%s\nendobj\n" % (number, body)
    table = b"".join(b"%010d 00000 n \n" % begin for begin in begins)
    size = len(objects) + 1
    trailer = b"trailer\n<< /Size %d /Root 1 0 R >>\nstartxref\n%d\n%%%%EOF\n" % (size, len(document))
    return document + b"xref\n0 %d\n0000000000 65535 f \n%s" % (size, table) + trailer
