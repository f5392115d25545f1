"""A lidar in worlds whose floor plans change: one plan a world, exchanged when an episode begins."""

import numpy as np
from numpy.typing import NDArray

from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar, LidarSpec
from lidarena.world.map_geometry import MapGeometry, lay_out

_Room = tuple[int, int, int, int]


class ChangingLidar(Lidar):
    """Casts the beams of many robots, each in a floor plan of its world's own.

    Every world has room in the arrays of ``geometry`` for as much as the largest plan so far needs, so that exchanging
    a plan seldom allocates. What beams meet depends on the world's own plan only.

    Args:
        worlds: Number of worlds; plan ``i`` is that of world ``i``.
        spec: Beams, range and noise.
    """

    def __init__(self, worlds: int, spec: LidarSpec | None = None) -> None:
        super().__init__([], spec)
        self._parts: list[MapGeometry | None] = [None] * worlds
        self._room: _Room = (0, 0, 0, 0)
        self._allocate(self._room)

    def exchange(self, world: int, plan: Floorplan) -> None:
        """Let a world have another plan."""
        part = lay_out([plan], self.spec.max_range)
        self._parts[world] = part
        needed = (len(part.edges), len(part.circles), len(part.tile_start), len(part.items))
        if any(size > room for size, room in zip(needed, self._room, strict=True)):
            self._allocate(tuple(max(room, 3 * n // 2) for n, room in zip(needed, self._room, strict=True)))
        else:
            self._write(world, part)

    def _allocate(self, room: tuple[int, ...]) -> None:
        """Make room for so many edges, circles, tile starts and items in each world."""
        worlds = len(self._parts)
        edges, circles, starts, items = room
        self._room = (edges, circles, starts, items)
        self.geometry = MapGeometry(
            edges=np.zeros((worlds * edges, 4)),
            circles=np.zeros((worlds * circles, 3)),
            first_tile=np.arange(worlds) * starts,
            tile_origin=np.zeros((worlds, 2)),
            tile_shape=np.ones((worlds, 2), np.int64),
            tile_start=np.zeros(worlds * starts, np.int64),
            items=np.zeros(worlds * items, np.int32),
        )
        for world, part in enumerate(self._parts):
            if part is not None:
                self._write(world, part)

    def _write(self, world: int, part: MapGeometry) -> None:
        edges, circles, starts, items = self._room
        whole = self.geometry
        _put(whole.edges, world * edges, part.edges)
        _put(whole.circles, world * circles, part.circles)
        _put(whole.tile_start, world * starts, part.tile_start + world * items)
        shifted = np.where(
            part.items < len(part.edges),
            part.items + world * edges,
            part.items - len(part.edges) + len(whole.edges) + world * circles,
        )
        _put(whole.items, world * items, shifted)
        whole.tile_origin[world], whole.tile_shape[world] = part.tile_origin[0], part.tile_shape[0]


def _put(whole: NDArray[np.generic], first: int, part: NDArray[np.generic]) -> None:
    whole[first : first + len(part)] = part
