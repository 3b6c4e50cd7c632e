"""Line segments in the scene that may be none."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from weaver_console.scene.node_values import assign

Array = NDArray[np.float64]
NONE = np.zeros((0, 2, 3))


class Lines:
    """One node for as long as the figure lives; hidden while it has nothing to show."""

    def __init__(self, scene: Any, name: str, colour: tuple[int, int, int], thickness: float = 0.008) -> None:
        self._node = scene.add_line_segments(name, np.zeros((1, 2, 3), np.float32), colour, thickness=thickness)
        self._node.visible = False
        self._colour: tuple[int, int, int] | None = colour

    def show(self, segments: Array) -> None:
        """Segments (n, 2, 3)."""
        if len(segments):
            assign(self._node, points=segments.astype(np.float32))
        self._node.visible = len(segments) > 0

    def chain(self, points: Array) -> None:
        """One line through points (n, 3)."""
        self.show(chained(points))

    def show_in(self, segments: Array, colours: NDArray[np.uint8]) -> None:
        """Segments (n, 2, 3), each in a colour of its own (n, 3)."""
        if len(segments):
            self._colour = None
            assign(self._node, points=segments.astype(np.float32), colors=np.repeat(colours[:, None], 2, axis=1))
        self._node.visible = len(segments) > 0

    def colour(self, colour: tuple[int, int, int]) -> None:
        if colour != self._colour:
            self._colour = colour
            self._node.colors = np.array(colour, dtype=np.uint8)


def chained(points: Array) -> Array:
    """Segments (n - 1, 2, 3) of the line through points (n, 3)."""
    return np.stack([points[:-1], points[1:]], axis=1) if len(points) > 1 else NONE
