"""A straight way is refused for a high step or a steep slope that the map knows, and only for those."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from robot_agent.ground_memory import GroundMemory
from robot_agent.way_survey import Survey, WaySurvey
from sim_agent.worlds import make_world
from weaver_shared.messages import MapTile, Waypoint
from weaver_shared.robots import load_robot

CELL, SIZE = 0.02, 32
Array = NDArray[np.float64]
Heights = Callable[[Array, Array], Array]


def remembered(heights: Heights, x: tuple[float, float], y: tuple[float, float] = (-1.0, 1.0)) -> GroundMemory:
    """The memory of a map that knows these true heights (m) over an area of the world, and NaN for unknown."""
    ground, edge = GroundMemory(), CELL * SIZE
    for i in range(int(np.floor(x[0] / edge)), int(np.ceil(x[1] / edge))):
        for j in range(int(np.floor(y[0] / edge)), int(np.ceil(y[1] / edge))):
            place = (np.arange(SIZE) + 0.5) * CELL
            z = heights(*np.meshgrid(i * edge + place, j * edge + place, indexing="ij"))
            known = np.isfinite(z)
            none = np.full((SIZE, SIZE), 255, dtype=np.uint8)
            ground.put(
                MapTile(
                    stamp_ns=0,
                    i=i,
                    j=j,
                    size=SIZE,
                    cell=CELL,
                    elevation_mm=np.where(known, np.rint(1000 * z), -32768).astype(np.int16),
                    sigma_mm=np.where(known, 3, 255).astype(np.uint8),
                    roughness=none,
                    step_height=none,
                    age_s=none,
                )
            )
    return ground


def surveyed(ground: GroundMemory, *places: tuple[float, float], begin: tuple[float, float] = (0.0, 0.0)) -> Survey:
    return WaySurvey(load_robot(), ground).survey(begin, [Waypoint(x=x, y=y) for x, y in places], 1)


def test_level_ground_has_nothing_to_remark() -> None:
    survey = surveyed(remembered(lambda x, _: 0.0 * x, (-1.0, 4.0)), (2.0, 0.0), (3.0, 0.5))
    assert survey.refusal == ""
    assert survey.remark == ""
    assert survey.length == pytest.approx(2.0 + np.hypot(1.0, 0.5))


def test_unknown_ground_is_allowed_and_said() -> None:
    nothing = surveyed(GroundMemory(), (3.0, 0.0))
    assert nothing.refusal == ""
    assert "of the 3.0 m of way lead over ground that the map does not know" in nothing.remark
    half = surveyed(remembered(lambda x, _: np.where(x < 2.0, 0.0, np.nan), (-1.0, 4.0)), (4.0, 0.0))
    assert half.unknown == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize("height", [0.3, -0.3])
def test_a_high_step_is_refused_with_leg_place_and_height(height: float) -> None:
    ground = remembered(lambda x, _: np.where(x < 2.5, 0.0, height), (-1.0, 4.0))
    survey = surveyed(ground, (1.5, 0.0), (3.5, 0.0))
    assert survey.refusal.startswith("the way to waypoint 2 leads over a step of 0.30 m at x 2.")
    assert "the highest that the robot is sent over is 0.20 m" in survey.refusal
    assert surveyed(ground, (2.0, 0.0)).refusal == ""


def test_the_feet_need_more_than_the_line() -> None:
    def wall(_: Array, y: Array) -> Array:
        return np.where(y > 0.25, 0.4, 0.0)

    assert "a step" in surveyed(remembered(wall, (-1.0, 4.0)), (3.0, 0.0)).refusal
    assert surveyed(remembered(wall, (-1.0, 4.0)), (3.0, -0.8), begin=(0.0, -0.8)).refusal == ""


def test_a_robot_beside_an_edge_may_leave_it() -> None:
    ground = remembered(lambda x, _: np.where(x < -0.2, 0.4, 0.0), (-1.0, 4.0))
    assert surveyed(ground, (2.0, 0.0)).refusal == ""


@pytest.mark.parametrize(("angle", "refused"), [(30.0, False), (40.0, True)])
def test_a_slope_is_refused_where_the_robot_would_hold(angle: float, refused: bool) -> None:
    ground = remembered(lambda x, _: np.tan(np.radians(angle)) * np.maximum(x - 1.0, 0.0), (-1.0, 4.0))
    survey = surveyed(ground, (3.0, 0.0))
    assert bool(survey.refusal) == refused
    if refused:
        assert "40 degrees steep" in survey.refusal
        assert "is 35 degrees" in survey.refusal


def test_the_map_is_read_on_both_sides_of_the_origin() -> None:
    ground = remembered(lambda x, y: 0.1 * x + 0.01 * y, (-3.0, 3.0))
    x, y = np.array([-2.5, -0.3, 0.3, 2.5]), np.array([-0.7, 0.7, -0.7, 0.7])
    np.testing.assert_allclose(ground.heights(x, y), 0.1 * x + 0.01 * y, atol=0.003)
    assert np.isnan(ground.heights(np.array([50.0]), np.array([0.0]))).all()


def test_single_wrong_cells_refuse_nothing() -> None:
    def speckled(x: Array, y: Array) -> Array:
        return np.where((np.abs(x - 2.0) < 0.015) & (np.abs(y) < 0.015), 0.5, 0.0)

    assert surveyed(remembered(speckled, (-1.0, 4.0)), (3.0, 0.0)).refusal == ""


@pytest.mark.parametrize(("world", "length"), [("testbed", 12.0), ("outdoor", 8.0), ("stairs", 5.0), ("flat", 5.0)])
def test_worlds_made_for_walking_are_not_refused(world: str, length: float) -> None:
    true = make_world(world, seed=1).elevation
    assert surveyed(remembered(true, (-1.0, length + 1.0)), (length, 0.0)).refusal == ""


def test_a_post_is_refused() -> None:
    def post(x: Array, y: Array) -> Array:
        return np.where((np.abs(x - 2.0) < 0.05) & (np.abs(y) < 0.05), 0.5, 0.0)

    assert "a step of 0.50 m" in surveyed(remembered(post, (-1.0, 4.0)), (3.0, 0.0)).refusal


def test_a_wall_is_refused() -> None:
    true = make_world("wall", seed=1).elevation
    assert "a step of 0.45 m" in surveyed(remembered(true, (-1.0, 4.0)), (3.0, 0.0)).refusal
