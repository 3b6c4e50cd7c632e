"""All links of a robot as one batched mesh, stretched prisms: of the robot itself and of its ghost."""

from __future__ import annotations

from typing import Any

import numpy as np

from weaver_console.scene.posture import Array, segments, visible_links
from weaver_console.scene.shapes import prism


def add_links(scene: Any, name: str, frames: Array, width: float, colour: tuple[int, int, int], **look: Any) -> Any:
    """The node `name` with links `width` m wide, for a leg's frames (legs, joints + 1, 4, 4) in any posture."""
    positions, wxyzs, lengths = segments(frames, visible_links(frames))
    vertices, faces = prism()
    across = np.full(lengths.size, width)
    return scene.add_batched_meshes_simple(
        name, vertices, faces, wxyzs, positions,
        batched_scales=np.stack([across, across, lengths], axis=1), batched_colors=colour, flat_shading=True, lod="off",
        **look,
    )  # fmt: skip
