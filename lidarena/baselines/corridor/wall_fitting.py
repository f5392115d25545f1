"""Where a robot is, to the millimetre that a corridor leaves it: its scan is laid onto the walls of the map."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.corridor.robot_interface import Fleet, FleetState
from lidarena.planning.team.floor_grid import FloorGrid

Floats = NDArray[np.float64]

_PRIOR = np.array([0.015, 0.015, 0.05])
"""Deviations of the pose that is believed before [m, m, rad]."""
_NOISE = 0.02
"""Deviation of how far a beam's end lies from its wall, the noise of beams and the edges of cells together [m]."""
_NEAR = 0.7
"""It grows with the range beyond this [m]: a long beam may meet another wall than the one that it would meet from the
pose that is believed."""
_ROUNDS = 3
_BACK = 1.5
"""Distances are looked up so far before a beam's end, where cells are free, and drawn out to it [cells]."""
_FREE = 0.7
"""Points nearer to a wall than so many cells are not looked up."""
_ODD = 0.1
"""Beams that end farther from every wall met something else, such as another robot [m]."""
_TRUST = 0.35
"""In a pose of localisation against where the last command led."""


class WallTracker:
    """Where a team is in places so narrow that localisation's jitter would fill them; elsewhere it believes it.

    Each pose is looked for about one between where the last command led and what localisation tells.

    Args:
        fleet: The team.
    """

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        self._poses: Floats | None = None

    def look(self, state: FleetState, info: dict[str, Any], grid: FloorGrid) -> FleetState:
        """Return the state with the poses by what lidars see of the walls, where the grid has a clearance."""
        if grid.clearance is None:
            return state
        believed = state.poses.copy()
        if self._poses is not None:
            off = state.poses - self._poses
            off[:, 2] = np.angle(np.exp(1j * off[:, 2]))
            believed = self._poses + _TRUST * off
        lidar = self._fleet.lidar
        for robot in np.flatnonzero(state.active).tolist():
            scan = self._fleet.scan(robot, info)
            if scan is not None:
                believed[robot] = fit_to_walls(believed[robot], scan, lidar.directions, lidar.max_range, grid)
        self._poses = believed
        return replace(state, poses=believed.copy())

    def drive(self, commands: Floats) -> None:
        """Note where commands (k, 2) of speed [m/s] and turn rate [rad/s] will lead."""
        if self._poses is not None:
            speeds, rates = commands.T * self._fleet.period
            middle = self._poses[:, 2] + 0.5 * rates
            self._poses = self._poses + np.stack([speeds * np.cos(middle), speeds * np.sin(middle), rates], axis=1)


def fit_to_walls(pose: Floats, scan: Floats, directions: Floats, reach: float, grid: FloorGrid) -> Floats:
    """Return the pose (3,) in whose surroundings a scan's ends lie on the map's walls best.

    Gauss-Newton on the distances of the beams' ends to the nearest wall, beside what was believed before.

    Args:
        pose: That is believed, x, y, heading.
        scan: (beams,) ranges [m].
        directions: (2, beams) cosines and sines of the beams' angles.
        reach: Beams of this range met nothing [m].
        grid: The map, with its clearance.
    """
    fitted = pose.astype(np.float64)
    met = (scan > _BACK * grid.resolution) & (scan < reach)
    scan, directions = scan[met], directions[:, met]
    for _ in range(_ROUNDS):
        cos, sin = np.cos(fitted[2]), np.sin(fitted[2])
        ways = np.stack([directions[0] * cos - directions[1] * sin, directions[0] * sin + directions[1] * cos], axis=1)
        back = _BACK * grid.resolution
        away, slopes = _look_up(fitted[:2] + (scan - back)[:, None] * ways, grid)
        off = away + back * (slopes * ways).sum(axis=1)
        good = (away >= _FREE * grid.resolution) & (np.abs(off) < _ODD)
        turned = scan * (slopes[:, 1] * ways[:, 0] - slopes[:, 0] * ways[:, 1])
        noise = _NOISE * np.maximum(1.0, scan[good] / _NEAR)
        rows = np.column_stack([slopes, turned])[good] / noise[:, None]
        wanted = rows.T @ (-off[good] / noise) + (pose - fitted) / _PRIOR**2
        fitted += np.linalg.solve(rows.T @ rows + np.diag(_PRIOR**-2.0), wanted)
    return fitted


def _look_up(points: Floats, grid: FloorGrid) -> tuple[Floats, Floats]:
    """Clearance (n,) [m] and its slopes (n, 2) along x and y at points (n, 2), between the cells' centres."""
    assert grid.clearance is not None
    rows, cols = grid.clearance.shape
    place = np.clip((points - np.asarray(grid.origin)) / grid.resolution - 0.5, 0.0, (cols - 1.001, rows - 1.001))
    low = place.astype(np.int64)
    (u, v), (col, row) = (place - low).T, low.T
    corners = [grid.clearance[row + i, col + j].astype(np.float64) for i in (0, 1) for j in (0, 1)]
    south, north = ((1.0 - u) * corners[2 * i] + u * corners[2 * i + 1] for i in (0, 1))
    along_x = (1.0 - v) * (corners[1] - corners[0]) + v * (corners[3] - corners[2])
    known = np.minimum.reduce(corners) > 0.0  # none of the four is in a wall
    slopes = np.stack([along_x, north - south], axis=1) / grid.resolution
    return np.where(known, (1.0 - v) * south + v * north, 0.0), slopes
