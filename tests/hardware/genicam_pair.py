"""Two emulated GigE Vision cameras that show a rendered pair, seen through Aravis; prints what was seen as JSON.

A program of its own: whatever happens in the library does not happen to the tests.
"""

from __future__ import annotations

import json
from contextlib import closing
from typing import Any

import numpy as np

from robot_agent.hardware.cameras.aravis import aravis
from robot_agent.hardware.cameras.genicam import GenicamStereo
from sim_agent.body import SimulatedBody
from sim_agent.gige import GigeCamera
from sim_agent.rendering import StereoRenderer
from sim_agent.worlds import make_world
from weaver_shared.clock import MonotonicClock
from weaver_shared.config.hardware import GenicamCameras
from weaver_shared.robots import load_robot

CONFIG = GenicamCameras(kind="genicam", left="127.91.7.1", right="127.91.7.2", rate=10.0)
PAIRS = 12
LATE_NS = 300_000_000
"""Pictures come so long after their exposure: to draw one takes its time."""


def rendered() -> tuple[np.ndarray, np.ndarray]:
    robot, world = load_robot("weaver"), make_world("testbed", 1)
    with closing(SimulatedBody(robot, world, 1)) as body, closing(StereoRenderer(robot, world, 1)) as renderer:
        frame = renderer.render(body.scene_state(), 0)
    return frame.left, frame.right


def told_with_the_picture(camera: GigeCamera, address: str) -> dict[str, Any]:
    """What Aravis reads from the chunks of one picture."""
    client = aravis().Camera.new(address)
    client.set_boolean("ChunkModeActive", True)
    client.set_string("TriggerMode", "Off")
    stream = client.create_stream(None, None)
    stream.push_buffer(aravis().Buffer.new_allocate(client.get_payload()))
    client.start_acquisition()
    camera.tick(camera_clock.now_ns())
    buffer = stream.timeout_pop_buffer(5_000_000)
    parser = client.create_chunk_parser()
    told = {
        "frame": parser.get_integer_value(buffer, "ChunkFrameCounter"),
        "exposure": parser.get_float_value(buffer, "ChunkExposureTime"),
        "stamped": parser.get_integer_value(buffer, "ChunkTimestamp") == buffer.get_timestamp(),
    }
    client.stop_acquisition()
    return told


camera_clock = MonotonicClock()


def main() -> None:
    left, right = rendered()
    size = (left.shape[1], left.shape[0])
    with (
        closing(GigeCamera(CONFIG.left, "LEFT", size, camera_clock.now_ns)) as primary,
        closing(GigeCamera(CONFIG.right, "RIGHT", size, camera_clock.now_ns)) as secondary,
    ):
        primary.wire("Line2", secondary, "Line3")
        primary.see(left)
        secondary.see(right)
        chunks = told_with_the_picture(primary, CONFIG.left)
        with closing(GenicamStereo(CONFIG, camera_clock)) as stereo:
            seen, errors = [], []
            for number in range(PAIRS):
                # From the middle on the network loses packets, which are asked for again.
                primary.lost_packets = secondary.lost_packets = 0.05 if number >= PAIRS // 2 else 0.0
                exposed_ns = camera_clock.now_ns() - LATE_NS
                primary.tick(exposed_ns)
                frame = stereo.read(10.0)
                if frame is not None:
                    seen.append(frame)
                    errors.append(abs(frame.stamp_ns - exposed_ns) * 1e-9)
            told = stereo.health()
            missing = [eye.missing for eye in stereo.eyes]
            # The second one hears no more pulses: its pictures stop.
            primary.cut("Line2")
            trouble = ""
            for _ in range(100):
                primary.tick(camera_clock.now_ns())
                stereo.read(0.1)
                trouble = trouble or stereo.health().trouble
                if trouble:
                    break
    print(
        json.dumps(
            {
                "pairs": told.pairs,
                "lost": told.lost,
                "same": all(np.array_equal(one.left, left) and np.array_equal(one.right, right) for one in seen),
                "stamp_error": max(errors),
                "missing": missing,
                "chunks": chunks,
                "trouble": trouble,
            }
        )
    )


if __name__ == "__main__":
    main()
