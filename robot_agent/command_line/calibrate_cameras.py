"""`weaver calibrate cameras DIR`: lenses and the eyes' places, guided by what the pictures still lack."""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import replace
from typing import Any

import numpy as np
from tqdm import tqdm

from robot_agent.calibration.camera_calibration import LEAST_VIEWS, calibrate_cameras, spread_views
from robot_agent.calibration.guidance import Wish, wishes
from robot_agent.calibration.kalibr_files import read_target, write_camchain
from robot_agent.calibration.looking import look
from robot_agent.calibration.pictures import open_pictures
from robot_agent.calibration.report import camera_sections, write_report
from robot_agent.calibration.rig_batch import RigEstimate
from robot_agent.calibration.robot_camera import camera_table
from robot_agent.calibration.sightings import Session
from robot_agent.calibration.target import Target
from robot_agent.calibration.verdicts import Verdict, judge_cameras
from weaver_shared.errors import InputError

WATCH_PAUSE = 1.0
"""Between looks into a watched folder, s."""


def run(options: argparse.Namespace) -> int:
    target = read_target(options.target)
    if options.views < LEAST_VIEWS:
        raise InputError(f"--views {options.views} is too few; at least {LEAST_VIEWS} are needed")
    session, estimate, wished = (_watch if options.watch else _calibrate)(options, target)
    verdict = judge_cameras(estimate, wished)
    folder = output_folder(options)
    write_camchain(estimate.rig, folder / "camchain.yaml")
    if estimate.rig.eyes > 1:
        (folder / "camera.toml").write_text(camera_table(estimate.rig), encoding="utf-8")
    write_report("Calibration of the cameras", verdict, camera_sections(estimate, session, wished), folder)
    if options.json:
        print(json.dumps(as_json(estimate, session, verdict)))
        return 0
    print_cameras(estimate)
    print_wishes(wished)
    print(f"{verdict}\nwritten: {folder / 'camchain.yaml'}, report.html and report.md beside it")
    return 0


def look_with_progress(options: argparse.Namespace, target: Target) -> Session:
    source = open_pictures(options.pictures)
    with tqdm(total=len(source), unit=" views", desc="looking", file=sys.stderr, disable=options.quiet) as bar:
        return look(source, target, bar.update)


def output_folder(options: argparse.Namespace) -> Any:
    try:
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{options.out} can not be made a folder: {error.strerror}") from error
    return options.out


def print_wishes(wished: list[Wish]) -> None:
    for wish in wished:
        print(f"  [{'x' if wish.met else ' '}] {wish.what}" + ("" if wish.met else f": {wish.advice}"))


def print_cameras(estimate: RigEstimate) -> None:
    rig = estimate.rig
    for eye in range(rig.eyes):
        rows = estimate.table.eye == eye
        fx, fy, cx, cy = rig.intrinsics[eye, :4]
        sigma = estimate.intrinsics_sigma[eye]
        rms = float(np.sqrt((estimate.residuals[rows] ** 2).sum(axis=1).mean()))
        print(
            f"cam{eye}: focal lengths {fx:.2f} and {fy:.2f} px (± {sigma[:2].max():.2f}), centre {cx:.2f}, {cy:.2f} px "
            f"(± {sigma[2:4].max():.2f}), reprojection error {rms:.3f} px"
        )
    if rig.eyes > 1:
        print(f"baseline {1e3 * rig.baseline:.3f} mm")


def as_json(estimate: RigEstimate, session: Session, verdict: Verdict) -> dict[str, Any]:
    """Intrinsics as in camchain.yaml; pixels, m, and standard deviations beside them."""
    rig = estimate.rig
    cameras = []
    for eye, model in enumerate(rig.models):
        rows = estimate.table.eye == eye
        cameras.append(
            {
                "model": model,
                "intrinsics": rig.intrinsics[eye, :4].tolist(),
                "distortion": rig.intrinsics[eye, 4:].tolist(),
                "sigma": estimate.intrinsics_sigma[eye].tolist(),
                "reprojection_px": float(np.sqrt((estimate.residuals[rows] ** 2).sum(axis=1).mean())),
                "corners": int(rows.sum()),
            }
        )
    return {
        "views": len(estimate.first_from_target),
        "pictures": session.pictures,
        "reprojection_px": estimate.rms,
        "corner_sigma_px": estimate.sigma,
        "left_out": int((~estimate.used).sum()),
        "cameras": cameras,
        "baseline_m": rig.baseline if rig.eyes > 1 else None,
        "right_from_left": rig.eye_from_first[1].matrix.tolist() if rig.eyes > 1 else None,
        "usable": verdict.usable,
        "faults": list(verdict.faults),
        "doubts": list(verdict.doubts),
    }


def _calibrate(options: argparse.Namespace, target: Target) -> tuple[Session, RigEstimate, list[Wish]]:
    session = look_with_progress(options, target)
    session = replace(session, views=spread_views(session.views, options.views))
    estimate = calibrate_cameras(session, target, options.model)
    return session, estimate, wishes(session, estimate.first_from_target)


def _watch(options: argparse.Namespace, target: Target) -> tuple[Session, RigEstimate, list[Wish]]:
    """Calibrate anew whenever pictures were added, and say what is missing, until nothing is or time is up."""
    until = time.monotonic() + options.watch
    known = -1
    while True:
        try:
            count = len(open_pictures(options.pictures))
            if count != known:
                known = count
                result = _calibrate(options, target)
                print(f"{count} pictures:", file=sys.stderr)
                for wish in result[2]:
                    print(f"  [{'x' if wish.met else ' '}] {wish.what if wish.met else wish.advice}", file=sys.stderr)
                if all(wish.met for wish in result[2]) or time.monotonic() > until:
                    return result
        except InputError as error:
            if time.monotonic() > until:
                raise
            print(f"waiting: {error}", file=sys.stderr)
        if time.monotonic() > until:
            return _calibrate(options, target)
        time.sleep(WATCH_PAUSE)
