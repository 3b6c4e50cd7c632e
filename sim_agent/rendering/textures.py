"""Ground and robot textures: 1/f noise with pebbles, full of corners at every distance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sim_agent.worlds import Material

Array = NDArray[np.float32]
Picture = NDArray[np.uint8]

SIZE = 1024  # texels
TEXEL = 0.0015  # m, what a camera pixel sees at 0.5 m
PERIOD = SIZE * TEXEL
"""Textures repeat after this length (m)."""

ROBOT = Material(name="robot", friction=1.0, brightness=0.24, contrast=0.06, pebble=0.02, tint=(0.75, 0.85, 1.0))


def material_texture(material: Material, generator: np.random.Generator) -> Picture:
    """Grey texture (SIZE, SIZE) that repeats without a seam; half its contrast is 1/f noise, half coarse grain."""
    frequency = np.hypot(np.fft.fftfreq(SIZE)[:, None], np.fft.rfftfreq(SIZE)[None, :]).astype(np.float32)
    spectrum = np.fft.rfft2(generator.standard_normal((SIZE, SIZE), dtype=np.float32))
    cloudy = _normalised(spectrum / np.maximum(frequency, 4.0 / SIZE))
    centre = TEXEL / material.pebble
    grain = _normalised(spectrum[::-1] * np.exp(-(((frequency - centre) / (0.4 * centre)) ** 2)))
    fine = _normalised(spectrum * (frequency > 0.1))
    value = material.brightness + material.contrast * (0.55 * cloudy + 0.75 * np.tanh(1.5 * grain) + 0.25 * fine)
    picture: Picture = np.clip(value * 255.0, 8.0, 247.0).astype(np.uint8)
    return picture


def _normalised(spectrum: NDArray[np.complex64]) -> Array:
    spectrum[0, 0] = 0.0
    field = np.fft.irfft2(spectrum, s=(SIZE, SIZE)).astype(np.float32)
    scaled: Array = field / field.std()
    return scaled
