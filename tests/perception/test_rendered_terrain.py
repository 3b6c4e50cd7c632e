"""Perception and map on rendered pictures of the testbed, against the surface that was drawn."""

import numpy as np
import pytest
from raycast_scene import odometry_at

from robot_agent.mapping import TerrainMap
from robot_agent.perception import TerrainPerception
from robot_agent.vision.camera import StereoCalibration
from sim_agent.rendering import StereoRenderer
from sim_agent.worlds import make_world
from weaver_shared.messages import SceneState
from weaver_shared.robots import load_robot
from weaver_shared.transforms import Pose, rotation_y

ROBOT = load_robot()
FRAMES = 4
STEP = 0.15  # m between frames


class Walk:
    """The robot carried over one segment, looking as it goes."""

    def __init__(self, world, renderer, segment):
        perception = TerrainPerception(StereoCalibration.of_robot(ROBOT))
        self.map, self.world, self.roughness, self.step_height = TerrainMap(), world, [], []
        first = 0.5 * (segment.begin + segment.end) - 0.9 - STEP * (FRAMES - 1) / 2
        for k in range(FRAMES):
            pose = self.pose_at(first + STEP * k)
            scene = SceneState(
                stamp_ns=k * 100_000_000,
                position_in_world=pose.position,
                wxyz=pose.wxyz,
                joint_position=np.zeros(ROBOT.joint_count),
            )
            frame = renderer.render(scene, k)
            odometry = odometry_at(pose, stamp_ns=frame.stamp_ns)
            perceived = perception.step(frame, odometry)
            self.map.update(perceived, odometry)
            self.roughness.append(perceived.estimate.roughness)
            self.step_height.append(perceived.estimate.step_height)

    def pose_at(self, x):
        along = np.linspace(-0.3, 0.3, 7)
        ground = self.world.elevation(*np.meshgrid(x + along, along, indexing="ij")).mean(axis=1)
        pitch = -np.arctan(np.polyfit(along, ground, 1)[0])
        return Pose(rotation=rotation_y(pitch), position=np.array([x, 0.0, ground.mean() + ROBOT.clearance]))

    def errors(self):
        grid = self.map.grid
        rows, columns = np.nonzero(np.isfinite(grid.elevation))
        x = ((rows - grid.row0) % grid.size + grid.row0 + 0.5) * grid.cell
        y = ((columns - grid.column0) % grid.size + grid.column0 + 0.5) * grid.cell
        on_course = np.abs(y) < 0.48
        return np.abs(grid.elevation[rows, columns] - self.world.elevation(x, y))[on_course]


@pytest.fixture(scope="module")
def walks():
    world = make_world("testbed", 1)
    renderer = StereoRenderer(ROBOT, world, 1)
    if renderer.warning:
        pytest.skip(renderer.warning)
    yield {s.name: Walk(world, renderer, s) for s in world.segments if s.name in "ACDEF"}
    renderer.close()


def test_flat_board_reads_flat(walks):
    assert np.median(walks["A"].roughness) < 0.05
    assert np.median(walks["A"].step_height) < 0.05


def test_segments_rank_as_they_were_built(walks):
    order = ["A", "E", "D", "F", "C"]
    for measure in ("roughness", "step_height"):
        values = [np.median(getattr(walks[name], measure)) for name in order]
        assert values == sorted(values), (measure, dict(zip(order, values, strict=True)))
    assert np.median(walks["C"].roughness) > 0.6
    assert np.median(walks["F"].roughness) > 0.3


def test_the_map_is_the_ground(walks):
    for name, median, p95 in (("A", 0.003, 0.008), ("E", 0.004, 0.012), ("D", 0.004, 0.02), ("F", 0.004, 0.05)):
        error = walks[name].errors()
        assert len(error) > 1500
        assert np.median(error) < median, name
        assert np.quantile(error, 0.95) < p95, name
