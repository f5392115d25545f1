"""Grid maps of the MovingAI benchmarks (Sturtevant 2012), as boolean grids and as floor plans."""

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.extent import check_extent, check_resolution
from lidarena.world.floorplan import Floorplan, Pose

PASSABLE = ".GS"
"""Ground and swamp."""
BLOCKED = "@OTW"
"""Out of bounds, trees, and water, which cannot be entered from ground."""


def load_movingai(path: str | os.PathLike[str]) -> NDArray[np.bool_]:
    """Read an octile ``.map`` file.

    Returns:
        Passable cells ``[row, column]`` with row 0 at the smallest y: the file's *last* line (scenario files count
        their rows from the top, so their y is ``rows - 1 - row``).

    Raises:
        MapError: The file is missing, torn, too large or holds an unknown character.
    """
    file = Path(path)
    where = f"map {str(file)!r}"
    try:
        lines = file.read_text(encoding="ascii").splitlines()
    except OSError as error:
        raise MapError(f"{where} cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise MapError(f"{where} is not a MovingAI map: it holds a byte that is not ASCII text") from error
    height, width = _read_header(lines, where)
    check_extent(where, height, width, 0.0)
    return _read_rows(lines[4:], height, width, where)


def movingai_floorplan(
    path: str | os.PathLike[str], cell: float = 1.0, name: str | None = None, start: Pose | None = None
) -> Floorplan:
    """Read an octile ``.map`` file as a floor plan whose lower-left corner is at (0, 0).

    Args:
        path: The file.
        cell: Side of a cell [m]; the default leaves one-cell corridors wide enough for a TurtleBot.
        name: What messages call the plan; None takes the file's name without its ending.
        start: Start pose; None takes the roomiest place of the largest connected part.

    Raises:
        MapError: As ``load_movingai``; or the cell is out of range, or no cell is passable.
    """
    where = f"map {os.fspath(path)!r}"
    free = load_movingai(path)
    check_extent(where, free.shape[0], free.shape[1], check_resolution(where, cell))
    return Floorplan.from_grid(name or Path(path).stem, ~free, cell, start=start)


def _read_header(lines: list[str], where: str) -> tuple[int, int]:
    """Height and width from the four header lines; the benchmarks have both orders of the two."""
    fields = dict(line.split(maxsplit=1) for line in lines[:3] if len(line.split()) == 2)
    if "type" not in fields or len(lines) < 4 or lines[3].strip() != "map":
        raise MapError(f"{where} is not a MovingAI map: its header must be 'type', 'height', 'width' and 'map'")
    sizes = []
    for key in ("height", "width"):
        text = fields.get(key, "").strip()
        if not (text.isdecimal() and len(text) < 10 and int(text) > 0):
            raise MapError(f"{where} has {key} {text!r} in its header; a positive whole number is needed")
        sizes.append(int(text))
    return sizes[0], sizes[1]


def _read_rows(rows: list[str], height: int, width: int, where: str) -> NDArray[np.bool_]:
    rows = [row.rstrip() for row in rows]
    while rows and not rows[-1]:
        rows.pop()
    if len(rows) != height:
        raise MapError(f"{where} has {len(rows)} rows of cells; its header says {height}")
    for number, row in enumerate(rows):
        if len(row) != width:
            raise MapError(f"{where} has {len(row)} cells in row {number}; its header says {width}")
    cells = np.frombuffer("".join(rows).encode(), dtype="S1").reshape(height, width)
    free = np.isin(cells, [character.encode() for character in PASSABLE])
    unknown = ~free & ~np.isin(cells, [character.encode() for character in BLOCKED])
    if unknown.any():
        top, left = np.argwhere(unknown)[0]
        raise MapError(
            f"{where} has {rows[top][left]!r} in row {top}, column {left}; {' '.join(PASSABLE + BLOCKED)} are allowed"
        )
    return free[::-1].copy()
