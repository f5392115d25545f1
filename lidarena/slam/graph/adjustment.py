"""All keyframes matched with their neighbours of all visits at once, again and again, until surfaces lie together."""

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.graph.front_end import FrontEnd
from lidarena.slam.graph.optimization import Edges, joined, optimized
from lidarena.slam.graph.pair_matching import PAIR_COLUMNS, match_pairs
from lidarena.slam.planar import between, wrapped

Floats = NDArray[np.float64]

_CORRELATED = 0.05
"""Share of the points of a pair that count as independent."""
_DOUBT = 30.0
"""Squared Mahalanobis distance from which on a pair is doubted."""
_BACK = (1, 2, 4, 7)
"""Each keyframe is compared with so manyth ones before it."""
_OPPOSITE = 1.0
"""Scans that see the same from elsewhere count as so much farther apart [m]."""
_VISIT = 30
"""Keyframes nearer to each other in time belong to one visit."""
_ALIKE = np.array([1.2, 1.2, 0.7])
"""Scans taken nearer to each other see nearly the same [m, m, rad]."""
_AGREED, _RUN = 0.4, 5
"""Where a smaller share of the points fits in so many keyframes one after the other, a map is torn. In sound maps three
of four fit, hardly ever less than one of two; in torn ones next to none."""


def adjusted(front: FrontEnd, poses: Floats, rounds: int = 6) -> tuple[Floats, Edges]:
    """Match every keyframe with its neighbours of all visits, all at once, again and again.

    Args:
        front: Its keyframes.
        poses: (K, 3) where they are.
        rounds: How often.

    Returns:
        (K, 3) poses, and what was measured between them in the end.
    """
    pairs, weak = neighbours(poses, front.viewed(poses)), _chain(poses)
    edges = weak
    for r in range(rounds):
        edges = joined([_matched(front, poses, pairs, max(0.3 - 0.05 * r, 0.1)), weak])
        poses = optimized(poses, edges, 1)
    return poses, edges


def neighbours(poses: Floats, views: Floats, visits: int = 4, apart: float = 2.5) -> NDArray[np.int64]:
    """Which keyframes are compared: each with some before it, and with the nearest of other visits.

    Args:
        poses: (K, 3) of the keyframes.
        views: (K, 2) the middle of what each saw: who comes back the other way sees the same from elsewhere.
        visits: So many other visits count, at most.
        apart: Keyframes farther from each other are not compared [m].

    Returns:
        (P, 2) pairs, the earlier keyframe first.
    """
    pairs = []
    for k in range(1, len(poses)):
        away = np.hypot(poses[:k, 0] - poses[k, 0], poses[:k, 1] - poses[k, 1])
        away += 1.2 * np.abs(wrapped(poses[:k, 2] - poses[k, 2]))
        pairs += [(k - back, k) for back in _BACK if k >= back and away[k - back] < apart]
        away = np.minimum(away, np.hypot(views[:k, 0] - views[k, 0], views[:k, 1] - views[k, 1]) + _OPPOSITE)
        away[max(k - _VISIT, 0) :] = np.inf
        for _ in range(visits):
            nearest = int(np.argmin(away))
            if away[nearest] > apart:
                break
            pairs.append((nearest, k))
            away[max(nearest - 10, 0) : nearest + 11] = np.inf
    return np.array(pairs, np.int64).reshape(-1, 2)


def _chain(poses: Floats) -> Edges:
    """What holds keyframes together where no surfaces do: the way as it was matched."""
    n = len(poses) - 1
    information = np.broadcast_to(np.diag([1.0 / 0.05**2, 1.0 / 0.05**2, 1.0 / 0.03**2]), (n, 3, 3))
    pairs = np.stack([np.arange(n), np.arange(1, n + 1)], axis=1)
    return Edges(pairs, between(poses[:-1], poses[1:]), information, np.full(n, np.inf))


def _matched(front: FrontEnd, poses: Floats, pairs: NDArray[np.int64], nearby: float) -> Edges:
    """One step of matching of every pair, as edges."""
    motions = between(poses[pairs[:, 0]], poses[pairs[:, 1]])
    systems = np.zeros((len(pairs), PAIR_COLUMNS))
    match_pairs(front.store, front.fan, pairs, motions, nearby, max(front.fan.beams // 180, 1), systems)
    upper = systems[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    steps = np.linalg.solve(upper + 10.0 * np.eye(3), -systems[:, 6:9, None])[:, :, 0]
    motions = motions + np.clip(steps, -0.2, 0.2)
    good = systems[:, 10] > 20.0
    return Edges(pairs[good], motions[good], _CORRELATED * upper[good], np.full(int(good.sum()), _DOUBT))


def agreement(front: FrontEnd, poses: Floats) -> tuple[NDArray[np.int64], Floats]:
    """How well places that were seen in several visits fit.

    Returns:
        (P, 2) keyframes of different visits that should see the same, and (P,) the share of points that fit.
    """
    pairs = neighbours(poses, front.viewed(poses))
    motions = np.abs(between(poses[pairs[:, 0]], poses[pairs[:, 1]]))
    pairs = pairs[(pairs[:, 1] - pairs[:, 0] >= _VISIT) & np.all(motions < _ALIKE, axis=1)]
    systems = np.zeros((len(pairs), PAIR_COLUMNS))
    motions = between(poses[pairs[:, 0]], poses[pairs[:, 1]])
    match_pairs(front.store, front.fan, pairs, motions, 0.1, max(front.fan.beams // 180, 1), systems)
    return pairs, systems[:, 10] / np.maximum(systems[:, 11], 1.0)


def torn_places(front: FrontEnd, poses: Floats) -> NDArray[np.int64]:
    """(T, 2) keyframes, one pair a place, that see the same place in different visits and do not fit at all."""
    pairs, shares = agreement(front, poses)
    best: dict[int, tuple[float, int]] = {}
    for (earlier, later), share in zip(pairs.tolist(), shares.tolist(), strict=True):
        best[later] = max(best.get(later, (-1.0, earlier)), (share, earlier))
    places, run = [], 0
    for later in sorted(best):
        share, earlier = best[later]
        run = run + 1 if share < _AGREED else 0
        if run == _RUN:
            places.append((earlier, later))
    return np.array(places, np.int64).reshape(-1, 2)
