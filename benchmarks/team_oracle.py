"""Whether a small problem for a team has a plan at all: told without a search over all arrangements of the robots.

Which cells are taken is searched breadth first (of 9 robots on 16 cells there are 11,440 such sets, but 4 thousand
million arrangements). Every step that comes back to a set tells a permutation of the robots that can be had; a plan
exists exactly if the permutation that is asked for is among their products (as Kornhauser, Miller & Spirakis 1984
decide pebble motion). Steps of one robot and of rings of robots are enough: of a step of several, one after the other
can go, unless they follow each other in a ring.
"""

from collections.abc import Iterator
from functools import cache

import numpy as np
from numpy.typing import NDArray

Cell = tuple[int, int]
Step = dict[Cell, Cell]

_MOVES = ((0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, -1), (-1, 1))


@cache
def _meet(row: int, col: int, rows: int, cols: int, apart: float) -> bool:
    """Whether robots come nearer than ``apart``, one seen from the other: where, and how that changes in the step."""
    square = rows * rows + cols * cols
    when = min(max(-(row * rows + col * cols) / square, 0.0), 1.0) if square else 0.0
    return float(np.hypot(row + when * rows, col + when * cols)) < max(apart - 1e-6, 1e-6)


def _is_free(step: Step, taken: frozenset[Cell], apart: float) -> bool:
    """Whether robots that move (from cell to cell) hit neither each other nor one that stays."""
    moves = list(step.items())
    for i, (a, c) in enumerate(moves):
        for b, d in [*moves[i + 1 :], *((cell, cell) for cell in taken if cell not in step)]:
            rows, cols = d[0] - c[0] - (b[0] - a[0]), d[1] - c[1] - (b[1] - a[1])
            if _meet(b[0] - a[0], b[1] - a[1], rows, cols, apart):
                return False
    return True


def _rings(taken: frozenset[Cell], ways: dict[Cell, list[Cell]]) -> Iterator[list[Cell]]:
    """Directed rings of three or more taken cells, each of which leads to the next."""

    def longer(ring: list[Cell]) -> Iterator[list[Cell]]:
        for there in ways[ring[-1]]:
            if there == ring[0] and len(ring) > 2:
                yield ring
            elif there in taken and there > ring[0] and there not in ring:
                yield from longer([*ring, there])

    for cell in taken:
        yield from longer([cell])


def _steps(taken: frozenset[Cell], ways: dict[Cell, list[Cell]], apart: float) -> Iterator[Step]:
    """The steps of one robot and of rings that hit nobody."""
    for cell in taken:
        for there in ways[cell]:
            if there not in taken and _is_free({cell: there}, taken, apart):
                yield {cell: there}
    for ring in _rings(taken, ways):
        step = dict(zip(ring, [*ring[1:], ring[0]], strict=True))
        if _is_free(step, taken, apart):
            yield step


def _products(generators: set[tuple[int, ...]], robots: int) -> set[tuple[int, ...]]:
    """All permutations that come of some."""
    found = {tuple(range(robots))}
    used: list[tuple[int, ...]] = []
    for generator in generators:
        if generator in found:
            continue
        used.append(generator)
        waiting = list(found)
        while waiting:
            one = waiting.pop()
            for other in used:
                product = tuple(other[i] for i in one)
                if product not in found:
                    found.add(product)
                    waiting.append(product)
    return found


def is_solvable(
    blocked: NDArray[np.bool_], starts: NDArray[np.int64], goals: NDArray[np.int64], connectivity: int, radius: float
) -> bool:
    """Whether a team has any plan; for up to some 9 robots on 16 cells."""
    free = {(int(r), int(c)) for r, c in np.argwhere(~blocked)}
    ways: dict[Cell, list[Cell]] = {
        (r, c): [
            (r + y, c + x)
            for y, x in _MOVES[:connectivity]
            if {(r + y, c + x), (r + y, c), (r, c + x)} <= free
        ]
        for r, c in free
    }  # fmt: skip
    first = {(int(r), int(c)): robot for robot, (r, c) in enumerate(starts)}
    wanted = {(int(r), int(c)): robot for robot, (r, c) in enumerate(goals)}
    known, waiting = {frozenset(first): first}, [frozenset(first)]
    generators: set[tuple[int, ...]] = set()
    for taken in waiting:
        for step in _steps(taken, ways, 2.0 * radius):
            there = {step.get(cell, cell): robot for cell, robot in known[taken].items()}
            cells = frozenset(there)
            if cells not in known:
                known[cells] = there
                waiting.append(cells)
                continue
            generators.add(_permutation(known[cells], there))
    final = frozenset(wanted)
    return final in known and _permutation(known[final], wanted) in _products(generators, len(starts))


def _permutation(before: dict[Cell, int], after: dict[Cell, int]) -> tuple[int, ...]:
    """Which robot of ``after`` stands where each robot of ``before`` does."""
    table = {robot: after[cell] for cell, robot in before.items()}
    return tuple(table[robot] for robot in range(len(table)))
