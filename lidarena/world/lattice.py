"""Walls on a lattice of corridors: parsed from a text drawing, and merged into long segments."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray


class LatticeWalls(NamedTuple):
    """Which sides of ``rows`` × ``columns`` rectangular cells are walls; row 0 is at the smallest y.

    Attributes:
        horizontal: ``(rows + 1, columns)`` bool; side below (``[row]``) and above (``[row + 1]``) each cell.
        vertical: ``(rows, columns + 1)`` bool; side left (``[column]``) and right (``[column + 1]``) of each cell.
    """

    horizontal: NDArray[np.bool_]
    vertical: NDArray[np.bool_]

    def segments(self, xs: ArrayLike, ys: ArrayLike) -> NDArray[np.float64]:
        """Centre lines of the walls, neighbours in line merged into one.

        Args:
            xs: ``(columns + 1,)`` x of the vertical lattice lines [m].
            ys: ``(rows + 1,)`` y of the horizontal lattice lines [m].

        Returns:
            ``(n, 4)`` as x1, y1, x2, y2 [m].
        """
        x, y = np.asarray(xs, dtype=np.float64), np.asarray(ys, dtype=np.float64)
        lines = [(x[a], y[row], x[b], y[row]) for row, a, b in _runs(self.horizontal)]
        lines += [(x[column], y[a], x[column], y[b]) for column, a, b in _runs(self.vertical.T)]
        return np.array(lines, dtype=np.float64).reshape(-1, 4)


def parse_drawing(lines: Sequence[str]) -> LatticeWalls:
    """Read a drawing such as ``+---+   +``, the top line first, with four characters a column and two lines a row.

    Args:
        lines: ``2 rows + 1`` lines of ``4 columns + 1`` characters: ``+`` vertices, ``---`` and ``|`` walls.

    Raises:
        ValueError: The drawing is ragged or holds another character.
    """
    width = len(lines[0])
    if width % 4 != 1 or len(lines) % 2 != 1 or any(len(line) != width for line in lines):
        raise ValueError("a drawing needs 2 rows + 1 lines of 4 columns + 1 characters")
    canvas = np.array([list(line) for line in lines])[::-1]
    horizontal, vertical = canvas[::2, 2::4], canvas[1::2, ::4]
    if not np.isin(horizontal, ["-", " "]).all() or not np.isin(vertical, ["|", " "]).all():
        raise ValueError("a drawing has '---' or blanks between '+', and '|' or a blank below a '+'")
    return LatticeWalls(horizontal == "-", vertical == "|")


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int, int]]:
    """Runs of True along each row as (row, first, last + 1)."""
    step = np.diff(np.pad(mask, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    rows, firsts = np.nonzero(step == 1)
    _, lasts = np.nonzero(step == -1)
    return [(int(row), int(a), int(b)) for row, a, b in zip(rows, firsts, lasts, strict=True)]
