"""Open country: fractal ground with rocks and trunks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sim_agent.worlds.scene import Box, Heightfield, Plane, World
from weaver_shared.transforms import rotation_from_rpy

Array = NDArray[np.float64]

SIZE = 20.0  # m
CELL = 0.05  # m, coarser cells would hide what a foot feels, finer ones double the cost of a step
BETA = 2.2  # slope of the power spectrum
LOWEST_FREQUENCY = 0.12  # cycles/m; slower waves would be hills rather than rough ground
RELIEF = 0.40  # m between the lowest and the highest point
LEVEL_RADIUS = 0.9  # m around the start where the robot can sit
ROCKS = 90
TRUNKS = 14
CORRIDOR = 1.2  # m either side of the x axis without anything taller than a rock a leg can pass


def outdoor(seed: int) -> World:
    generator = np.random.default_rng([seed, 3])
    x0, y0 = -4.0, -SIZE / 2
    z = _levelled_at_start(_fractal(generator), x0, y0)
    ground = Heightfield(origin=(x0, y0), cell=CELL, z=z, material="earth")
    bare = World(
        name="outdoor",
        seed=seed,
        start=(0.0, 0.0, 0.0),
        bounds=(x0, x0 + SIZE, y0, y0 + SIZE),
        planes=(Plane(height=float(z.min()) - 0.2, material="earth"),),
        heightfields=(ground,),
    )
    boxes = (*_rocks(bare, generator), *_trunks(bare, generator))
    return World(
        name=bare.name,
        seed=seed,
        start=bare.start,
        bounds=bare.bounds,
        planes=bare.planes,
        heightfields=bare.heightfields,
        boxes=boxes,
    )


def _fractal(generator: np.random.Generator) -> Array:
    """Spectral synthesis: white noise shaped to amplitude ~ k^-(beta/2 + 0.5)."""
    n = round(SIZE / CELL)
    spectrum = np.fft.rfft2(generator.standard_normal((n, n)))
    fx, fy = np.fft.fftfreq(n, CELL), np.fft.rfftfreq(n, CELL)
    k = np.hypot(fx[:, None], fy[None, :])
    shape = np.where(k > 0.0, np.maximum(k, LOWEST_FREQUENCY) ** -(BETA / 2 + 0.5), 0.0)
    z = np.pad(np.fft.irfft2(spectrum * shape, s=(n, n)), ((0, 1), (0, 1)), mode="wrap")
    scaled: Array = z * (RELIEF / (z.max() - z.min()))
    return scaled


def _levelled_at_start(z: Array, x0: float, y0: float) -> Array:
    x = x0 + CELL * np.arange(z.shape[0])
    y = y0 + CELL * np.arange(z.shape[1])
    distance = np.hypot(x[:, None], y[None, :])
    at_start = float(z[np.unravel_index(np.argmin(distance), z.shape)])
    blend = np.clip((distance - LEVEL_RADIUS) / LEVEL_RADIUS, 0.0, 1.0)
    levelled: Array = (z - at_start) * (blend * blend * (3.0 - 2.0 * blend))
    return levelled


def _places(world: World, count: int, generator: np.random.Generator, *, off_course: bool) -> Array:
    """Random (count, 2) spots inside the bounds, away from the start and, if asked, from the course along x."""
    xmin, xmax, ymin, ymax = world.bounds
    found: list[tuple[float, float]] = []
    while len(found) < count:
        x, y = float(generator.uniform(xmin + 0.5, xmax - 0.5)), float(generator.uniform(ymin + 0.5, ymax - 0.5))
        if np.hypot(x, y) > 1.8 and not (off_course and abs(y) < CORRIDOR):
            found.append((x, y))
    return np.array(found)


def _rocks(world: World, generator: np.random.Generator) -> tuple[Box, ...]:
    places = _places(world, ROCKS, generator, off_course=False)
    ground = world.elevation(places[:, 0], places[:, 1])
    rocks = []
    for (x, y), z in zip(places, ground, strict=True):
        largest = 0.10 if abs(y) < CORRIDOR else 0.30
        half = generator.uniform(0.04, largest, 3) * np.array([1.0, 1.0, 0.6])
        roll, pitch = generator.uniform(-0.35, 0.35, 2)
        rotation = rotation_from_rpy(roll, pitch, generator.uniform(-np.pi, np.pi))
        rocks.append(Box(centre=np.array([x, y, z]), half=half, rotation=rotation, material="stone"))
    return tuple(rocks)


def _trunks(world: World, generator: np.random.Generator) -> tuple[Box, ...]:
    places = _places(world, TRUNKS, generator, off_course=True)
    ground = world.elevation(places[:, 0], places[:, 1])
    return tuple(
        Box(
            centre=np.array([x, y, z + 0.8]),
            half=np.array([0.12, 0.12, 1.2]),
            rotation=rotation_from_rpy(0.0, 0.0, generator.uniform(-np.pi, np.pi)),
            material="wood",
        )
        for (x, y), z in zip(places, ground, strict=True)
    )
