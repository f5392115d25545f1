"""In the end every scan that is no node of the graph is matched with the nodes around it."""

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, leaf
from lidarena.slam.graph.point_to_line import align
from lidarena.slam.graph.surface_points import BeamFan, SurfacePoints, enter_scan

Floats = NDArray[np.float64]

_ROUNDS = np.array([0.2, 0.15, 0.12, 0.1, 0.1])
"""Distance within which points belong together, round by round [m]."""
_PRIOR = np.array([1.0 / 0.03**2, 1.0 / 0.03**2, 1.0 / 0.02**2])
"""How surely a scan is where it was before [1/m², 1/m², 1/rad²]."""
_NEAREST = 6
"""Nodes that a scan is compared with."""
_APART = 2.5
"""Nodes farther from it are not [m, and 1 m a radian]."""
_FITS = 0.5
"""Share of the points that must lie on known surfaces."""
_STRAYED = np.array([0.2, 0.1])
"""A match that is farther from where the scan was is not believed [m, rad]."""


def match_with_nodes(
    store: SurfacePoints,
    fan: BeamFan,
    slot: int,
    ranges: NDArray[np.float32],
    reach: float,
    poses: Floats,
    nodes: Floats,
    slots: NDArray[np.int64],
) -> None:
    """Move scans to where they fit the nodes around them.

    Args:
        store: The nodes' scans.
        fan: The beams.
        slot: Of the store, that may be written over.
        ranges: (M, B) of the scans [m].
        reach: Longer ranges are left out [m].
        poses: (M, 3) where they are, to be moved.
        nodes: (N, 3) where the nodes are.
        slots: (N,) where their scans are in the store.
    """
    stride = max(fan.beams // 180, 1)
    _match_all(store, fan, slot, ranges, reach, poses, nodes, slots, stride)


@kernel
def _match_all(
    store: SurfacePoints,
    fan: BeamFan,
    slot: int,
    ranges: NDArray[np.float32],
    reach: float,
    poses: Floats,
    nodes: Floats,
    slots: NDArray[np.int64],
    stride: int,
) -> None:
    """Match one scan after the other."""
    places, costs, system = np.empty(_NEAREST, np.int64), np.empty(_NEAREST), np.empty(16)
    for m in range(poses.shape[0]):
        points = enter_scan(store, slot, ranges[m], fan, reach)
        n = _nearest_nodes(poses[m], nodes, places, costs)
        if points < 10 or n == 0:
            continue
        pose = poses[m].copy()
        align(store, fan, slot, slots[places[:n]], nodes[places[:n]], pose, _PRIOR, _ROUNDS, stride, system)
        shift = np.hypot(pose[0] - poses[m, 0], pose[1] - poses[m, 1])
        if system[10] >= _FITS * system[11] and shift < _STRAYED[0] and abs(pose[2] - poses[m, 2]) < _STRAYED[1]:
            poses[m] = pose


@leaf
def _nearest_nodes(pose: Floats, nodes: Floats, places: NDArray[np.int64], costs: Floats) -> int:
    """The nearest nodes, nearest first, into ``places``; returns how many."""
    found = 0
    for k in range(nodes.shape[0]):
        dx, dy = nodes[k, 0] - pose[0], nodes[k, 1] - pose[1]
        if dx * dx + dy * dy > _APART * _APART:
            continue
        turn = abs(nodes[k, 2] - pose[2]) % (2.0 * np.pi)
        cost = np.sqrt(dx * dx + dy * dy) + min(turn, 2.0 * np.pi - turn)
        if cost > _APART or (found == _NEAREST and cost >= costs[found - 1]):
            continue
        at = found if found < _NEAREST else _NEAREST - 1
        found = at + 1
        while at > 0 and costs[at - 1] > cost:
            costs[at], places[at] = costs[at - 1], places[at - 1]
            at -= 1
        costs[at], places[at] = cost, k
    return found
