"""How two Grasshopper3 are set up: one exposes by its own clock and pulls a line, by which the other exposes too.

Names of features are those of that generation (`AcquisitionFrameRateEnabled`, with a d). Line 2 and 3 are the camera's
in- and outputs without isolation: red of the first to green of the second, black to black.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from weaver_shared.config.hardware import GenicamCameras

Value = str | float | bool


@dataclass(frozen=True, slots=True)
class Setting:
    """A feature and its value; a camera without a `needed` one can not be used."""

    feature: str
    value: Value
    needed: bool = False


def settings(config: GenicamCameras, *, primary: bool) -> Iterator[Setting]:
    """In the order in which they are to be written."""
    yield Setting("PixelFormat", "Mono8", True)
    yield Setting("ExposureAuto", "Off")
    yield Setting("GainAuto", "Off")
    yield Setting("ExposureTime", config.exposure * 1e6)
    yield Setting("Gain", config.gain)
    yield Setting("ChunkModeActive", True)
    if primary:
        yield Setting("TriggerMode", "Off", True)
        yield Setting("AcquisitionFrameRateAuto", "Off")
        yield Setting("AcquisitionFrameRateEnabled", True)
        yield Setting("AcquisitionFrameRate", config.rate, True)
        yield Setting("LineSelector", config.exposure_line)
        yield Setting("LineMode", "Output")
        yield Setting("LineSource", "ExposureActive")
    else:
        yield Setting("TriggerSelector", "FrameStart")
        yield Setting("TriggerSource", config.trigger_line, True)
        # The factory's is the falling edge: the end of the other's exposure.
        yield Setting("TriggerActivation", "RisingEdge", True)
        yield Setting("TriggerOverlap", "ReadOut")
        yield Setting("TriggerMode", "On", True)
