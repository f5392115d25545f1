"""The back end: loops are searched on the way, verified, and all keyframes moved to where everything fits."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from lidarena.slam.graph.correlation import best_in_window, draw_scan, empty_grid
from lidarena.slam.graph.front_end import FrontEnd
from lidarena.slam.graph.odometry_spread import motion_spread
from lidarena.slam.graph.optimization import Edges, joined, optimized
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
_INDEPENDENT = 0.3
"""Share of the points of a match that count as independent."""
_UPPER = np.array([[0, 1, 2], [1, 3, 4], [2, 4, 5]])


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
        loops: The loops found.
    """

    def __init__(self, front: FrontEnd) -> None:
        self.front, self.loops, self.grid = front, list[FoundLoop](), empty_grid()
        self._poses: list[Floats] = []
        self._steps: list[Floats] = []
        self._information: list[Floats] = []
        self._way: list[float] = []

    @property
    def poses(self) -> Floats:
        """(K, 3) of the keyframes."""
        return np.array(self._poses).reshape(-1, 3)

    def corrected(self, pose: Floats) -> Floats:
        """Where a pose (3,) of the front end's last scan really is."""
        last = len(self._poses) - 1
        return compose(self._poses[last], between(self.front.node(last), pose)) if last >= 0 else pose

    def extend(self) -> bool:
        """Take in the keyframe that the front end took last, and search loops from it if it is its turn.

        Returns:
            Whether a loop was closed.
        """
        k, front = len(self._poses), self.front
        if k == 0:
            self._poses.append(front.node(0))
            self._way.append(0.0)
            return False
        step = between(front.node(k - 1), front.node(k))
        self._steps.append(step)
        self._information.append(_step_information(step, front.information[k], front.node(k - 1)[2]))
        self._poses.append(compose(self._poses[-1], step))
        self._way.append(self._way[-1] + float(np.hypot(step[0], step[1])))
        if k < 2 * _CHUNK or k % _CHUNK:
            return False
        found = self._search(k)
        self.loops += found
        if found:
            self._poses = list(optimized(self.poses, self._edges(), 4))
        return bool(found)

    def fitted(self) -> Floats:
        """(K, 3) poses of the keyframes, as all that is known fits best."""
        return optimized(self.poses, self._edges(), 10) if self.loops else self.poses

    def loop_edges(self) -> Edges:
        """The loops as edges."""
        if not self.loops:
            return Edges(np.zeros((0, 2), np.int64), np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0))
        pairs = np.array([(one.earlier, one.later) for one in self.loops], np.int64)
        motions, information = (np.array([getattr(one, n) for one in self.loops]) for n in ("motion", "information"))
        return Edges(pairs, motions, information, np.full(len(pairs), _DOUBT))

    def _edges(self) -> Edges:
        """The way from keyframe to keyframe and the loops."""
        n = len(self._steps)
        pairs = np.stack([np.arange(n), np.arange(1, n + 1)], axis=1)
        way = Edges(pairs, np.array(self._steps), np.array(self._information), np.full(n, np.inf))
        return joined([way, self.loop_edges()])

    def _unclosed(self, k: int) -> Floats:
        """(k,) how far each keyframe before k is along the graph, where a loop is a short cut [m]."""
        a = np.concatenate([np.arange(k), [one.earlier for one in self.loops]]).astype(np.int64)
        b = np.concatenate([np.arange(1, k + 1), [one.later for one in self.loops]]).astype(np.int64)
        weights = np.concatenate([np.diff(self._way[: k + 1]) + 0.02, np.full(len(self.loops), 0.3)])
        graph = coo_matrix((weights, (a, b)), shape=(k + 1, k + 1)).tocsr()
        away: Floats = np.asarray(dijkstra(graph, directed=False, indices=np.array([k])))[0, :k]
        return away

    def _search(self, k: int) -> list[FoundLoop]:
        """Loops from keyframe k to up to three places."""
        poses, way, unclosed = self.poses, np.array(self._way), self._unclosed(k)
        radius = np.minimum(1.0 + 0.04 * unclosed, 8.0)
        away = np.hypot(poses[:k, 0] - poses[k, 0], poses[:k, 1] - poses[k, 1])
        turned = np.abs(wrapped(poses[:k, 2] - poses[k, 2]))
        views = self.front.viewed(poses)
        apart = np.hypot(*(views[:k] - views[k]).T)
        alike = np.where((away < radius + 2.0) & (turned < 1.2), away / (radius + 2.0) + 0.4 * turned, np.inf)
        opposite = np.where(apart < radius + 1.0, apart / (radius + 2.0) + 0.5, np.inf)
        cost = np.minimum(alike, opposite)
        free = (way[k] - way[:k] > _FAR + 2.0 * radius) & np.isfinite(cost)
        found: list[FoundLoop] = []
        for _ in range(3):
            if not free.any():
                break
            target = int(np.argmin(np.where(free, cost, np.inf)))
            loop = self._verified(poses, views, k, target, float(radius[target]))
            if loop is not None:
                found.append(loop)
            free[max(target - 40, 0) : target + 40] = False
        return found

    def _verified(self, poses: Floats, views: Floats, k: int, target: int, radius: float) -> FoundLoop | None:
        """The loop from keyframe k to the keyframes around a target, if it holds."""
        store, fan, grid = self.front.store, self.front.fan, self.grid
        near = np.arange(max(target - 10, 0), min(target + 11, k))
        for one in near:
            draw_scan(grid, store, int(one), poses[one], 1)
        window, loose = np.array([radius, 0.12 + 0.04 * radius]), np.array([max(radius, 0.5), 0.5])
        found = best_in_window(grid, store, k, poses[k], window, np.array([0.1, 0.035]), loose, 50)
        fine = np.array([0.1, 0.035]), np.array([0.05, 0.01]), np.array([10.0, 10.0])
        found = best_in_window(grid, store, k, found[:3], *fine, 90)
        for one in near:
            draw_scan(grid, store, int(one), poses[one], -1)
        if found[3] < 0.55:
            return None
        cost = np.hypot(*(poses[near, :2] - found[:2]).T) + np.abs(wrapped(poses[near, 2] - found[2]))
        seen = compose(found[:3], np.array([*self.front.views[k], 0.0]))
        cost = np.minimum(cost, np.hypot(*(views[near] - seen[:2]).T) + 1.0)
        chosen = near[np.argsort(cost, kind="stable")[:5]]
        pose, system = found[:3].copy(), np.zeros(16)
        stride = max(fan.beams // 180, 1)
        align(store, fan, k, chosen, poses[chosen], pose, np.full(3, 1.0), _ROUNDS, stride, system)
        share = system[10] / max(system[11], 1.0)
        points = np.count_nonzero(store.weights[k]) / stride
        if share < 0.6 or system[11] < 1.5 * points or np.hypot(*(pose[:2] - found[:2])) > 0.3:
            return None
        to = int(chosen[0])
        information = np.diag([1.0 / 0.05**2, 1.0 / 0.05**2, 1.0 / 0.01**2])
        return FoundLoop(k, to, between(poses[to], pose), information, float(share))


def _step_information(step: Floats, match: Floats, heading: float) -> Floats:
    """(3, 3) how surely a step (3,) from keyframe to keyframe is known, in the frame of the first.

    Args:
        step: The motion.
        match: (6,) upper triangle of what the match of the second says, in the frame of the poses.
        heading: Of the first [rad].
    """
    length, turn = float(np.hypot(step[0], step[1])), abs(float(step[2]))
    cos, sin = np.cos(heading), np.sin(heading)
    rotation = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    seen = _INDEPENDENT * rotation.T @ match[_UPPER] @ rotation
    shift, turning = motion_spread(step)
    known = seen + np.diag([shift**-2, shift**-2, turning**-2])
    least = np.diag([(0.006 + 0.015 * length) ** 2] * 2 + [(0.002 + 0.01 * turn) ** 2])
    information: Floats = np.linalg.inv(least + np.linalg.inv(known))
    return information
