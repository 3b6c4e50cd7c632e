"""Contact is what mechanics says: weight, friction, smooth ground and ground that yields."""

from collections.abc import Iterator

import numpy as np
import pytest

from sim_agent.model import sitting_joints
from sim_agent.physics import ContactSensor, Engine
from sim_agent.physics.engine import _PARAMETERS, FOOT_FRICTION, TRUNK_FRICTION
from sim_agent.physics.ground import load_ground
from sim_agent.physics.quiet import quiet
from sim_agent.worlds import MATERIALS, Box, Heightfield, Plane, World, make_world
from weaver_shared.frames import GRAVITY
from weaver_shared.robots import load_robot

with quiet():
    import pybullet

MASS = 3.4  # kg, a foot's share of the robot
RADIUS = 0.016


class Ball:
    """A heavy foot alone on a piece of ground."""

    def __init__(self, world: World, *, friction: float, height: float) -> None:
        self.client = pybullet.connect(pybullet.DIRECT)
        pybullet.setGravity(0, 0, -GRAVITY, physicsClientId=self.client)
        pybullet.setPhysicsEngineParameter(physicsClientId=self.client, **_PARAMETERS)
        with quiet():
            load_ground(world, self.client)
        shape = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=RADIUS, physicsClientId=self.client)
        self.body = pybullet.createMultiBody(
            MASS, shape, basePosition=[0.0, 0.0, height + RADIUS], physicsClientId=self.client
        )
        pybullet.changeDynamics(
            self.body,
            -1,
            lateralFriction=friction,
            rollingFriction=0.0,
            spinningFriction=0.0,
            linearDamping=0.0,
            angularDamping=0.0,
            localInertiaDiagonal=[1e3, 1e3, 1e3],  # slides, does not roll
            physicsClientId=self.client,
        )

    def run(self, seconds: float, force: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None:
        for _ in range(round(seconds * 400)):
            position, _ = pybullet.getBasePositionAndOrientation(self.body, physicsClientId=self.client)
            pybullet.applyExternalForce(
                self.body, -1, force, position, pybullet.WORLD_FRAME, physicsClientId=self.client
            )
            pybullet.stepSimulation(physicsClientId=self.client)

    @property
    def position(self) -> np.ndarray:
        return np.array(pybullet.getBasePositionAndOrientation(self.body, physicsClientId=self.client)[0])

    @property
    def velocity(self) -> np.ndarray:
        return np.array(pybullet.getBaseVelocity(self.body, physicsClientId=self.client)[0])


@pytest.fixture
def balls() -> Iterator[list[Ball]]:
    made: list[Ball] = []
    yield made
    for ball in made:
        pybullet.disconnect(ball.client)


def world_of(*solids: Plane | Box | Heightfield) -> World:
    return World(
        name="piece",
        seed=0,
        start=(0, 0, 0),
        bounds=(-1, 1, -1, 1),
        planes=tuple(s for s in solids if isinstance(s, Plane)),
        boxes=tuple(s for s in solids if isinstance(s, Box)),
        heightfields=tuple(s for s in solids if isinstance(s, Heightfield)),
    )


def slab(material: str) -> Box:
    return Box.under(x=(-1, 1), y=(-1, 1), top=0.0, depth=0.3, material=material)


@pytest.mark.parametrize("direction", [0.0, 22.5, 45.0])
def test_a_foot_slips_when_the_pull_exceeds_friction_in_any_direction(balls: list[Ball], direction: float) -> None:
    grip = MATERIALS["board"].friction * MASS * GRAVITY
    away = np.array([np.cos(np.deg2rad(direction)), np.sin(np.deg2rad(direction)), 0.0])
    moved = []
    for share in (0.95, 1.05):
        ball = Ball(world_of(slab("board")), friction=1.0, height=0.0)
        balls.append(ball)
        ball.run(0.2)
        before = ball.position
        ball.run(0.5, tuple(share * grip * away))
        moved.append(float(np.linalg.norm((ball.position - before)[:2])))
    held, slipped = moved
    assert held < 5e-4
    assert slipped > 0.02


@pytest.mark.parametrize("material", ["sand", "gravel"])
def test_yielding_ground_sinks_by_weight_over_stiffness(balls: list[Ball], material: str) -> None:
    ball = Ball(world_of(slab(material)), friction=1.0, height=0.001)
    balls.append(ball)
    ball.run(2.0)
    expected = MASS * GRAVITY / MATERIALS[material].stiffness
    assert RADIUS - ball.position[2] == pytest.approx(expected, rel=0.05)


def test_rigid_ground_does_not_sink(balls: list[Ball]) -> None:
    ball = Ball(world_of(slab("stone")), friction=1.0, height=0.001)
    balls.append(ball)
    ball.run(1.0)
    assert abs(RADIUS - ball.position[2]) < 1e-4


def test_a_foot_glides_over_a_level_heightfield_as_over_a_plane(balls: list[Ball]) -> None:
    field = Heightfield(origin=(-0.5, -0.5), cell=0.02, z=np.zeros((81, 51)), material="earth")
    ball = Ball(world_of(Plane(height=-5.0, material="board"), field), friction=0.0, height=0.0)
    balls.append(ball)
    ball.run(0.1)
    pybullet.resetBaseVelocity(ball.body, [0.3, 0.0, 0.0], physicsClientId=ball.client)
    ball.run(1.0)
    assert ball.velocity[0] == pytest.approx(0.3, rel=0.005)


def test_the_contact_switch_has_hysteresis_and_waits_for_two_ticks() -> None:
    sensor = ContactSensor(1, weight=100.0)
    feel = [bool(sensor.step(np.array([force]))[0]) for force in (0, 9, 0, 9, 9, 3, 3, 3, 1, 3, 1, 1, 3, 3, 3)]
    assert feel == [False] * 4 + [True] * 7 + [False] * 4


def test_a_robots_feet_and_trunk_have_the_friction_they_are_given() -> None:
    robot = load_robot("weaver")
    engine = Engine(robot, make_world("flat", 1), sitting_joints(robot))
    try:
        found = {
            link: pybullet.getDynamicsInfo(engine._body, link, physicsClientId=engine._client)[1]
            for link in (-1, *engine.foot_links)
        }
    finally:
        engine.close()
    assert found.pop(-1) == TRUNK_FRICTION
    assert set(found.values()) == {FOOT_FRICTION}
