"""Worlds are what the paper says, the same for the same seed, and one description for all."""

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim_agent.physics.ground import load_ground
from sim_agent.physics.quiet import quiet
from sim_agent.worlds import WORLD_NAMES, Box, Plane, World, make_world
from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription
from weaver_shared.transforms import rotation_from_rpy

with quiet():
    import pybullet


@pytest.fixture
def client() -> Iterator[int]:
    number = pybullet.connect(pybullet.DIRECT)
    yield number
    pybullet.disconnect(number)


def ray_heights(client: int, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Height where a vertical ray first meets the loaded ground."""
    high, low = np.full(x.size, 5.0), np.full(x.size, -5.0)
    hits = pybullet.rayTestBatch(np.column_stack([x, y, high]), np.column_stack([x, y, low]), physicsClientId=client)
    return np.array([hit[3][2] for hit in hits])


@pytest.mark.parametrize("name", WORLD_NAMES)
def test_physics_stands_where_the_true_elevation_is(name: str, client: int) -> None:
    world = make_world(name, 3)
    with quiet():
        load_ground(world, client)
    xmin, xmax, ymin, ymax = world.bounds
    generator = np.random.default_rng(0)
    x, y = generator.uniform(xmin, xmax, 400), generator.uniform(ymin, ymax, 400)
    difference = np.abs(ray_heights(client, x, y) - world.elevation(x, y))
    # Bullet rounds a box's edges off by its collision margin, so a few rays beside an edge may fall past it.
    assert np.percentile(difference, 98) < 1e-3


@settings(deadline=None, max_examples=30)
@given(st.tuples(*[st.floats(-1.5, 1.5)] * 3), st.tuples(*[st.floats(0.05, 0.4)] * 3))
def test_the_top_of_a_tilted_box_is_where_its_points_are(rpy: tuple, half: tuple) -> None:
    box = Box(centre=np.array([1.0, 2.0, 3.0]), half=np.array(half), rotation=rotation_from_rpy(*rpy), material="stone")
    world = _world_of(box)
    surface = np.random.default_rng(1).uniform(-1.0, 1.0, (500, 3)) * half
    points = surface @ box.rotation.T + box.centre
    assert np.all(world.elevation(points[:, 0], points[:, 1]) >= points[:, 2] - 1e-9)
    highest = (box.rotation @ (np.array(half) * np.sign(box.rotation[2]))) + box.centre
    assert world.elevation(*(box.centre[:2] + 0.999 * (highest - box.centre)[:2])) <= highest[2] + 1e-9


def _world_of(box: Box) -> World:
    plane = Plane(height=-9.0, material="board")
    return World(name="one box", seed=0, start=(0, 0, 0), bounds=(-9, 9, -9, 9), planes=(plane,), boxes=(box,))


@pytest.mark.parametrize(("segment", "ratio"), [("C", 1.13), ("D", 0.28), ("E", 0.11), ("F", 0.72)])
@pytest.mark.parametrize("seed", [0, 1, 7])
def test_rough_segments_differ_in_height_as_the_paper_says(
    robot: RobotDescription, segment: str, ratio: float, seed: int
) -> None:
    heights = _heights(make_world("testbed", seed), segment)
    assert np.ptp(heights) == pytest.approx(ratio * robot.clearance, rel=0.02)


@pytest.mark.parametrize("seed", range(5))
def test_neighbouring_blocks_of_the_roughest_segment_can_be_stepped_over(seed: int) -> None:
    heights = _heights(make_world("testbed", seed), "C")[5::10, 5::10]
    steps = np.concatenate([np.abs(np.diff(heights, axis=axis)).ravel() for axis in (0, 1)])
    assert np.percentile(steps, 90) < 0.07
    assert steps.max() < 0.14


def _heights(world: World, name: str) -> np.ndarray:
    """Heights of a segment every centimetre, (x, y)."""
    segment = next(s for s in world.segments if s.name == name)
    x = np.arange(segment.begin + 0.005, segment.end - 0.004, 0.01)
    y = np.arange(world.bounds[2] + 0.005, world.bounds[3], 0.01)
    return world.elevation(x[:, None], y[None, :])


def test_the_ramp_rises_at_ten_degrees_and_meets_its_neighbours() -> None:
    world = make_world("testbed", 1)
    ramp = next(s for s in world.segments if s.name == "B")
    x = np.linspace(ramp.begin + 0.01, ramp.end - 0.01, 50)
    slope = np.gradient(world.elevation(x, np.zeros(50)), x)
    assert np.rad2deg(np.arctan(slope)) == pytest.approx(np.full(50, 10.0), abs=1e-6)
    assert world.elevation(ramp.begin + 1e-6, 0.0) == pytest.approx(0.0, abs=1e-5)
    assert np.hypot(ramp.end - ramp.begin, 1.2 * np.sin(np.deg2rad(10.0))) == pytest.approx(1.2)


def test_five_metres_from_the_start_lead_through_c() -> None:
    world = make_world("testbed", 1)
    assert world.segment_at(0.0) == "A"
    assert world.segment_at(4.0) == "C"
    assert world.segment_at(5.0) == "D"
    assert world.segment_at(-5.0) is None
    assert [s.name for s in world.segments] == list("ABCDEFG")


def test_no_place_in_any_world_is_without_ground() -> None:
    for name in WORLD_NAMES:
        world = make_world(name, 1)
        assert np.all(np.isfinite(world.elevation(np.linspace(-30, 30, 50)[:, None], np.linspace(-30, 30, 50)[None])))


@pytest.mark.parametrize("name", ["testbed", "outdoor", "stairs"])
def test_a_seed_settles_a_world(name: str) -> None:
    x, y = np.linspace(0.5, 6.0, 300), np.zeros(300)
    one, same, other = (make_world(name, seed).elevation(x, y) for seed in (4, 4, 5))
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)


def test_an_unknown_world_is_answered_with_the_known_ones() -> None:
    with pytest.raises(ConfigurationError, match=r"'moon' is unknown; known are flat, testbed, outdoor, stairs"):
        make_world("moon", 1)
    with pytest.raises(ConfigurationError, match="seed -1"):
        make_world("flat", -1)
