"""The arrays that the kernels of team planning share, grouped by what they are for.

Shapes: n places, k robots, ``times`` steps up to which moves can be reserved.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

NEVER = np.int32(2**30)
"""A time that never comes."""


class GraphArrays(NamedTuple):
    """Where moves lead from every place, and which other places they conflict with.

    Attributes:
        neighbours: (n, 9) the place to which each of ``moves.MOVES`` leads, -1 nowhere.
        padded: (m,) places of the grid with a margin of -1, row after row.
        at: (n,) positions of the places in ``padded``.
        begins: (10,) where each move's entries begin in ``entries``.
        entries: (e, 2) the footprints: offset in ``padded``, and bits of the moves from there that conflict.
    """

    neighbours: NDArray[np.int32]
    padded: NDArray[np.int32]
    at: NDArray[np.int32]
    begins: NDArray[np.int64]
    entries: NDArray[np.int64]


class Reservations(NamedTuple):
    """Which moves from which place at which time would conflict with the paths planned so far.

    Attributes:
        table: (n, times) bit ``m`` says that move ``m`` in the step from ``t`` to ``t + 1`` is taken.
        until: (n,) time from which on no bit of ``table`` is set.
        since: (n, 9) time from which on a move is taken for good, by a robot that rests at its goal.
    """

    table: NDArray[np.uint16]
    until: NDArray[np.int32]
    since: NDArray[np.int32]


class PlaceCosts(NamedTuple):
    """What ways cost, in units of which a step has ``grid_graph.STEP``.

    Attributes:
        ahead: (k, n), or (n,) of one robot: the exact cost of the rest of the way to the goal without other robots.
        base: (n,) surcharge of being in a place for a step.
        layer: (times, n) further surcharge by time; its last row holds for all later times.
    """

    ahead: NDArray[np.int32]
    base: NDArray[np.int32]
    layer: NDArray[np.int32]


class SearchMemory(NamedTuple):
    """What a search in space and time works on; kept between searches, since clearing it would take longer than most.

    Attributes:
        limits: (4,) greatest cost; most states to expand; and, changed by a search, its stamp and the number of states
            that it expanded. Where the greatest cost cut a search off, it comes back with its bits inverted.
        nodes: (n * times, 3) stamp, cost so far and state before.
        keys: (m,) room for the keys of the open list.
        items: (m,) room for the states of the open list.
    """

    limits: NDArray[np.int64]
    nodes: NDArray[np.int32]
    keys: NDArray[np.int64]
    items: NDArray[np.int32]


class TeamPaths(NamedTuple):
    """The robots of a team.

    Attributes:
        ends: (k, 2) start and goal places.
        delays: (k,) steps that each robot waits at its start before it leaves.
        paths: (k, times) places, one a time step, valid up to ``lengths``.
        lengths: (k,) steps until each robot stays at its goal.
        placed: (k,) whose paths are in the reservations.
        kept_paths: (k, times) scratch: paths to go back to.
        kept_lengths: (k,) their lengths.
    """

    ends: NDArray[np.int64]
    delays: NDArray[np.int64]
    paths: NDArray[np.int32]
    lengths: NDArray[np.int64]
    placed: NDArray[np.bool_]
    kept_paths: NDArray[np.int32]
    kept_lengths: NDArray[np.int64]


class TeamTables(NamedTuple):
    """Arrays of a size that is expensive to allocate, for one team at a time.

    Attributes:
        reserved: The reservations, empty when nobody uses them.
        memory: The searches' memory.
    """

    reserved: Reservations
    memory: SearchMemory

    @property
    def times(self) -> int:
        """Steps up to which moves can be reserved."""
        return int(self.reserved.table.shape[1])


def empty_tables(places: int, times: int) -> TeamTables:
    """Tables for a graph of so many places, in which moves can be reserved for so many steps."""
    since = np.full((places, 9), NEVER, np.int32)
    reserved = Reservations(np.zeros((places, times), np.uint16), np.zeros(places, np.int32), since)
    nodes = np.zeros((times * places, 3), np.int32)  # pages that no search touches cost nothing
    room = 4 * times * places + 64
    limits = np.array([2**31 - 1, 2**31 - 1, 0, 0], np.int64)
    return TeamTables(reserved, SearchMemory(limits, nodes, np.empty(room, np.int64), np.empty(room, np.int32)))
