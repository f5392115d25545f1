"""Generated mazes: a random spanning tree of corridors, opened by loops and with some of its dead ends removed."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.lattice import LatticeWalls

MIN_CORRIDOR, MAX_CORRIDOR = 0.8, 5.0
"""Clear widths of a corridor that are allowed [m]."""
MIN_THICKNESS, MAX_THICKNESS = 0.05, 0.5
"""Thicknesses of a wall that are allowed [m]."""
MAX_MAZE_SIDE = 100.0
"""Longest side of a maze [m]."""

_Cell = tuple[int, int]
_NEIGHBOURS = ((0, 1), (1, 0), (0, -1), (-1, 0))  # east, north, west, south; as (row, column)


def generate_maze(
    seed: int,
    width_m: float = 8.0,
    height_m: float = 6.0,
    corridor: float = 1.0,
    loops: float = 0.1,
    dead_ends: float = 0.5,
    thickness: float = 0.1,
    name: str | None = None,
) -> Floorplan:
    """Generate a maze; the same arguments give the same maze.

    As many corridors as fit side by side share the outer size evenly, so their clear width (from wall face to wall
    face) is at least ``corridor``. Every place can be reached from every other.

    Args:
        seed: Of everything random here, zero or more.
        width_m: Outer size along x [m], walls included.
        height_m: Outer size along y [m], walls included.
        corridor: Least clear width of a corridor [m].
        loops: Fraction of the spanning tree's inner walls that are opened, 0 to 1.
        dead_ends: Fraction of the remaining dead ends that are kept, 0 to 1.
        thickness: Of the walls [m].
        name: What messages call the plan; None takes ``"maze:SEED"``.

    Returns:
        A plan with its lower-left outer corner at (0, 0); it starts in the middle of a random place, facing an opening.

    Raises:
        MapError: A value is out of range, or fewer than two corridors fit in either direction.
    """
    _check(seed, width_m, height_m, corridor, loops, dead_ends, thickness)
    columns = _corridors(width_m, corridor, thickness)
    rows = _corridors(height_m, corridor, thickness)
    if columns < 2 or rows < 2:
        least = 2 * corridor + 3 * thickness
        raise MapError(
            f"a maze of {width_m:g} m x {height_m:g} m with corridors of {corridor:g} m is too small; "
            f"at least {least:g} m x {least:g} m are needed"
        )
    rng = np.random.default_rng(seed)
    walls = _spanning_tree(rows, columns, rng)
    _open_loops(walls, loops, rng)
    _open_dead_ends(walls, dead_ends, rng)
    xs = np.linspace(thickness / 2, width_m - thickness / 2, columns + 1)
    ys = np.linspace(thickness / 2, height_m - thickness / 2, rows + 1)
    start = _start(walls, xs, ys, rng)
    bounds = (0.0, 0.0, width_m, height_m)
    segments = walls.segments(xs, ys)
    return Floorplan.from_shapes(name or f"maze:{seed}", bounds, segments, thickness=thickness, start=start)


def _corridors(side: float, corridor: float, thickness: float) -> int:
    return math.floor((side - thickness) / (corridor + thickness) + 1e-9)


def _check(
    seed: int, width: float, height: float, corridor: float, loops: float, dead_ends: float, thickness: float
) -> None:
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or not 0 <= seed < 2**63:
        raise MapError(f"a maze has seed {seed!r}; a whole number from 0 to 2^63 - 1 is needed")
    ranges = (
        ("width", width, 0.0, MAX_MAZE_SIDE, " m"),
        ("height", height, 0.0, MAX_MAZE_SIDE, " m"),
        ("corridor", corridor, MIN_CORRIDOR, MAX_CORRIDOR, " m"),
        ("loops", loops, 0.0, 1.0, ""),
        ("dead_ends", dead_ends, 0.0, 1.0, ""),
        ("thickness", thickness, MIN_THICKNESS, MAX_THICKNESS, " m"),
    )
    for what, value, low, high, unit in ranges:
        if not low <= value <= high:  # also refuses NaN
            raise MapError(f"a maze has {what} {value:g}{unit}; {low:g} to {high:g}{unit} are allowed")


def _side(walls: LatticeWalls, cell: _Cell, step: _Cell) -> tuple[NDArray[np.bool_], _Cell]:
    """The array and index of the wall that is crossed by a step from a cell."""
    row, column = cell
    if step[0]:
        return walls.horizontal, (row + (step[0] > 0), column)
    return walls.vertical, (row, column + (step[1] > 0))


def _inner_steps(walls: LatticeWalls, cell: _Cell) -> list[_Cell]:
    """The steps from a cell that stay inside the maze."""
    rows, columns = walls.vertical.shape[0], walls.horizontal.shape[1]
    return [(dr, dc) for dr, dc in _NEIGHBOURS if 0 <= cell[0] + dr < rows and 0 <= cell[1] + dc < columns]


def _is_wall(walls: LatticeWalls, cell: _Cell, step: _Cell) -> bool:
    sides, index = _side(walls, cell, step)
    return bool(sides[index])


def _open(walls: LatticeWalls, cell: _Cell, step: _Cell) -> None:
    sides, index = _side(walls, cell, step)
    sides[index] = False


def _spanning_tree(rows: int, columns: int, rng: np.random.Generator) -> LatticeWalls:
    """Carve a spanning tree by a randomised depth-first search, which makes long winding corridors."""
    walls = LatticeWalls(np.ones((rows + 1, columns), dtype=np.bool_), np.ones((rows, columns + 1), dtype=np.bool_))
    seen = np.zeros((rows, columns), dtype=np.bool_)
    path = [(int(rng.integers(rows)), int(rng.integers(columns)))]
    seen[path[0]] = True
    while path:
        cell = path[-1]
        steps = [s for s in _inner_steps(walls, cell) if not seen[cell[0] + s[0], cell[1] + s[1]]]
        if not steps:
            path.pop()
            continue
        step = steps[int(rng.integers(len(steps)))]
        _open(walls, cell, step)
        path.append((cell[0] + step[0], cell[1] + step[1]))
        seen[path[-1]] = True
    return walls


def _open_loops(walls: LatticeWalls, fraction: float, rng: np.random.Generator) -> None:
    rows, columns = walls.vertical.shape[0], walls.horizontal.shape[1]
    cells = [(row, column) for row in range(rows) for column in range(columns)]
    forward = _NEIGHBOURS[:2]  # east and north only, so that each inner wall is met once
    inner = [
        (cell, step)
        for cell in cells
        for step in _inner_steps(walls, cell)
        if step in forward and _is_wall(walls, cell, step)
    ]
    for index in rng.permutation(len(inner))[: round(fraction * len(inner))]:
        _open(walls, *inner[int(index)])


def _dead_ends(walls: LatticeWalls) -> list[_Cell]:
    closed = walls.horizontal[1:].astype(int) + walls.horizontal[:-1] + walls.vertical[:, 1:] + walls.vertical[:, :-1]
    return [(int(row), int(column)) for row, column in np.argwhere(closed == 3)]


def _open_dead_ends(walls: LatticeWalls, keep: float, rng: np.random.Generator) -> None:
    """Open dead ends, two against each other where that fits, until the fraction ``keep`` of them is left."""
    found = _dead_ends(walls)
    wanted = round(keep * len(found))
    for index in rng.permutation(len(found)):
        cell, still = found[int(index)], set(_dead_ends(walls))
        if len(still) <= wanted:
            return
        if cell not in still:  # opened from its neighbour before
            continue
        steps = [step for step in _inner_steps(walls, cell) if _is_wall(walls, cell, step)]
        if len(still) >= wanted + 2:
            steps = [s for s in steps if (cell[0] + s[0], cell[1] + s[1]) in still] or steps
        _open(walls, cell, steps[int(rng.integers(len(steps)))])


def _start(walls: LatticeWalls, xs: NDArray[np.float64], ys: NDArray[np.float64], rng: np.random.Generator) -> Pose:
    row, column = int(rng.integers(len(ys) - 1)), int(rng.integers(len(xs) - 1))
    steps = [step for step in _inner_steps(walls, (row, column)) if not _is_wall(walls, (row, column), step)]
    up, right = steps[int(rng.integers(len(steps)))]
    x, y = (xs[column] + xs[column + 1]) / 2, (ys[row] + ys[row + 1]) / 2
    return (float(x), float(y), math.atan2(up, right))
