"""`weaver calibrate check DIR`: whether the cameras are still where and what their file says."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, replace

from robot_agent.calibration.camera_calibration import spread_views
from robot_agent.calibration.checking import check_rig
from robot_agent.calibration.kalibr_files import read_target
from robot_agent.calibration.pictures import open_pictures
from robot_agent.calibration.rig import Rig
from robot_agent.command_line.calibrate_cameras import look_with_progress
from robot_agent.command_line.calibrate_imu import check_sizes
from robot_agent.vision.camchain import read_chain


def run(options: argparse.Namespace) -> int:
    target = read_target(options.target)
    rig = Rig.of(read_chain(options.cameras).cameras[:2])
    check_sizes(rig, open_pictures(options.pictures), str(options.cameras))
    session = look_with_progress(options, target)
    result = check_rig(rig, replace(session, views=spread_views(session.views, options.views)), target)
    if options.json:
        print(json.dumps({**asdict(result), "holds": result.holds}))
        return 0
    for eye, error in enumerate(result.lens_errors):
        print(f"cam{eye}: corners {error:.3f} px off the best plane")
    if result.rows_apart is not None and result.size_ratio is not None:
        print(f"rows of the rectified pair {result.rows_apart:.3f} px apart, mean {result.rows_shift:+.3f} px")
        print(f"the pair measures the target at {100 * result.size_ratio:.2f} % of its size")
        print(f"the eyes seem turned by {result.turned_deg:.3f} degrees against the file")
    print("the calibration holds" if result.holds else "the calibration does not hold: " + "; ".join(result.faults))
    return 0
