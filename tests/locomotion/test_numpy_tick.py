"""The compiled tick does what the readable numpy form of it does, to 1e-9, over random walks of every robot."""

import numpy as np
import pytest
from numpy_tick import Walk, tick

from robot_agent.locomotion import Walker, WalkInput
from robot_agent.locomotion.posing.order import NO_POSING, PosingOrder
from robot_agent.locomotion.walk_state import WALK
from robot_agent.locomotion.whole_tick import posed_tick, usual_tick
from weaver_shared.messages import GaitParameters
from weaver_shared.robots import load_robot, robot_names

ANY_MARGIN = -np.inf


class RandomWalk:
    """Orders, contacts, torques and gravity that change at random, given straight to the memory of a walker."""

    def __init__(self, name, seed, *, posed=False, **settings):
        self.rng, self.robot = np.random.default_rng(seed), load_robot(name)
        config = self.robot.locomotion.model_copy(update=settings)
        self.walker = Walker(self.robot, config, float(self.rng.choice([0.005, 0.01, 0.02])))
        self.joints = self.walker.begin_standing()
        self.memory, self.posed = self.walker._memory, posed
        self.slews = self.walker._poser.slews
        self.velocity, self.gait = np.zeros(3), self.robot.gaits[0]
        self.parameters, self.order = self._parameters(), NO_POSING

    def _parameters(self):
        frequency, height, stiffness = self.rng.uniform([0.4, 0.02, 500.0], [1.2, 0.06, 3000.0])
        return GaitParameters(
            stamp_ns=0,
            virtual_stiffness=stiffness,
            stride_frequency=frequency,
            stride_height=height,
            confidence=1.0,
        )

    def order_something_else(self):
        rng = self.rng
        self.velocity = rng.choice([0.0, 1.0, 1.0, 3.0]) * rng.normal(0.0, 0.1, 3)
        self.gait, self.parameters = str(rng.choice(self.robot.gaits)), self._parameters()
        if self.posed:
            self.order = PosingOrder(
                manual=tuple(rng.normal(0.0, 0.01, 6)), automatic=bool(rng.random() < 0.7), levelling=True
            )

    def sense(self):
        """Write this tick's readings, some of them not numbers, into the memory."""
        rng, walker = self.rng, self.walker
        swing = walker._in_air
        contact = ~swing | (walker._phase > 0.3) if rng.random() < 0.95 else rng.random(swing.size) < 0.5
        down = rng.normal(0.0, 0.05, 3) - [0.0, 0.0, 1.0]
        joints = self.joints + rng.normal(0.0, 1e-3, self.joints.size)
        if rng.random() < 0.05:
            joints[rng.integers(joints.size)] = np.nan
        walker._take(
            WalkInput(
                stamp_ns=0,
                velocity=self.velocity if rng.random() < 0.98 else np.full(3, np.nan),
                parameters=self.parameters,
                gait=self.gait,
                stand=True,
                joint_position=joints,
                joint_torque=walker.carrying_torque() + rng.normal(0.0, 0.2, joints.size),
                foot_contact=contact,
                gravity_in_body=down / np.linalg.norm(down),
            )
        )
        if self.posed:
            walker._poser.plan(self.order, walker._gait, walking=bool(self.memory[0]["gait"]["walking"]))

    def kernel(self, memory, slews):
        if self.posed:
            posed_tick(memory, ANY_MARGIN, ANY_MARGIN, slews)
        else:
            usual_tick(memory, ANY_MARGIN, ANY_MARGIN)

    def reference(self, memory, slews):
        tick(Walk(memory), slews if self.posed else None)


def words(layout=WALK, begin=0, path=""):
    """Of every eight bytes of the memory: the field's name, and whether it holds a float."""
    for name, (kind, offset, *_) in layout.fields.items():
        if kind.fields:
            yield from words(kind, begin + offset, f"{path}{name}.")
        else:
            number = kind.subdtype[0] if kind.subdtype else kind
            yield from [(path + name, number == np.float64)] * (kind.itemsize // 8)


NAMES, FLOATS = (np.array(column) for column in zip(*words(), strict=True))


def compare(actual, expected):
    """Every number of both memories, to 1e-9 of its size."""
    far = ~np.isclose(actual.view(np.float64), expected.view(np.float64), rtol=1e-9, atol=1e-9, equal_nan=True)
    wrong = np.where(FLOATS, far, actual.view(np.int64) != expected.view(np.int64))
    assert not wrong.any(), f"differs in {sorted(set(NAMES[wrong]))}"


def test_a_difference_is_noticed_in_any_field():
    for word in range(len(NAMES)):
        memory, changed = np.zeros(1, WALK), np.zeros(1, WALK)
        changed.view(np.float64 if FLOATS[word] else np.int64)[word] = 1e-8 if FLOATS[word] else 1
        with pytest.raises(AssertionError, match=NAMES[word]):
            compare(memory, changed)


@pytest.mark.parametrize("posed", [False, True])
@pytest.mark.parametrize("name", robot_names())
def test_every_tick_of_a_random_walk_is_that_of_the_readable_form(name, posed):
    walk = RandomWalk(name, seed=sum(map(ord, name)), posed=posed)
    modes = set()
    for number in range(50):
        if number % 10 == 0:
            walk.order_something_else()
        walk.sense()
        memory, slews = walk.memory.copy(), walk.slews.copy()
        walk.reference(memory, slews)
        walk.kernel(walk.memory, walk.slews)
        compare(walk.memory, memory)
        np.testing.assert_allclose(walk.slews, slews, atol=1e-9)
        walk.joints = walk.memory[0]["answer"]["joint_position"][: walk.joints.size].copy()
        modes |= set(walk.memory[0]["feet"]["mode"][: walk.robot.leg_count].tolist())
    assert {0, 1} <= modes
