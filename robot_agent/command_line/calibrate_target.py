"""`weaver calibrate target`: a page to print in true size, and the file that describes it."""

from __future__ import annotations

import argparse

from robot_agent.calibration.kalibr_files import write_target
from robot_agent.calibration.target import AprilGrid, Checkerboard, Target
from robot_agent.calibration.target_page import fitting_board, fitting_grid, target_pdf
from weaver_shared.errors import InputError


def run(options: argparse.Namespace) -> int:
    target = _target(options)
    page = target_pdf(target, options.page)
    try:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_bytes(page)
        write_target(target, options.out.with_suffix(".yaml"))
    except OSError as error:
        raise InputError(f"{options.out} can not be written: {error.strerror}") from error
    print(f"{options.out}: {target}, on {options.page}")
    print(f"{options.out.with_suffix('.yaml')}: its description")
    print("Print at 100 %, fix it flat, measure the bar: correct the file where the print is not true.")
    return 0


def _target(options: argparse.Namespace) -> Target:
    columns, rows = options.columns, options.rows
    if options.type == "checkerboard":
        if options.size is None:
            return fitting_board(options.page, columns, rows)
        return Checkerboard(columns=columns, rows=rows, column_spacing=options.size, row_spacing=options.size)
    if options.size is None:
        return fitting_grid(options.page, columns, rows, options.spacing)
    return AprilGrid(columns=columns, rows=rows, tag_size=options.size, spacing=options.spacing)
