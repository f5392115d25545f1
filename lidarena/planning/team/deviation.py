"""What it costs to be where another robot may deviate to: Bennewitz & Burgard's look-up tables P_t.

Section 2, C_t^k(x, y) = P(occ_xy) + sum over i < k of P_t^i(x, y): robots deviate from their paths, and P_t^i is
the probability that robot i is in a place at time t. The probability falls with the distance from where it is
planned to be; Bennewitz & Burgard learn a histogram of distances and approximate it by linear pieces.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import TeamError
from lidarena.base.jit import leaf
from lidarena.planning.team.grid_graph import STEP
from lidarena.planning.team.traffic import Traffic


@leaf
def _add_along(
    path: NDArray[np.int32],
    length: int,
    padded: NDArray[np.int32],
    at: NDArray[np.int32],
    offsets: NDArray[np.int64],
    stride: int,
    layer: NDArray[np.int32],
) -> None:
    """Add to ``layer`` (times, n) what ``offsets`` (m, 3: row, column, units) cost around a path at every time."""
    lines = len(padded) // stride
    for t in range(len(layer)):
        centre = np.int64(at[path[min(t, length)]])
        row, col = centre // stride, centre % stride
        for o in range(len(offsets)):
            r, c = row + offsets[o, 0], col + offsets[o, 1]
            if r >= 0 and c >= 0 and r < lines and c < stride:
                place = padded[r * stride + c]
                if place >= 0:
                    layer[t, place] += offsets[o, 2]


class DeviationCosts:
    """Costs around the paths of a team, fitted by linear pieces.

    Args:
        knots: (m, 2) distance [cells], rising from 0 on, and cost there in steps; linear in between, nothing beyond the
            last. A cost of 1 makes a step there count as two.

    Raises:
        TeamError: The knots are not of this form.
    """

    def __init__(self, knots: ArrayLike) -> None:
        table = np.asarray(knots, np.float64)
        if table.ndim != 2 or table.shape[1] != 2 or len(table) < 2 or not np.isfinite(table).all():
            raise TeamError(f"deviation has shape {table.shape}; at least two rows (distance in cells, cost in steps)")
        if table[0, 0] != 0.0 or (np.diff(table[:, 0]) <= 0).any() or (table[:, 1] < 0).any() or table[:, 1].max() > 64:
            raise TeamError("deviation needs distances that rise from 0 on and costs from 0 to 64 steps")
        reach = math.floor(table[-1, 0])
        steps = np.arange(-reach, reach + 1)
        distance = np.hypot(steps[:, None], steps[None, :])
        units = np.round(np.interp(distance, table[:, 0], table[:, 1], right=0.0) * int(STEP)).astype(np.int64)
        rows, cols = np.nonzero(units)
        self._offsets = np.stack([rows - reach, cols - reach, units[rows, cols]], axis=1)

    def add(self, traffic: Traffic, robot: int) -> None:
        """Charge the robots still to be planned for being near the path of one that is placed."""
        if len(traffic.layer) == 1:
            traffic.layer = np.zeros((traffic.capacity, len(traffic.graph)), np.int32)
        graph = traffic.graph
        stride = np.int64(graph.stride)
        _add_along(
            traffic.paths[robot],
            traffic.lengths[robot],
            graph.padded,
            graph.at,
            self._offsets,
            stride,
            traffic.layer,
        )

    def charge(self, traffic: Traffic, robot: int) -> int:
        """What the robots placed so far charge a robot for its path, in units of which a step has ``STEP``."""
        layer, path = traffic.layer, traffic.paths[robot, : traffic.lengths[robot] + 1]
        rows = np.minimum(np.arange(len(path)), len(layer) - 1)
        return int(layer[rows, path].sum())
