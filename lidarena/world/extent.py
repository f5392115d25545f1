"""How large a map may be."""

import math

from lidarena.base.errors import MapError

MIN_RESOLUTION, MAX_RESOLUTION = 0.005, 2.0
"""Sides of a cell that are believed [m]."""
MAX_CELLS = 20_000_000
"""Largest number of cells of a map."""
MAX_DRAWN_CELLS = 400_000_000
"""Largest number of cells of a map that is only written, never driven in."""
MAX_SIDE = 1000.0
"""Longest side of a map [m]."""


def check_resolution(where: str, resolution: float) -> float:
    """Return the side of a cell [m] if it is believable.

    Args:
        where: What the message calls the map, such as ``"map 'office.yaml'"``.
        resolution: Side of a cell [m].

    Raises:
        MapError: It is not a number from 0.005 to 2 m.
    """
    if not (math.isfinite(resolution) and MIN_RESOLUTION <= resolution <= MAX_RESOLUTION):
        raise MapError(
            f"{where} has cells of {resolution:g} m; {MIN_RESOLUTION:g} to {MAX_RESOLUTION:g} m a cell are allowed"
        )
    return resolution


def check_extent(where: str, rows: int, columns: int, resolution: float, most: int = MAX_CELLS) -> None:
    """Refuse a grid too large to be a map for a robot, before memory is spent on it.

    Raises:
        MapError: It is empty, has too many cells or too long a side.
    """
    size = f"{where} has {columns} x {rows} cells of {resolution:g} m"
    if rows < 1 or columns < 1:
        raise MapError(f"{size}; at least one cell is needed")
    if rows * columns > most:
        raise MapError(f"{size}; at most {most // 1_000_000} million cells are allowed, so they must be larger ones")
    if max(rows, columns) * resolution > MAX_SIDE:
        raise MapError(f"{size}; sides of at most {MAX_SIDE:g} m are allowed, so its cells may be smaller")
