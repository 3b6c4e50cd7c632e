from collections.abc import Iterator

import pytest

from sim_agent.body import SimulatedBody
from sim_agent.worlds import make_world
from weaver_shared.robots import RobotDescription, load_robot


@pytest.fixture(scope="session")
def robot() -> RobotDescription:
    return load_robot()


@pytest.fixture
def sitting(robot: RobotDescription) -> Iterator[SimulatedBody]:
    """A robot on level ground, torque off."""
    body = SimulatedBody(robot, make_world("flat", 1), 1)
    yield body
    body.close()
