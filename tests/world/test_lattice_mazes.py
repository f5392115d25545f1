"""Mazes before they are drawn: spanning trees, loops, dead ends, and walls as segments and back."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.world.lattice import LatticeWalls, parse_drawing
from lidarena.world.maze import _dead_ends, _is_wall, _open_dead_ends, _open_loops, _spanning_tree

SIDE, SEED, SHARE = st.integers(2, 9), st.integers(0, 10**6), st.floats(0.0, 1.0)
STEPS = ((0, 1), (1, 0), (0, -1), (-1, 0))


def tree(rows: int, columns: int, seed: int) -> tuple[LatticeWalls, np.random.Generator]:
    rng = np.random.default_rng(seed)
    return _spanning_tree(rows, columns, rng), rng


def openings(walls: LatticeWalls) -> int:
    return int((~walls.horizontal[1:-1]).sum() + (~walls.vertical[:, 1:-1]).sum())


def reached(walls: LatticeWalls) -> set[tuple[int, int]]:
    """The cells that can be reached from the first one, by looking at every wall on the way."""
    rows, columns = walls.vertical.shape[0], walls.horizontal.shape[1]
    seen, todo = {(0, 0)}, [(0, 0)]
    while todo:
        row, column = todo.pop()
        sides = (walls.vertical[row, column + 1], walls.horizontal[row + 1, column])
        sides += (walls.vertical[row, column], walls.horizontal[row, column])
        for (dr, dc), closed in zip(STEPS, sides, strict=True):
            there = (row + dr, column + dc)
            assert _is_wall(walls, (row, column), (dr, dc)) == closed
            if not closed and there not in seen:
                assert 0 <= there[0] < rows and 0 <= there[1] < columns  # nobody gets out
                seen.add(there)
                todo.append(there)
    return seen


@settings(max_examples=40, deadline=None)
@given(SIDE, SIDE, SEED)
def test_a_spanning_tree_reaches_every_cell_without_a_loop(rows: int, columns: int, seed: int) -> None:
    walls, _ = tree(rows, columns, seed)
    assert len(reached(walls)) == rows * columns
    assert openings(walls) == rows * columns - 1


@settings(max_examples=40, deadline=None)
@given(SIDE, SIDE, SEED, SHARE)
def test_as_many_walls_are_opened_as_were_asked_for(rows: int, columns: int, seed: int, share: float) -> None:
    walls, rng = tree(rows, columns, seed)
    inner = rows * (columns - 1) + columns * (rows - 1)
    before = openings(walls)
    _open_loops(walls, share, rng)
    assert openings(walls) == before + round(share * (inner - before))
    assert walls.horizontal[[0, -1]].all() and walls.vertical[:, [0, -1]].all()
    assert len(reached(walls)) == rows * columns


@settings(max_examples=40, deadline=None)
@given(SIDE, SIDE, SEED, SHARE)
def test_dead_ends_have_three_walls_and_are_opened_down_to_the_share(
    rows: int, columns: int, seed: int, keep: float
) -> None:
    walls, rng = tree(rows, columns, seed)
    found = _dead_ends(walls)
    for row in range(rows):
        for column in range(columns):
            closed = sum(_is_wall(walls, (row, column), step) for step in STEPS)
            assert ((row, column) in found) == (closed == 3)
    _open_dead_ends(walls, keep, rng)
    wanted = round(keep * len(found))
    assert wanted - 1 <= len(_dead_ends(walls)) <= max(wanted, 0)
    assert len(reached(walls)) == rows * columns


def sides_of(segments: np.ndarray) -> set[tuple[str, int, int]]:
    """The sides of unit cells that segments cover."""
    found = set()
    for x1, y1, x2, y2 in segments.astype(int):
        assert x1 == x2 or y1 == y2
        found |= {("-", y1, x) for x in range(min(x1, x2), max(x1, x2)) if y1 == y2}
        found |= {("|", y, x1) for y in range(min(y1, y2), max(y1, y2)) if x1 == x2}
    return found


@settings(max_examples=60, deadline=None)
@given(SIDE, SIDE, SEED)
def test_segments_cover_the_walls_once_and_nothing_else(rows: int, columns: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    walls = LatticeWalls(rng.random((rows + 1, columns)) < 0.5, rng.random((rows, columns + 1)) < 0.5)
    segments = walls.segments(np.arange(columns + 1), np.arange(rows + 1))
    expected = {("-", int(r), int(c)) for r, c in np.argwhere(walls.horizontal)}
    expected |= {("|", int(r), int(c)) for r, c in np.argwhere(walls.vertical)}
    assert sides_of(segments) == expected
    assert np.abs(segments[:, 2:] - segments[:, :2]).sum() == len(expected)  # no side twice


@settings(max_examples=60, deadline=None)
@given(SIDE, SIDE, SEED)
def test_a_drawing_of_any_walls_is_read_back(rows: int, columns: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    walls = LatticeWalls(rng.random((rows + 1, columns)) < 0.5, rng.random((rows, columns + 1)) < 0.5)
    lines = []
    for row in range(rows + 1):
        lines.append("+" + "+".join("---" if closed else "   " for closed in walls.horizontal[row]) + "+")
        if row < rows:
            lines.append("   ".join("|" if closed else " " for closed in walls.vertical[row]))
    again = parse_drawing(lines[::-1])
    assert np.array_equal(again.horizontal, walls.horizontal) and np.array_equal(again.vertical, walls.vertical)
