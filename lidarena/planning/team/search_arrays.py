"""The arrays that the kernels of team planning share, grouped by what they are for.

Shapes: n places, k robots, ``times`` steps up to which moves can be reserved.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf

NEVER = np.int32(2**30)
"""A time that never comes."""


class GraphArrays(NamedTuple):
    """Where moves lead from every place, and which other places they conflict with.

    Attributes:
        neighbours: (n, 9) the place to which each of ``moves.MOVES`` leads, -1 nowhere.
        padded: (m,) places of the grid with a margin of -1, row after row.
        at: (n,) positions of the places in ``padded``.
        begins: (10,) where each move's entries begin in ``entries``.
        entries: (e, 3) the footprints: offset in ``padded``, bits of the moves from there that conflict, and those
            moves' ones as ``Reservations`` counts them.
    """

    neighbours: NDArray[np.int32]
    padded: NDArray[np.int32]
    at: NDArray[np.int32]
    begins: NDArray[np.int64]
    entries: NDArray[np.int64]


SPAN = 16
"""Steps that a row of ``Reservations.counts`` holds."""


class Reservations(NamedTuple):
    """Which moves from which place at which time would conflict with the paths planned so far.

    Only places that somebody comes close to get rows, and only for the times when somebody does. Robots are counted, so
    that one can be taken out without the others being entered again.

    Attributes:
        rows: (n, times / SPAN) int32 the row of ``counts`` for a place during a span of steps; 0 = nobody comes close.
        counts: (m, SPAN) int64 four bits for each move: how many robots it conflicts with in a step. Row 0 is empty.
        owners: (m,) int64 position in ``rows``, flattened, of the entry that leads to a row.
        used: (1,) int64 rows of ``counts`` that are taken.
        until: (n,) time from which on nobody comes close; later than need be once robots have been taken out.
        since: (n, 9) time from which on a move is taken for good, by a robot that rests at its goal.
    """

    rows: NDArray[np.int32]
    counts: NDArray[np.int64]
    owners: NDArray[np.int64]
    used: NDArray[np.int64]
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
        limits: (6,) greatest cost; most states to expand; and, changed by a search, its stamp, the number of states
            that it expanded and of those it met; what there was no room for, see ``NO_STATES`` and ``NO_ROWS``. Where
            the greatest cost cut a search off, it comes back with its bits inverted.
        nodes: (s, 5) hash table: state (place * times + time), stamp, cost so far, entry of the state before, rank of
            what was put off. Entries with an older stamp than the search's are free.
        keys: (m,) room for the keys of the open list.
        items: (m,) room for the entries of the open list's states.
    """

    limits: NDArray[np.int64]
    nodes: NDArray[np.int64]
    keys: NDArray[np.int64]
    items: NDArray[np.int32]


NO_STATES, NO_ROWS = 1, 2
"""A search met more states, or paths need more rows of reservations, than there is room for."""


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
        return int(self.reserved.rows.shape[1]) * SPAN


_FIRST_STATES, _MOST_STATES = 2**16, 2**23
_FIRST_ROWS = 2**12


def empty_tables(places: int, times: int) -> TeamTables:
    """Tables for a graph of so many places, in which moves can be reserved for so many steps."""
    since = np.full((places, 9), NEVER, np.int32)
    rows = np.zeros((places, -(-times // SPAN)), np.int32)  # pages that nobody comes to cost nothing
    counts, owners = np.zeros((_FIRST_ROWS, SPAN), np.int64), np.zeros(_FIRST_ROWS, np.int64)
    until, used = np.zeros(places, np.int32), np.ones(1, np.int64)
    reserved = Reservations(rows, counts, owners, used, until, since)
    wanted = max(2 * places * times, 64)
    return TeamTables(reserved, _empty_memory(min(1 << (wanted - 1).bit_length(), _FIRST_STATES)))


def _empty_memory(states: int) -> SearchMemory:
    limits = np.array([2**31 - 1, 2**31 - 1, 0, 0, 0, 0], np.int64)
    room = 2 * states
    return SearchMemory(limits, np.zeros((states, 5), np.int64), np.empty(room, np.int64), np.empty(room, np.int32))


def with_more_room(tables: TeamTables) -> TeamTables | None:
    """The same tables with more of what a search had no room for; None if nothing was lacking or at the limit."""
    reserved, memory = tables
    lacking = int(memory.limits[5])
    if lacking == NO_ROWS:
        more = len(reserved.counts)
        counts = np.concatenate([reserved.counts, np.zeros((more, SPAN), np.int64)])
        owners = np.concatenate([reserved.owners, np.zeros(more, np.int64)])
        reserved = reserved._replace(counts=counts, owners=owners)
        memory.limits[5] = 0
    elif lacking == NO_STATES and len(memory.nodes) < _MOST_STATES:
        limits = memory.limits[:2].copy()
        memory = _empty_memory(4 * len(memory.nodes))
        memory.limits[:2] = limits
    else:
        memory.limits[5] = 0
        return None
    return TeamTables(reserved, memory)


@inlined
def counts_at(reserved: Reservations, place: int, t: int) -> int:
    """How many robots each move from a place would conflict with in the step from ``t`` on, four bits a move."""
    return int(reserved.counts[reserved.rows[place, t >> 4], t & 15])


@leaf
def entry_of(nodes: NDArray[np.int64], state: int, stamp: int) -> int:
    """The entry of a state in the hash table of a search, or the free one where it belongs."""
    mask = len(nodes) - 1
    entry = (np.int64(state) * np.int64(0x9E3779B97F4A7C1) >> 20) & mask
    while nodes[entry, 1] >= stamp and nodes[entry, 0] != state:
        entry = (entry + 1) & mask
    return int(entry)
