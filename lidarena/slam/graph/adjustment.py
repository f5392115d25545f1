"""All keyframes matched with their neighbours of all visits at once, again and again, until surfaces lie together."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.graph.front_end import FrontEnd, viewed
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


class Compared(NamedTuple):
    """The keyframes that are matched with each other.

    Attributes:
        numbers: (N,) which keyframes.
        views: (N, 2) the middle of what each saw, in the laser's frame [m].
        sources: (N - 1,) from which of them, by place, each but the first is measured on the way.
    """

    numbers: NDArray[np.int64]
    views: Floats
    sources: NDArray[np.int64]


def all_keyframes(front: FrontEnd) -> Compared:
    """All keyframes, each measured from the one before."""
    every = np.arange(len(front.keyframes))
    return Compared(every, np.array(front.views).reshape(-1, 2), every[:-1])


def adjusted(front: FrontEnd, poses: Floats, rounds: int = 6, compared: Compared | None = None) -> tuple[Floats, Edges]:
    """Match every keyframe with its neighbours of all visits, all at once, again and again.

    Args:
        front: The front end.
        poses: (N, 3) where they are.
        rounds: How often.
        compared: The keyframes; all if left out.

    Returns:
        (N, 3) poses, and what was measured between them in the end.
    """
    compared = compared or all_keyframes(front)
    slots = front.slots(compared.numbers)
    pairs, weak = neighbours(poses, viewed(poses, compared.views)), _chain(poses, compared.sources)
    edges = weak
    for r in range(rounds):
        edges = joined([_matched(front, poses, pairs, slots, max(0.3 - 0.05 * r, 0.1)), weak])
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


def _chain(poses: Floats, sources: NDArray[np.int64]) -> Edges:
    """What holds keyframes together where no surfaces do: the way as it was matched."""
    n = len(poses) - 1
    information = np.broadcast_to(np.diag([1.0 / 0.05**2, 1.0 / 0.05**2, 1.0 / 0.03**2]), (n, 3, 3))
    pairs = np.stack([sources, np.arange(1, n + 1)], axis=1)
    return Edges(pairs, between(poses[sources], poses[1:]), information, np.full(n, np.inf))


def _matched(
    front: FrontEnd, poses: Floats, pairs: NDArray[np.int64], slots: NDArray[np.int64], nearby: float
) -> Edges:
    """One step of matching of every pair, as edges."""
    motions = between(poses[pairs[:, 0]], poses[pairs[:, 1]])
    systems = np.zeros((len(pairs), PAIR_COLUMNS))
    match_pairs(front.store, front.fan, slots[pairs], motions, nearby, max(front.fan.beams // 180, 1), systems)
    upper = systems[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    steps = np.linalg.solve(upper + 10.0 * np.eye(3), -systems[:, 6:9, None])[:, :, 0]
    motions = motions + np.clip(steps, -0.2, 0.2)
    good = systems[:, 10] > 20.0
    return Edges(pairs[good], motions[good], _CORRELATED * upper[good], np.full(int(good.sum()), _DOUBT))


def agreement(front: FrontEnd, poses: Floats, compared: Compared | None = None) -> tuple[NDArray[np.int64], Floats]:
    """How well places that were seen in several visits fit; arguments as of ``adjusted``.

    Returns:
        (P, 2) keyframes of different visits, by place, that should see the same, and (P,) the share of points that fit.
    """
    compared = compared or all_keyframes(front)
    pairs = neighbours(poses, viewed(poses, compared.views))
    motions = np.abs(between(poses[pairs[:, 0]], poses[pairs[:, 1]]))
    pairs = pairs[(pairs[:, 1] - pairs[:, 0] >= _VISIT) & np.all(motions < _ALIKE, axis=1)]
    systems = np.zeros((len(pairs), PAIR_COLUMNS))
    motions = between(poses[pairs[:, 0]], poses[pairs[:, 1]])
    scans, stride = front.slots(compared.numbers)[pairs], max(front.fan.beams // 180, 1)
    match_pairs(front.store, front.fan, scans, motions, 0.1, stride, systems)
    return pairs, systems[:, 10] / np.maximum(systems[:, 11], 1.0)


def torn_places(front: FrontEnd, poses: Floats, compared: Compared | None = None) -> NDArray[np.int64]:
    """(T, 2) places of the order, one pair each, that see the same place in different visits and do not fit at all."""
    pairs, shares = agreement(front, poses, compared)
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
