"""The simulated robot is the described one."""

from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim_agent.model import leg_links, link_poses, robot_urdf, sitting_joints
from sim_agent.model.urdf import fixed_axis_angles
from sim_agent.physics.quiet import quiet
from weaver_shared.errors import ConfigurationError
from weaver_shared.robots import RobotDescription, load_robot
from weaver_shared.robots.forward_kinematics import feet_in_body, joint_frames_in_body
from weaver_shared.transforms import rotation_from_rpy

with quiet():
    import pybullet


@pytest.fixture(params=["weaver", "bullet_b_mammalian", "max", "octopod"])
def robot(request: pytest.FixtureRequest) -> RobotDescription:
    return load_robot(request.param)


@pytest.fixture
def loaded(robot: RobotDescription, tmp_path) -> Iterator[tuple[int, int]]:
    client = pybullet.connect(pybullet.DIRECT)
    path = tmp_path / "robot.urdf"
    path.write_text(robot_urdf(robot))
    with quiet():
        body = pybullet.loadURDF(str(path), flags=pybullet.URDF_USE_INERTIA_FROM_FILE, physicsClientId=client)
    yield client, body
    pybullet.disconnect(client)


def test_urdf_has_all_mass_and_every_joint_with_its_limits(robot: RobotDescription, loaded: tuple[int, int]) -> None:
    client, body = loaded
    count = pybullet.getNumJoints(body, physicsClientId=client)
    mass = sum(pybullet.getDynamicsInfo(body, i, physicsClientId=client)[0] for i in range(-1, count))
    assert mass == pytest.approx(robot.mass, abs=1e-9)
    infos = [pybullet.getJointInfo(body, i, physicsClientId=client) for i in range(count)]
    found = {info[1].decode(): (info[8], info[9]) for info in infos}
    assert set(found) == set(robot.joint_names)
    limits = np.array([found[name] for name in robot.joint_names])
    assert np.allclose(limits, np.tile(robot.joint_limits, (robot.leg_count, 1)))


def test_urdf_puts_links_where_forward_kinematics_does(robot: RobotDescription, loaded: tuple[int, int]) -> None:
    client, body = loaded
    names = [pybullet.getJointInfo(body, i, physicsClientId=client)[1].decode() for i in range(robot.joint_count)]
    indices = [names.index(name) for name in robot.joint_names]
    trunk = np.array(pybullet.getDynamicsInfo(body, -1, physicsClientId=client)[3])
    pybullet.resetBasePositionAndOrientation(body, trunk.tolist(), [0, 0, 0, 1], physicsClientId=client)
    generator = np.random.default_rng(0)
    for _ in range(5):
        lower, upper = np.tile(robot.joint_limits, (robot.leg_count, 1)).T
        angles = generator.uniform(lower, upper)
        for index, angle in zip(indices, angles, strict=True):
            pybullet.resetJointState(body, index, angle, physicsClientId=client)
        states = pybullet.getLinkStates(body, indices, computeForwardKinematics=True, physicsClientId=client)
        ours = link_poses(robot, leg_links(robot), joint_frames_in_body(robot, angles)).reshape(-1, 4, 4)
        assert np.allclose([state[4] for state in states], ours[:, :3, 3], atol=1e-6)
        drawn = [np.array(pybullet.getMatrixFromQuaternion(state[5])).reshape(3, 3) for state in states]
        assert np.allclose(drawn, ours[:, :3, :3], atol=1e-6)


@given(st.floats(-3.1, 3.1), st.sampled_from([-np.pi / 2, np.pi / 2, 0.3, -1.2]), st.floats(-3.1, 3.1))
def test_urdf_angles_give_the_rotation_back_even_at_right_angles(roll: float, pitch: float, yaw: float) -> None:
    rotation = rotation_from_rpy(roll, pitch, yaw)
    assert np.allclose(rotation_from_rpy(*fixed_axis_angles(rotation)), rotation, atol=1e-7)


def test_a_sitting_robot_has_its_feet_on_the_plane_of_its_belly(robot: RobotDescription) -> None:
    joints = sitting_joints(robot)
    feet = feet_in_body(robot, joints)
    assert np.allclose(feet[:, :2], robot.sitting_in_body[:, :2], atol=1e-3)
    assert np.allclose(feet[:, 2], robot.belly - robot.sitting_gap + robot.foot_radius, atol=1e-3)
    lower, upper = np.tile(robot.joint_limits, (robot.leg_count, 1)).T
    assert np.all((joints >= lower) & (joints <= upper))


def test_a_robot_that_can_not_sit_is_refused(robot: RobotDescription) -> None:
    content = robot.model_dump()
    for leg in content["legs"]:
        leg["stance_in_body"] = (2.0, 2.0)
    with pytest.raises(ConfigurationError, match="can not sit"):
        sitting_joints(RobotDescription.model_validate(content))


@settings(max_examples=20)
@given(st.integers(0, 4))
def test_link_moments_could_belong_to_a_solid_body(index: int) -> None:
    moments = np.sort(leg_links(load_robot())[index].inertia)
    assert moments[0] > 0.0
    assert moments[2] <= moments[0] + moments[1] + 1e-15
