"""The ground in the scene: one node a tile, sent again only when it, its neighbours or its colours have changed."""

from __future__ import annotations

from typing import Any

from weaver_console.scene.ground import Ground, TileIndex
from weaver_console.scene.layers import Legend, legend
from weaver_console.scene.node_values import assign
from weaver_console.scene.tile_mesh import tile_mesh

TILES_AN_UPDATE = 12
"""Most tiles made in one update, so that a whole map never holds up the robot's pose."""


SEAM_PERIOD = 5
"""Updates after which tiles are drawn again of which only a neighbour's edge has changed: half of all there were to
draw, for a seam of a few millimetres."""


class MeshStore:
    """Tiles' meshes by place, layer and content, shared by the scenes of all pages."""

    def __init__(self, largest: int = 2048) -> None:
        self._meshes: dict[tuple[object, ...], bytes | None] = {}
        self._largest = largest

    def mesh(self, ground: Ground, index: TileIndex, scale: Legend) -> bytes | None:
        key = (ground.serial, index, scale, _content(ground, index))
        if key not in self._meshes:
            while len(self._meshes) >= self._largest:
                del self._meshes[next(iter(self._meshes))]
            self._meshes[key] = tile_mesh(ground, index, scale)
        return self._meshes[key]


class TerrainFigure:
    """Draws the ground under `name` of a viser SceneApi, at most `TILES_AN_UPDATE` tiles a call."""

    def __init__(self, scene: Any, name: str, store: MeshStore) -> None:
        self._scene = scene
        self._name = name
        self._store = store
        self._nodes: dict[TileIndex, Any] = {}
        self._shown: dict[TileIndex, tuple[object, ...]] = {}
        self._ground_version = -1
        self._ground: Ground | None = None
        self._left: list[TileIndex] = []
        self._seams: dict[TileIndex, None] = {}
        self._updates = 0
        self.legend = legend("elevation")

    @property
    def unfinished(self) -> bool:
        """Whether not all that had changed has been drawn."""
        return bool(self._left)

    def update(self, ground: Ground, layer: str) -> bool:
        """Bring the tiles up to date; True when the colour scale has changed with it."""
        if ground is not self._ground:
            self.clear()
            self._ground = ground
        changed = self._rescale(ground, layer)
        if changed:
            self._left, self._ground_version = [], -1
        self._updates += 1
        seams_due = bool(self._seams) and self._updates % SEAM_PERIOD == 0
        if self.unfinished or seams_due or ground.version != self._ground_version:
            self._draw(ground, seams_due)
        return changed

    def clear(self) -> None:
        for node in self._nodes.values():
            node.remove()
        self._nodes, self._shown, self._left, self._seams, self._ground_version = {}, {}, [], {}, -1

    def _rescale(self, ground: Ground, layer: str) -> bool:
        if layer == self.legend.layer and (layer != "elevation" or ground.version == self._ground_version):
            return False
        scale = legend(layer, ground.range() if layer == "elevation" else None)
        if scale == self.legend or _covers(self.legend, scale):
            return False
        self.legend = scale
        return True

    def _draw(self, ground: Ground, seams_due: bool) -> None:
        """What had changed is drawn before what changes meanwhile, or a busy map would never be finished."""
        if not self._left:
            since, self._ground_version = self._ground_version, ground.version
            changed = ground.changed_since(since)
            self._seams.update(dict.fromkeys(place for index in changed for place in _borrowers(index)))
            touched = [*changed, *self._seams] if seams_due else changed
            if seams_due:
                self._seams = {}
            known = [index for index in dict.fromkeys(touched) if index in ground.tiles]
            self._left = [index for index in known if self._shown.get(index) != self._seen(ground, index)]
        now, self._left = self._left[:TILES_AN_UPDATE], self._left[TILES_AN_UPDATE:]
        for index in now:
            self._shown[index] = self._seen(ground, index)
            self._replace(index, self._store.mesh(ground, index, self.legend))

    def _seen(self, ground: Ground, index: TileIndex) -> tuple[object, ...]:
        return self.legend, _content(ground, index)

    def _replace(self, index: TileIndex, mesh: bytes | None) -> None:
        node = self._nodes.get(index)
        if mesh is None:
            if node is not None:
                node.remove()
                del self._nodes[index]
        elif node is not None:
            assign(node, glb_data=mesh)
        else:
            name = f"{self._name}/{index[0]}_{index[1]}"
            self._nodes[index] = self._scene.add_glb(name, mesh, cast_shadow=False, receive_shadow=False)


def _content(ground: Ground, index: TileIndex) -> tuple[int, ...]:
    """Versions of a tile and of the three neighbours whose edge it borrows."""
    i, j = index
    return tuple(ground.versions.get(place, 0) for place in ((i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)))


def _borrowers(index: TileIndex) -> tuple[TileIndex, ...]:
    """The three neighbours whose meshes reach into this tile."""
    i, j = index
    return (i - 1, j), (i, j - 1), (i - 1, j - 1)


def _covers(old: Legend, new: Legend) -> bool:
    """Whether an elevation scale in use still holds the range, being at most a little wider: keeps colours calm."""
    if old.layer != new.layer or new.layer != "elevation":
        return False
    low, high = old.stops[0][0], old.stops[-1][0]
    new_low, new_high = new.stops[0][0], new.stops[-1][0]
    return low <= new_low and new_high <= high and (high - low) <= (new_high - new_low) + 0.25
