"""The back end: loops are searched and verified, and all keyframes moved to where everything fits."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from lidarena.slam.graph.correlation import best_in_window, draw_scan, empty_grid
from lidarena.slam.graph.front_end import FrontEnd
from lidarena.slam.graph.optimization import Edges, joined, optimized
from lidarena.slam.graph.pair_matching import PAIR_COLUMNS, match_pairs
from lidarena.slam.graph.point_to_line import align
from lidarena.slam.planar import between, compose, wrapped

Floats = NDArray[np.float64]

_CHUNK = 12
"""Keyframes from one search for loops to the next."""
_FAR = 4.0
"""A loop must be so much longer than what the search for it spans [m]."""
_DOUBT = 12.0
"""Squared Mahalanobis distance from which on a loop is doubted."""
_ROUNDS = np.array([0.4, 0.3, 0.3, 0.2, 0.2, 0.15, 0.15, 0.1, 0.1, 0.1])
_CORRELATED = 0.05
"""Share of the points of a pair that count as independent."""


@dataclass(frozen=True)
class FoundLoop:
    """A keyframe that fits an earlier one, by number, and how."""

    later: int
    earlier: int
    motion: Floats
    information: Floats
    score: float


class BackEnd:
    """Closes loops among the keyframes of a front end.

    Args:
        front: The front end; its scans are read only.

    Attributes:
        poses: (K, 3) of the keyframes.
        loops: The loops found.
    """

    def __init__(self, front: FrontEnd) -> None:
        self.front, self.loops = front, list[FoundLoop]()
        self.scans = np.array(front.keyframes, np.int64)
        self.local = np.array(front.poses)[self.scans]
        self.poses = self.local.copy()
        self.steps = between(self.local[:-1], self.local[1:])
        self.way = np.concatenate([[0.0], np.cumsum(np.hypot(self.steps[:, 0], self.steps[:, 1]))])

    def close_loops(self) -> None:
        """Search loops from the start to the end, each with the map as the ones before have bent it."""
        for k in range(2 * _CHUNK, len(self.scans), _CHUNK):
            found = self._search(k)
            self.loops += found
            if found:
                self.poses[: k + 1] = optimized(self.poses[: k + 1], self._edges(k + 1), 4)
                self.poses[k:] = compose(self.poses[k], between(self.local[k], self.local[k:]))
        if self.loops:
            self.poses = optimized(self.poses, self._edges(len(self.poses)), 10)

    def loop_edges(self) -> Edges:
        """The loops as edges."""
        if not self.loops:
            return Edges(np.zeros((0, 2), np.int64), np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0))
        pairs = np.array([(one.earlier, one.later) for one in self.loops], np.int64)
        motions, information = (np.array([getattr(one, n) for one in self.loops]) for n in ("motion", "information"))
        return Edges(pairs, motions, information, np.full(len(pairs), _DOUBT))

    def _edges(self, count: int) -> Edges:
        """The way from keyframe to keyframe and the loops, among the first ones."""
        n = count - 1
        length, turn = np.hypot(self.steps[:n, 0], self.steps[:n, 1]), np.abs(self.steps[:n, 2])
        information = np.zeros((n, 3, 3))
        information[:, 0, 0] = information[:, 1, 1] = 1.0 / (0.006 + 0.015 * length) ** 2
        information[:, 2, 2] = 1.0 / (0.002 + 0.01 * turn) ** 2
        pairs = np.stack([np.arange(n), np.arange(1, n + 1)], axis=1)
        return joined([Edges(pairs, self.steps[:n], information, np.full(n, np.inf)), self.loop_edges()])

    def _unclosed(self, k: int) -> Floats:
        """(k,) how far each keyframe before k is along the graph, where a loop is a short cut [m]."""
        a = np.concatenate([np.arange(k), [one.earlier for one in self.loops]]).astype(np.int64)
        b = np.concatenate([np.arange(1, k + 1), [one.later for one in self.loops]]).astype(np.int64)
        weights = np.concatenate([np.diff(self.way[: k + 1]) + 0.02, np.full(len(self.loops), 0.3)])
        graph = coo_matrix((weights, (a, b)), shape=(k + 1, k + 1)).tocsr()
        away: Floats = np.asarray(dijkstra(graph, directed=False, indices=np.array([k])))[0, :k]
        return away

    def _search(self, k: int) -> list[FoundLoop]:
        """Loops from keyframe k to up to three places."""
        pose, unclosed = self.poses[k], self._unclosed(k)
        radius = np.minimum(1.0 + 0.04 * unclosed, 8.0)
        away = np.hypot(self.poses[:k, 0] - pose[0], self.poses[:k, 1] - pose[1])
        turned = np.abs(wrapped(self.poses[:k, 2] - pose[2]))
        cost = away / (radius + 2.0) + 0.4 * turned
        free = (self.way[k] - self.way[:k] > _FAR + 2.0 * radius) & (away < radius + 2.0) & (turned < 1.2)
        found: list[FoundLoop] = []
        for _ in range(3):
            if not free.any():
                break
            target = int(np.argmin(np.where(free, cost, np.inf)))
            loop = self._verified(k, target, float(min(radius[target], 0.5 + away[target] + radius[target])))
            if loop is not None:
                found.append(loop)
            free[max(target - 40, 0) : target + 40] = False
        return found

    def _verified(self, k: int, target: int, radius: float) -> FoundLoop | None:
        """The loop from keyframe k to the keyframes around a target, if it holds."""
        store, fan = self.front.store, self.front.fan
        near = np.arange(max(target - 10, 0), min(target + 11, k))
        grid = empty_grid()
        for one in near:
            draw_scan(grid, store, int(self.scans[one]), self.poses[one], 1)
        window, loose = np.array([radius, 0.12 + 0.04 * radius]), np.array([max(radius, 0.5), 0.5])
        scan = int(self.scans[k])
        found = best_in_window(grid, store, scan, self.poses[k], window, np.array([0.1, 0.035]), loose, 50)
        fine = np.array([0.1, 0.035]), np.array([0.05, 0.01]), np.array([10.0, 10.0])
        found = best_in_window(grid, store, scan, found[:3], *fine, 90)
        if found[3] < 0.55:
            return None
        cost = np.hypot(*(self.poses[near, :2] - found[:2]).T) + np.abs(wrapped(self.poses[near, 2] - found[2]))
        chosen = near[np.argsort(cost, kind="stable")[:5]]
        pose, system = found[:3].copy(), np.zeros(16)
        stride = max(fan.beams // 180, 1)
        align(store, fan, scan, self.scans[chosen], self.poses[chosen], pose, np.full(3, 1.0), _ROUNDS, stride, system)
        share = system[10] / max(system[11], 1.0)
        points = np.count_nonzero(store.weights[scan]) / stride
        if share < 0.6 or system[11] < 1.5 * points or np.hypot(*(pose[:2] - found[:2])) > 0.3:
            return None
        to = int(chosen[0])
        information = np.diag([1.0 / 0.05**2, 1.0 / 0.05**2, 1.0 / 0.01**2])
        return FoundLoop(k, to, between(self.poses[to], pose), information, float(share))


def adjusted(front: FrontEnd, scans: NDArray[np.int64], poses: Floats, rounds: int = 6) -> tuple[Floats, Edges]:
    """Match every keyframe with its neighbours of all visits, all at once, again and again.

    Returns:
        (K, 3) poses, and what was measured between them in the end.
    """
    pairs = neighbours(poses)
    weak = _chain(poses)
    edges = weak
    for r in range(rounds):
        nearby = max(0.3 - 0.05 * r, 0.1)
        edges = joined([_matched(front, scans, poses, pairs, nearby), weak])
        poses = optimized(poses, edges, 1)
    return poses, edges


def neighbours(poses: Floats, visits: int = 4, apart: float = 2.5) -> NDArray[np.int64]:
    """(P, 2) which keyframes are compared: each with some before it, and with the nearest of other visits."""
    pairs = []
    for k in range(1, len(poses)):
        away = np.hypot(poses[:k, 0] - poses[k, 0], poses[:k, 1] - poses[k, 1])
        away += 1.2 * np.abs(wrapped(poses[:k, 2] - poses[k, 2]))
        pairs += [(k - back, k) for back in (1, 2, 4, 7) if k >= back and away[k - back] < apart]
        away[max(k - 30, 0) :] = np.inf
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


def _matched(
    front: FrontEnd, scans: NDArray[np.int64], poses: Floats, pairs: NDArray[np.int64], nearby: float
) -> Edges:
    """One step of matching of every pair, as edges."""
    motions = between(poses[pairs[:, 0]], poses[pairs[:, 1]])
    systems = np.zeros((len(pairs), PAIR_COLUMNS))
    match_pairs(front.store, front.fan, scans[pairs], motions, nearby, max(front.fan.beams // 180, 1), systems)
    upper = systems[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    steps = np.linalg.solve(upper + 10.0 * np.eye(3), -systems[:, 6:9, None])[:, :, 0]
    motions = motions + np.clip(steps, -0.2, 0.2)
    good = systems[:, 10] > 20.0
    return Edges(pairs[good], motions[good], _CORRELATED * upper[good], np.full(int(good.sum()), 30.0))
