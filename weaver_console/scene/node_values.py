"""Sets what changes many times a second at nodes of the scene, as viser's own setters do for ten times the work.

Those resolve type hints, compare and copy arrays anew at every assignment: 30 microseconds each, which with a robot's
dozen properties, 20 times a second and for every page, was a tenth of a core.
"""

from __future__ import annotations

from typing import Any

from numpy.typing import NDArray
from viser._messages import SceneNodeUpdateMessage, SetOrientationMessage, SetPositionMessage


def assign(node: Any, **values: Any) -> None:
    """Give properties of a node new values, in one message; arrays in viser's own types, and never changed again."""
    inner = node._impl
    for name, value in values.items():
        setattr(inner.props, name, value)
    inner.api._queue_scene_message(SceneNodeUpdateMessage(inner.name, values))


def place(node: Any, position: NDArray[Any], wxyz: NDArray[Any] | None = None) -> None:
    """Put a node at a position (3,) and, where given, in an attitude (4,), in its parent's frame."""
    inner = node._impl
    if (to := tuple(position.tolist())) != tuple(inner.position.tolist()):
        inner.position[:] = to
        inner.api._queue_scene_message(SetPositionMessage(inner.name, to))
    if wxyz is not None and (turned := tuple(wxyz.tolist())) != tuple(inner.wxyz.tolist()):
        inner.wxyz[:] = turned
        inner.api._queue_scene_message(SetOrientationMessage(inner.name, turned))
