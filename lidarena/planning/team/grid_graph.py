"""Where a robot of a given radius can stand and go on a grid, and how far it is from everywhere to a goal."""

import math
import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.planning.team.moves import MOVES, footprints
from lidarena.planning.team.open_list import pop, push
from lidarena.planning.team.search_arrays import GraphArrays, TeamTables, empty_tables

STEP = np.int64(4096)
"""What a time step costs, in the planners' units: a robot's cost is the number of its steps until it stays at its goal,
waits included. Smaller units only choose between paths of equally many steps: a diagonal costs one unit more than a
straight move, so that paths run straight."""

UNREACHABLE = np.int64(2**30)
_CACHED_BYTES = 24 * 2**20  # of distances kept, per graph
_KEPT_TABLES, _KEPT_TABLE_BYTES = 2, 32 * 2**20
KEPT_GRAPHS, KEPT_BYTES = 16, 64 * 2**20
"""How many graphs are kept for the next call with an equal grid, and how large they may be with what they keep."""


@kernel
def _neighbours(index: NDArray[np.int32], moves: NDArray[np.int64], connectivity: int) -> NDArray[np.int32]:
    """Where each move leads (n, 9) from each place, -1 nowhere; ``index`` is padded. No diagonal cuts a corner."""
    rows, cols = index.shape
    count = 0
    for r in range(rows):
        for c in range(cols):
            count = max(count, index[r, c] + 1)
    table = np.full((count, 9), -1, np.int32)
    for r in range(rows):
        for c in range(cols):
            here = index[r, c]
            if here < 0:
                continue
            for m in range(connectivity + 1):
                y, x = r + moves[m, 0], c + moves[m, 1]
                if index[r, x] >= 0 and index[y, c] >= 0:
                    table[here, m] = index[y, x]
    return table


@leaf
def _flood_straight(
    padded: NDArray[np.int32],
    at: NDArray[np.int32],
    stride: int,
    goal: int,
    ahead: NDArray[np.int32],
    steps: NDArray[np.int32],
    queue: NDArray[np.int32],
    step: int,
) -> None:
    """Breadth-first from ``goal`` with 4 neighbours; ``steps`` and ``queue`` are scratch of ``padded``'s length.

    In the grid itself a neighbour is an addition away, and what is looked at fits into the fastest memory.
    """
    for cell in range(len(padded)):
        steps[cell] = 2**30 if padded[cell] >= 0 else -1
    queue[0] = at[goal]
    steps[at[goal]] = 0
    head, tail = 0, 1
    while head < tail:
        here = queue[head]
        head += 1
        further = steps[here] + 1
        if steps[here + 1] == 2**30:
            steps[here + 1] = further
            queue[tail] = here + 1
            tail += 1
        if steps[here - 1] == 2**30:
            steps[here - 1] = further
            queue[tail] = here - 1
            tail += 1
        if steps[here + stride] == 2**30:
            steps[here + stride] = further
            queue[tail] = here + stride
            tail += 1
        if steps[here - stride] == 2**30:
            steps[here - stride] = further
            queue[tail] = here - stride
            tail += 1
    for place in range(len(at)):
        far = steps[at[place]]
        ahead[place] = far if far == 2**30 else far * step


@leaf
def _flood_all(
    neighbours: NDArray[np.int32], goal: int, ahead: NDArray[np.int32], queue: NDArray[np.int32], step: int
) -> None:
    """Breadth-first from ``goal`` with 8; a place's predecessors are all final before it is taken from the queue."""
    ahead[:] = 2**30
    ahead[goal] = 0
    queue[0] = goal
    head, tail = 0, 1
    while head < tail:
        here = queue[head]
        head += 1
        straight = ahead[here] + step
        for m in range(1, 9):
            there = neighbours[here, m]
            if there < 0:
                continue
            new = straight + (1 if m > 4 else 0)
            if ahead[there] == 2**30:
                queue[tail] = there
                tail += 1
            ahead[there] = min(ahead[there], new)


@kernel
def _flood_costs(
    neighbours: NDArray[np.int32], goal: int, ahead: NDArray[np.int32], surcharge: NDArray[np.int32], step: int
) -> None:
    """Dijkstra backwards from ``goal`` where entering a place costs a surcharge."""
    keys = np.empty(9 * len(ahead) + 1, np.int64)
    items = np.empty(9 * len(ahead) + 1, np.int32)
    ahead[goal] = 0
    size = push(keys, items, np.int64(0), np.int64(0), goal)
    while size > 0:
        spent, here = keys[0], items[0]
        size = pop(keys, items, size)
        if spent > ahead[here]:
            continue
        for m in range(1, 9):
            there = neighbours[here, m]
            new = spent + step + (1 if m > 4 else 0) + surcharge[here]  # walked forwards, ``here`` is entered
            if there >= 0 and new < ahead[there]:
                ahead[there] = new
                size = push(keys, items, size, new, there)


class GridGraph:
    """The places of a grid for robots of one radius; a place is the number of a cell in raster order.

    A cell is a place if a disc on its centre touches no blocked cell and does not reach beyond the grid.

    Args:
        blocked: (rows, cols) bool.
        connectivity: 4 or 8 neighbours.
        radius: Of every robot [cells].
        walls: Least distance from blocked cells [cells]; None = the radius.

    Attributes:
        cells: (n, 2) [row, column] of the places.
        index: (rows, cols) int32, a cell's place, -1 where the robot cannot stand.
        neighbours: (n, 9) int32, the place to which each of ``MOVES`` leads, -1 nowhere.
        padded: ``index`` with a margin of -1, flat, in rows of ``stride``; ``at`` (n,) int32 are the places'
            positions in it.
        begins: Where each move's entries begin in ``entries``, see ``moves.footprints``.
        entries: The footprints.
        arrays: The last four and ``neighbours``, as kernels take them.
        apart: Least distance of two robots [cells].
    """

    def __init__(
        self, blocked: NDArray[np.bool_], connectivity: int, radius: float, walls: float | None = None
    ) -> None:
        self.blocked, self.connectivity, self.radius, self.apart = blocked, connectivity, radius, 2.0 * radius
        standing = ~near_blocked(blocked, radius if walls is None else walls)
        self.cells = np.argwhere(standing)
        self.index: NDArray[np.int32] = np.full(blocked.shape, -1, np.int32)
        self.index[standing] = np.arange(len(self.cells), dtype=np.int32)
        margin = math.ceil(self.apart) + 3
        padded = np.pad(self.index, margin, constant_values=-1)
        self.neighbours: NDArray[np.int32] = _neighbours(np.pad(self.index, 1, constant_values=-1), MOVES, connectivity)
        self.stride = padded.shape[1]
        self.begins, self.entries = footprints(self.apart, connectivity, self.stride)
        self.at = ((self.cells[:, 0] + margin) * self.stride + self.cells[:, 1] + margin).astype(np.int32)
        self.padded = padded.ravel()
        self.arrays = GraphArrays(self.neighbours, self.padded, self.at, self.begins, self.entries)
        self._ahead: dict[int, NDArray[np.int32]] = {}
        self._spare: list[TeamTables] = []

    def __len__(self) -> int:
        """Number of places."""
        return len(self.cells)

    def place(self, cell: NDArray[np.int64]) -> int:
        """The place of a cell [row, column]; -1 where the robot cannot stand."""
        return int(self.index[cell[0], cell[1]])

    def borrow(self, times: int) -> TeamTables:
        """Empty tables for at least ``times`` steps, which nobody else has."""
        try:
            spare = self._spare.pop()
        except IndexError:
            return empty_tables(len(self), times)
        return spare if spare.times >= times else empty_tables(len(self), times)

    def give_back(self, tables: TeamTables) -> None:
        """Keep tables, empty again, for the next team, unless there are enough or a long search made them large."""
        if len(self._spare) < _KEPT_TABLES and _size_of(tables) <= _KEPT_TABLE_BYTES:
            self._spare.append(tables)

    def ahead(self, goal: int) -> NDArray[np.int32]:
        """What the shortest way from every place to ``goal`` costs (n,), in units; ``UNREACHABLE`` without a way.

        The exact heuristic for space-time search: kept for the next call with the same goal, as far as there is room.
        """
        if goal in self._ahead:
            return self._ahead[goal]
        costs: NDArray[np.int32] = self._flooded([goal])[0]
        if (len(self._ahead) + 1) * costs.nbytes > _CACHED_BYTES:
            self._ahead.clear()
        self._ahead[goal] = costs
        return costs

    def ahead_of_all(self, goals: Sequence[int]) -> NDArray[np.int32]:
        """Rows (k, n) of :meth:`ahead`; of more than there is room for none is kept, since few would be found again.

        Args:
            goals: (k,) places.
        """
        if 4 * len(goals) * len(self) > _CACHED_BYTES:
            return self._flooded(goals)
        return np.stack([self.ahead(goal) for goal in goals])

    def _flooded(self, goals: Sequence[int]) -> NDArray[np.int32]:
        rows = np.empty((len(goals), len(self)), np.int32)
        queue, steps = np.empty_like(self.padded), np.empty_like(self.padded)
        for row, goal in zip(rows, goals, strict=True):
            if self.connectivity == 4:
                place = self.padded, self.at, np.int64(self.stride), np.int64(goal)
                _flood_straight(*place, row, steps, queue, STEP)
            else:
                _flood_all(self.neighbours, np.int64(goal), row, queue, STEP)
        return rows

    @property
    def nbytes(self) -> int:
        """Memory that it takes, with the distances and tables that it keeps [bytes]."""
        own = (self.blocked, self.cells, self.index, *self.arrays)
        tables = sum(_size_of(spare) for spare in self._spare)
        return sum(array.nbytes for array in own) + sum(row.nbytes for row in self._ahead.values()) + tables

    def ahead_with(self, goal: int, surcharge: NDArray[np.int32]) -> NDArray[np.int32]:
        """As ``ahead`` where entering a place, or waiting in it, costs ``surcharge`` (n,) units more; not kept."""
        costs = np.full(len(self), UNREACHABLE, np.int32)
        _flood_costs(self.neighbours, np.int64(goal), costs, surcharge, STEP)
        return costs


def _size_of(tables: TeamTables) -> int:
    return sum(array.nbytes for arrays in tables for array in arrays)


class _KeptGraphs:
    """The graphs that were asked for last, as many as there is room for."""

    def __init__(self) -> None:
        self._graphs: OrderedDict[tuple[object, ...], GridGraph] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: tuple[object, ...], make: Callable[[], GridGraph]) -> GridGraph:
        """The graph of a key; those that were not asked for longest make room for it."""
        with self._lock:
            found = self._graphs.pop(key, None)
            if found is None:
                found = make()
            self._graphs[key] = found
            sizes = {other: graph.nbytes for other, graph in self._graphs.items()}
            while len(sizes) > 1 and (len(sizes) > KEPT_GRAPHS or sum(sizes.values()) > KEPT_BYTES):
                oldest, _ = self._graphs.popitem(last=False)
                del sizes[oldest]
            return found

    @property
    def nbytes(self) -> int:
        """Memory that all of them take [bytes]."""
        return sum(graph.nbytes for graph in self._graphs.values())


kept_graphs = _KeptGraphs()


def grid_graph_of(
    blocked: NDArray[np.bool_], connectivity: int, radius: float, walls: float | None = None
) -> GridGraph:
    """The graph of a grid, kept for the next call with an equal grid; arguments as ``GridGraph``'s."""
    key = np.packbits(blocked).tobytes(), blocked.shape, connectivity, radius, walls
    return kept_graphs.get(key, lambda: GridGraph(blocked.astype(np.bool_), connectivity, radius, walls))


def near_blocked(blocked: NDArray[np.bool_], radius: float) -> NDArray[np.bool_]:
    """Cells (rows, cols) whose centre is nearer than ``radius`` to a blocked one (a unit square) or the border."""
    reach = math.ceil(radius + 0.5)
    padded = np.pad(blocked, reach, constant_values=True)
    near = blocked.copy()
    rows, cols = blocked.shape
    for dr in range(-reach, reach + 1):
        for dc in range(-reach, reach + 1):
            if math.hypot(max(abs(dr) - 0.5, 0.0), max(abs(dc) - 0.5, 0.0)) < radius - 1e-9:
                near |= padded[reach + dr : reach + dr + rows, reach + dc : reach + dc + cols]
    return near
