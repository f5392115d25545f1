"""Larger grids for filters that are at work: a recorded log does not tell beforehand how far it goes."""

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.rbpf.likelihood_field import TILE, Fields, empty_fields, tiles_in_use
from lidarena.slam.rbpf.particle_filter import ParticleFilters


def enlarged(filters: ParticleFilters, below: int, left: int, above: int, right: int) -> ParticleFilters:
    """The same filters in a grid with more tiles on each side; nothing that they know changes.

    No wall may lie in the outermost cell of the old grid, whose repetition in the rim of a new tile would be missing.

    Args:
        filters: They are not to be used any more.
        below: Tiles (of ``TILE`` × ``TILE`` cells) that are added at the smallest y.
        left: At the smallest x.
        above: At the largest y.
        right: At the largest x.
    """
    old = filters.maps
    padding = ((0, 0), (below * TILE, above * TILE), (left * TILE, right * TILE))
    wanted = np.pad(old.wanted, padding)
    worlds, particles = filters.state.particles.shape[:2]
    new = ParticleFilters(worlds, wanted, filters.directions, filters.max_range, filters.resolution, filters.parameters)
    fields = empty_fields(worlds, particles, *wanted.shape[1:])
    _fill(fields, filters.state.fields, below, left)
    new.state = filters.state._replace(fields=fields)
    new.maps = old._replace(
        visits=np.pad(old.visits, padding),
        hits=np.pad(old.hits, padding),
        occupancy=np.pad(old.occupancy, padding, constant_values=-1),
        wanted=wanted,
        origin=old.origin - filters.resolution * TILE * np.array([left, below]),
    )
    return new


def _fill(new: Fields, old: Fields, below: int, left: int) -> None:
    """Move old fields into new, larger, empty ones."""
    rows, columns = old.table.shape[2:]
    used, capacity = tiles_in_use(old), old.references.shape[1]
    new.tiles[:, :used] = old.tiles[:, :used]
    new.table[:, :, below : below + rows, left : left + columns] = old.table
    new.references[:, :capacity] = old.references
    added = np.arange(new.references.shape[1] - 1, capacity - 1, -1)  # under the old stack: low tiles first
    new.free[:, : len(added)] = added
    new.free[:, len(added) : len(added) + old.free.shape[1]] = old.free
    new.free_count[:] = old.free_count + len(added)


def tiles_missing(
    origin: NDArray[np.float64],
    shape: tuple[int, ...],
    resolution: float,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
) -> tuple[int, int, int, int]:
    """How many tiles a grid lacks below, left, above and right to reach from ``low`` (2,) to ``high`` (2,) [m].

    Args:
        origin: (2,) the grid's lower-left corner [m].
        shape: Its rows and columns.
        resolution: [m].
        low: x and y that it should begin with.
        high: x and y that it should reach.
    """
    side = TILE * resolution
    end = origin + resolution * np.array([shape[1], shape[0]])
    left, below = (max(0, int(np.ceil(gap / side))) for gap in origin - low)
    right, above = (max(0, int(np.ceil(gap / side))) for gap in high - end)
    return below, left, above, right
