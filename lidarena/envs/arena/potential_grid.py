"""What a potential field makes of an arena: its potential on a grid, its minima, and the plan that it leads to."""

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.potential_field.field_parameters import FieldWarning
from lidarena.planning.potential_field.potential_field import PathResult, PotentialField, plan_path
from lidarena.world.arenas import Arena

_CELLS = 240
"""Cells of the longer side."""
_SETTLING_STEPS = 60
"""Steps down the field after which a minimum of the grid must still be where it was, to be one of the field."""


@dataclass(frozen=True)
class PotentialGrid:
    """A potential field over an arena.

    Attributes:
        field: The potential, with the fills that the plan took.
        plan: The plan.
        potential: (rows, columns) in the middle of each cell, row 0 at the smallest y; inf inside of obstacles.
        origin: (2,) lower-left corner of the grid [m].
        cell: Side of a cell [m].
        minima: (n, 2) local minima beside the goal [m].
    """

    field: PotentialField
    plan: PathResult
    potential: NDArray[np.float64]
    origin: NDArray[np.float64]
    cell: float
    minima: NDArray[np.float64]


def survey(arena: Arena, preset: str) -> PotentialGrid:
    """Plan in an arena with a preset of ``planning.potential_field``, and look at the field around.

    Only the way from the start is tried (``ways=1``): one that was found from the goal belongs to another field.
    """
    scene = (arena.circles, arena.start, arena.goal)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FieldWarning)  # a minimum beside the goal is what the picture shows
        plan = plan_path(*scene, preset, arena.robot_radius, arena.bounds, ways=1)
    field = PotentialField.after(plan, *scene, arena.robot_radius, arena.bounds)
    low, high = np.array(arena.bounds[:2]), np.array(arena.bounds[2:])
    cell = float((high - low).max()) / _CELLS
    columns, rows = np.ceil((high - low) / cell).astype(int)
    x, y = (low[axis] + (np.arange(count) + 0.5) * cell for axis, count in ((0, columns), (1, rows)))
    potential = field.potential(np.stack(np.meshgrid(x, y), axis=-1))
    minima = _minima(field, potential, low, cell, np.array(arena.goal))
    return PotentialGrid(field, plan, potential, low, cell, minima)


def _minima(
    field: PotentialField,
    potential: NDArray[np.float64],
    low: NDArray[np.float64],
    cell: float,
    goal: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Local minima (n, 2) beside the goal; those that a walk down the field leaves are the grid's alone."""
    inner = potential[1:-1, 1:-1]
    lowest = np.isfinite(inner)
    for r in range(3):
        for c in range(3):
            beside = potential[r : r + inner.shape[0], c : c + inner.shape[1]]
            if (r, c) < (1, 1):
                lowest &= inner < beside
            elif (r, c) > (1, 1):
                lowest &= inner <= beside  # of two cells that are level one is the minimum
    points: NDArray[np.float64] = low + (np.argwhere(lowest)[:, ::-1] + 1.5) * cell
    settled = points.copy()
    for _ in range(_SETTLING_STEPS):
        force = field.force(settled)
        settled += 0.1 * cell * force / np.maximum(np.hypot(force[:, 0], force[:, 1]), 1e-12)[:, None]
    stays = np.hypot(*(settled - points).T) < 2.0 * cell
    own: NDArray[np.float64] = points[stays & (np.hypot(*(points - goal).T) > 3.0 * cell)]
    return own
