"""Places that a robot knows so well that another look at them adds nothing to the map."""

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.graph.graph_nodes import NodeColumns
from lidarena.slam.planar import wrapped

Floats = NDArray[np.float64]

_NEAR = 0.8
"""Keyframes nearer to each other see the same [m, and 1.2 m a radian]."""
_VISIT = 30
"""Keyframes nearer to each other in the order of driving belong to one visit."""
_KNOWN = np.diag([0.03**2, 0.03**2, 0.01**2])
"""How surely a keyframe is known from those around it [m², m², rad²]."""


def known_from(columns: NodeColumns, before: int, place: int, visits: int) -> int:
    """The nearest node of earlier visits to the node in a ``place``, if there were so many visits; else -1.

    Args:
        columns: The nodes.
        before: Nodes in earlier places than this are looked at.
        place: Of the node.
        visits: How many.
    """
    poses, numbers = columns.poses, columns.numbers
    beside = np.flatnonzero(np.abs(poses[:before, 0] - poses[place, 0]) < _NEAR)  # most are not, which saves the rest
    apart = poses[beside] - poses[place]
    away = np.hypot(apart[:, 0], apart[:, 1]) + 1.2 * np.abs(wrapped(apart[:, 2]))
    near = (away < _NEAR) & (numbers[beside] < numbers[place] - _VISIT)
    visited = numbers[beside][near]
    if len(visited) == 0 or 1 + np.sum(np.diff(visited) > _VISIT) < visits:
        return -1
    return int(beside[near][np.argmin(away[near])])


def loosened(information: Floats, turn: float) -> Floats:
    """Information (3, 3) on a step from a dropped keyframe, as seen from the one that it is tied to, turned by so much.

    What is measured from there is known less surely by what is not known about the dropped one.
    """
    cos, sin = np.cos(turn), np.sin(turn)
    rotation = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    loose: Floats = np.linalg.inv(rotation @ np.linalg.inv(information) @ rotation.T + _KNOWN)
    return loose
