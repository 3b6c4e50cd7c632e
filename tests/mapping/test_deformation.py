"""When odometry finds that it drifted, the ground seen meanwhile moves to where it should have been."""

import numpy as np
import pytest
from made_ground import at, seen

from robot_agent.mapping import TerrainMap
from weaver_shared.transforms import Pose, rotation_z

STEP_NS = 500_000_000
SLOPE = 0.1


def true_ground(x, y):
    return 0.05 * np.sin(4.0 * x) * np.cos(3.0 * y)


def drifted_walk(drift_per_frame, frames=10):
    """A walk along x during which the pose drifts by (x, y, z) m a frame; returns the map and the true poses."""
    terrain_map, true_poses = TerrainMap(), {}
    for k in range(frames):
        stamp_ns, drift = k * STEP_NS, k * np.asarray(drift_per_frame)
        x = 0.2 * k

        def drifted(world_x, world_y, drift=drift):
            return true_ground(world_x - drift[0], world_y - drift[1]) + drift[2]

        odometry = at(x=x + drift[0], y=drift[1], stamp_ns=stamp_ns)
        odometry.position_in_world[2] += drift[2]
        terrain_map.remember(odometry)
        terrain_map.update(seen(drifted, x=(x + drift[0] + 0.3, x + drift[0] + 0.5), stamp_ns=stamp_ns), odometry)
        true_poses[stamp_ns] = Pose.of([x, 0.0, 0.165])
    return terrain_map, true_poses


def errors(terrain_map):
    """Differences of the map from the true ground over its cells, m."""
    grid = terrain_map.grid
    rows, columns = np.nonzero(np.isfinite(grid.elevation))
    x = (grid.row0 + (rows - grid.row0) % grid.size + 0.5) * grid.cell
    y = (grid.column0 + (columns - grid.column0) % grid.size + 0.5) * grid.cell
    return grid.elevation[rows, columns] - true_ground(x, y)


def test_ground_is_carried_in_x_y_and_z_to_where_it_belongs():
    terrain_map, true_poses = drifted_walk((0.012, -0.008, 0.006))
    before, known = np.abs(errors(terrain_map)).max(), np.isfinite(terrain_map.grid.elevation).sum()
    assert terrain_map.follow(true_poses)
    after = errors(terrain_map)
    assert before > 0.05
    assert np.abs(after).max() < 0.006  # half a cell on the steepest slope
    assert np.sqrt((after**2).mean()) < 0.0025
    assert np.isfinite(terrain_map.grid.elevation).sum() > 0.93 * known


def test_a_turn_is_undone():
    terrain_map = TerrainMap()
    turned = rotation_z(0.1)

    def as_seen(x, y):
        old = np.stack([x, y], axis=-1) @ turned[:2, :2]
        return true_ground(old[..., 0], old[..., 1])

    odometry = at()
    drifted = Pose(rotation=turned, position=np.array([0.0, 0.0, 0.165]))
    odometry.wxyz[:] = drifted.wxyz
    terrain_map.remember(odometry)
    terrain_map.update(seen(as_seen), odometry)
    known = np.isfinite(terrain_map.grid.elevation).sum()
    assert terrain_map.follow({0: Pose.of([0.0, 0.0, 0.165])})
    assert np.abs(errors(terrain_map)).max() < 0.006
    assert np.isfinite(terrain_map.grid.elevation).sum() == pytest.approx(known, rel=0.02)  # no holes


def test_small_corrections_wait_until_they_have_grown():
    terrain_map, true_poses = drifted_walk((0.0, 0.0, 0.0))
    elevation = terrain_map.grid.elevation.copy()
    for k in range(1, 5):
        rise = np.array([0.0, 0.0, 0.0012 * k])
        raised = {stamp: Pose.of(pose.position + rise) for stamp, pose in true_poses.items()}
        assert terrain_map.follow(raised) == (k == 4)
    known = np.isfinite(elevation)
    assert terrain_map.grid.elevation[known] == pytest.approx(elevation[known] + 0.0048, abs=1e-6)
    assert not terrain_map.follow(raised)


def test_corrections_of_poses_never_seen_change_nothing():
    terrain_map, _ = drifted_walk((0.0, 0.0, 0.0))
    assert not terrain_map.follow({123: Pose.of([5.0, 0.0, 0.0])})
    assert not terrain_map.follow({})


def test_all_tiles_and_features_follow():
    terrain_map, true_poses = drifted_walk((0.0, 0.0, 0.01))
    terrain_map.changed_tiles(0)
    assert terrain_map.follow(true_poses)
    tiles = terrain_map.changed_tiles(0)
    assert tiles
    straight, _ = drifted_walk((0.0, 0.0, 0.0))
    straight.renew_all()
    for x in (0.5, 1.0, 1.5):
        found, expected = (m.worst_within(x, 0.0, 0.3) for m in (terrain_map, straight))
        assert found.roughness == pytest.approx(expected.roughness, abs=0.03)
