"""In which order clearances are tried: first the one that the gaps between obstacles suggest."""

import math

from lidarena.planning.potential_field.field_scene import FieldScene
from lidarena.planning.potential_field.gap_graph import GapGraph

_HALVING = 0.5
"""Each clearance is so much of the next larger one."""
_HALVINGS = 12
_WORTH = 1.05
"""A clearance is halved where that makes the way so much shorter."""


def clearance_shares(scene: FieldScene, clearance: float, attempts: int) -> list[float]:
    """Return the shares of a clearance to try, halves of each other, the most promising first.

    That is the largest for which a further halving would not make the way between the obstacles 5% shorter, by
    :class:`~lidarena.planning.potential_field.gap_graph.GapGraph`. The others follow by how far they are from it.

    Args:
        scene: Obstacles, start and goal.
        clearance: The largest (m).
        attempts: How many shares are wanted.
    """
    first = _best_halving(scene, clearance) if attempts > 1 else 0
    halvings = sorted(range(first + attempts), key=lambda k: (abs(k - first), -k))
    return [_HALVING**k for k in halvings[:attempts]]


def _best_halving(scene: FieldScene, clearance: float) -> int:
    """How often to halve a clearance; 0 if no way is found at all."""
    gaps, straight = GapGraph(scene), math.dist(scene.start, scene.goal)
    best, cost = 0, math.inf
    for k in range(_HALVINGS + 1):
        if straight * _WORTH**k >= cost:
            break  # no way is shorter than the straight line
        found = gaps.way_length(clearance * _HALVING**k) * _WORTH**k
        if found < cost:
            best, cost = k, found
    return best
