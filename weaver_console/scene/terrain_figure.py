"""The ground in the scene: one node a tile, sent again only when it, its neighbours or its colours have changed."""

from __future__ import annotations

from typing import Any

from weaver_console.scene.ground import Ground, TileIndex
from weaver_console.scene.layers import Legend, legend
from weaver_console.scene.tile_mesh import tile_mesh

TILES_AN_UPDATE = 12
"""Most tiles made in one update, so that a whole map never holds up the robot's pose."""


READING_PICTURES = 3
"""Pictures, of 15 a second, within which a browser has read new tiles."""

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
    """Draws the ground under `name` of a viser SceneApi, so many tiles a call.

    First come tiles that were never drawn, so that the robot never walks over a void while the rest is recoloured; then
    those that wait longest, so that a busy map is finished all over.

    A browser shows nothing of a mesh until it has read it, and forgets the old one at once. So a changed tile is a node
    of its own, and the one before goes only when the new one has had time to be read.
    """

    def __init__(self, scene: Any, name: str, store: MeshStore) -> None:
        self._scene = scene
        self._name = name
        self._store = store
        self._nodes: dict[TileIndex, Any] = {}  # the newest of each tile
        self._former: dict[TileIndex, tuple[Any, int]] = {}  # what it takes the place of, and when that goes
        self._settled = 0
        self._named = 0
        self._shown: dict[TileIndex, tuple[object, ...]] = {}
        self._ground_version = -1
        self._ground: Ground | None = None
        self._left: dict[TileIndex, None] = {}  # to be drawn, those that wait longest first
        self._seams: dict[TileIndex, None] = {}
        self._updates = 0
        self.legend = legend("elevation")

    @property
    def unfinished(self) -> bool:
        """Whether more could be drawn at once of what has changed."""
        return any(index not in self._former for index in self._left)

    def settle(self) -> None:
        """Count a picture; take away what a newer mesh has had time to replace."""
        self._settled += 1
        for index, (node, until) in list(self._former.items()):
            if self._settled >= until:
                node.remove()
                del self._former[index]

    def update(
        self, ground: Ground, layer: str, *, most: int = TILES_AN_UPDATE, patience: int = READING_PICTURES
    ) -> bool:
        """Bring up to `most` tiles up to date, which a browser has read `patience` pictures later; True when the colour
        scale has changed with it."""
        if ground is not self._ground:
            self.clear()
            self._ground = ground
        changed = self._rescale(ground, layer)
        if changed:
            self._ground_version = -1
        self._updates += 1
        seams_due = bool(self._seams) and self._updates % SEAM_PERIOD == 0
        if self.unfinished or seams_due or ground.version != self._ground_version:
            self._note_changes(ground, seams_due)
            self._draw(ground, most, patience)
        return changed

    def clear(self) -> None:
        for node in (*self._nodes.values(), *(node for node, _ in self._former.values())):
            node.remove()
        self._former = {}
        self._nodes, self._shown, self._left, self._seams, self._ground_version = {}, {}, {}, {}, -1

    def _rescale(self, ground: Ground, layer: str) -> bool:
        if layer == self.legend.layer and (layer != "elevation" or ground.version == self._ground_version):
            return False
        scale = legend(layer, ground.range() if layer == "elevation" else None)
        if scale == self.legend or _covers(self.legend, scale):
            return False
        self.legend = scale
        return True

    def _note_changes(self, ground: Ground, seams_due: bool) -> None:
        since, self._ground_version = self._ground_version, ground.version
        changed = ground.changed_since(since)
        self._seams.update(dict.fromkeys(place for index in changed for place in _borrowers(index)))
        touched = [*changed, *self._seams] if seams_due else changed
        if seams_due:
            self._seams = {}
        for index in touched:
            if index in ground.tiles and self._shown.get(index) != self._seen(ground, index):
                self._left.setdefault(index)

    def _draw(self, ground: Ground, most: int, patience: int) -> None:
        new = [index for index in self._left if index not in self._shown]
        ready = [index for index in dict.fromkeys([*new, *self._left]) if index not in self._former]
        for index in ready:
            mesh = self._store.mesh(ground, index, self.legend)
            most -= mesh is not None  # most of a young map is unknown, which costs the browser nothing
            if most < 0:
                break
            del self._left[index]
            self._shown[index] = self._seen(ground, index)
            self._replace(index, mesh, patience)

    def _seen(self, ground: Ground, index: TileIndex) -> tuple[object, ...]:
        return self.legend, _content(ground, index)

    def _replace(self, index: TileIndex, mesh: bytes | None, patience: int) -> None:
        former = self._nodes.pop(index, None)
        if mesh is not None:
            self._named += 1
            name = f"{self._name}/{index[0]}_{index[1]}_{self._named}"
            self._nodes[index] = self._scene.add_glb(name, mesh, cast_shadow=False, receive_shadow=False)
        if former is not None:
            self._former[index] = former, self._settled + patience


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
