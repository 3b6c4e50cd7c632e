"""Level ground, for measuring what the ground does not disturb."""

from sim_agent.worlds.scene import Plane, World


def flat(seed: int) -> World:
    return World(
        name="flat",
        seed=seed,
        start=(0.0, 0.0, 0.0),
        bounds=(-10.0, 10.0, -10.0, 10.0),
        planes=(Plane(height=0.0, material="board"),),
    )
