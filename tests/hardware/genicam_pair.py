"""Two emulated GigE Vision cameras that show a rendered pair, seen through Aravis: a program for a network of its own.

Prints what was seen as JSON. The computer needs the addresses 127.0.0.1 and 127.0.0.2.
"""

from __future__ import annotations

import json
from contextlib import closing
from itertools import islice

import numpy as np

from robot_agent.hardware.cameras.genicam import GenicamStereo
from sim_agent.body import SimulatedBody
from sim_agent.rendering import StereoRenderer
from sim_agent.twin.gige_cameras import EmulatedGigeCamera
from sim_agent.worlds import make_world
from weaver_shared.clock import MonotonicClock
from weaver_shared.config.hardware import GenicamCameras
from weaver_shared.robots import load_robot

ADDRESSES = ("127.0.0.1", "127.0.0.2")
PAIRS = 12
# A wire between the two is emulated by the one trigger that Aravis' cameras obey.
CONFIG = GenicamCameras(kind="genicam", left="LEFT", right="RIGHT", rate=10.0, trigger_line="Software")


def rendered() -> tuple[np.ndarray, np.ndarray]:
    robot, world = load_robot("weaver"), make_world("testbed", 1)
    with closing(SimulatedBody(robot, world, 1)) as body, closing(StereoRenderer(robot, world, 1)) as renderer:
        frame = renderer.render(body.scene_state(), 0)
    return frame.left, frame.right


def main() -> None:
    left, right = rendered()
    size = (left.shape[1], left.shape[0])
    clock = MonotonicClock()
    primary = EmulatedGigeCamera(ADDRESSES[0], CONFIG.left, size)
    secondary = EmulatedGigeCamera(ADDRESSES[1], CONFIG.right, size)
    primary.show(left)
    secondary.show(right)
    primary.wire = secondary
    began_ns = clock.now_ns()
    with closing(GenicamStereo(CONFIG, clock)) as stereo:
        seen = (stereo.read(0.5) for _ in range(10 * PAIRS))
        frames = list(islice((frame for frame in seen if frame is not None), PAIRS))
        told = stereo.health()
        # The second one hears no more pulses: its pictures stop.
        primary.wire = None
        trouble = ""
        for _ in range(100):
            stereo.read(0.1)
            trouble = trouble or stereo.health().trouble
            if trouble:
                break
    stamps = np.array([frame.stamp_ns for frame in frames])
    print(
        json.dumps(
            {
                "pairs": told.pairs,
                "lost": told.lost,
                "same": all(np.array_equal(f.left, left) and np.array_equal(f.right, right) for f in frames),
                "stamps_rise": bool((np.diff(stamps) > 0).all()),
                "stamped_within": bool(began_ns < stamps[0] and stamps[-1] < clock.now_ns()),
                "trouble": trouble,
            }
        )
    )


if __name__ == "__main__":
    main()
