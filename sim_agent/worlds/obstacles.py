"""Level ground with things too high to step on: for finding a way around them, or finding that there is none."""

from sim_agent.worlds.scene import Box, Plane, World

HEIGHT = 0.45  # m, above the robot's eyes
THICKNESS = 0.15  # m
BOUNDS = (-4.0, 10.0, -6.0, 6.0)


def wall(seed: int) -> World:
    """One wall across the way to x = 3 and more, open far to the right and farther to the left."""
    return _world("wall", seed, (_block((1.7, 1.7 + THICKNESS), (-0.9, 2.2)),))


def pen(seed: int) -> World:
    """Four walls around the start, without a gate."""
    front, side = 1.6, 1.5
    return _world(
        "pen",
        seed,
        (
            _block((front, front + THICKNESS), (-side - THICKNESS, side + THICKNESS)),
            _block((-front - THICKNESS, -front), (-side - THICKNESS, side + THICKNESS)),
            _block((-front, front), (side, side + THICKNESS)),
            _block((-front, front), (-side - THICKNESS, -side)),
        ),
    )


def _world(name: str, seed: int, boxes: tuple[Box, ...]) -> World:
    plane = Plane(height=0.0, material="board")
    return World(name=name, seed=seed, start=(0.0, 0.0, 0.0), bounds=BOUNDS, planes=(plane,), boxes=boxes)


def _block(x: tuple[float, float], y: tuple[float, float]) -> Box:
    return Box.under(x=x, y=y, top=HEIGHT, depth=HEIGHT + 0.1, material="stone")
