"""The keyframes that are nodes of a graph, in arrays that grow, and how each is tied to one before it."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class NodeColumns(NamedTuple):
    """``N`` nodes.

    Attributes:
        numbers: (N,) of the keyframes, ascending.
        poses: (N, 3) where they are.
        ways: (N,) driven until there [m].
        views: (N, 2) the middle of what each saw, in the laser's frame [m].
        sources: (N,) number of the keyframe from which each is measured; the first node's own number.
        steps: (N, 3) each seen from there.
        information: (N, 3, 3) how surely, in that frame.
    """

    numbers: NDArray[np.int64]
    poses: Floats
    ways: Floats
    views: Floats
    sources: NDArray[np.int64]
    steps: Floats
    information: Floats


class GraphNodes:
    """Nodes in the order of their keyframes.

    Attributes:
        count: How many there are.
    """

    def __init__(self) -> None:
        self.count = 0
        whole = np.zeros(0, np.int64)
        self._columns = NodeColumns(
            whole, np.zeros((0, 3)), np.zeros(0), np.zeros((0, 2)), whole, np.zeros((0, 3)), np.zeros((0, 3, 3))
        )

    @property
    def columns(self) -> NodeColumns:
        """Views of what is known of all nodes; what is written into them stays."""
        known: list[Any] = [each[: self.count] for each in self._columns]
        return NodeColumns(*known)

    def append(self, number: int, pose: Floats, way: float, view: Floats) -> None:
        """Add a node that is measured from nothing yet."""
        if self.count == len(self._columns.numbers):
            room = max(2 * self.count, 256)
            enlarged: list[Any] = [_enlarged(each, room) for each in self._columns]
            self._columns = NodeColumns(*enlarged)
        n, columns = self.count, self._columns
        columns.numbers[n], columns.poses[n], columns.ways[n], columns.views[n] = number, pose, way, view
        columns.sources[n] = number
        self.count += 1

    def tie(self, place: int, source: int, step: Floats, information: Floats) -> None:
        """Measure the node in a place of the order from the keyframe ``source``."""
        columns = self._columns
        columns.sources[place], columns.steps[place], columns.information[place] = source, step, information

    def remove(self, places: list[int]) -> None:
        """Take nodes out of the order."""
        kept = np.ones(self.count, bool)
        kept[places] = False
        for each in self._columns:
            each[: int(kept.sum())] = each[: self.count][kept]
        self.count = int(kept.sum())

    def places(self, numbers: NDArray[np.int64]) -> NDArray[np.int64]:
        """Where keyframes that are nodes stand in the order."""
        return np.searchsorted(self.columns.numbers, numbers)


def _enlarged(column: NDArray[Any], room: int) -> NDArray[Any]:
    """The same column with room for so many."""
    more: NDArray[Any] = np.zeros((room, *column.shape[1:]), column.dtype)
    more[: len(column)] = column
    return more
