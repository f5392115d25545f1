"""The back end: loops are searched on the way, verified, and all keyframes moved to where everything fits."""

from dataclasses import dataclass, replace
from itertools import takewhile

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from lidarena.slam.graph.correlation import best_in_window, draw_scan, empty_grid
from lidarena.slam.graph.front_end import FrontEnd, viewed
from lidarena.slam.graph.graph_nodes import GraphNodes
from lidarena.slam.graph.known_places import known_from, loosened
from lidarena.slam.graph.odometry_spread import motion_spread
from lidarena.slam.graph.optimization import Edges, joined, optimized, optimized_end
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
_END = 60
"""Nodes at the end of the way that a loop moves by themselves, and of which none is dropped."""
_SELDOM = 50.0
"""Keyframes from one moving of all nodes to the next, at least: their number over this, so that a scan's share of the
time does not grow with the map."""
_TIED = 15.0
"""Where a loop leads to a place that is nearer along the graph already, no second one is searched at the time [m]."""
_FARTHEST = 200.0
"""Ways along the graph beyond this make no place more uncertain [m]."""
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
        front: The front end; its scans are read only, and those of keyframes that are dropped are given back to it.
        visits: Keyframes of places that were visited so often before are dropped once loops have tied them to those
            visits, so that the graph of a building that is known does not grow; None keeps all.

    Attributes:
        loops: All loops found.
        nodes: The keyframes that were kept.
        ties: Of each that was dropped its number, a kept one's, and its pose seen from that one.
    """

    def __init__(self, front: FrontEnd, visits: int | None = None) -> None:
        self.front, self.visits, self.grid = front, visits, empty_grid()
        self.loops, self.nodes, self.ties = list[FoundLoop](), GraphNodes(), list[tuple[int, int, Floats]]()
        self._tied: list[FoundLoop] = []
        self._keyframes, self._decided, self._moved_all = 0, 0, 0

    @property
    def poses(self) -> Floats:
        """(N, 3) of the nodes."""
        return self.nodes.columns.poses

    def corrected(self, pose: Floats) -> Floats:
        """Where a pose (3,) of the front end's last scan really is."""
        if not self.nodes.count:
            return pose
        return compose(self.poses[-1], between(self.front.node(self._keyframes - 1), pose))

    def extend(self) -> bool:
        """Take in the keyframe that the front end took last, and search loops from it if it is its turn.

        Returns:
            Whether a loop was closed.
        """
        k, front, nodes = self._keyframes, self.front, self.nodes
        self._keyframes += 1
        if k == 0:
            nodes.append(0, front.node(0), 0.0, front.views[0])
            return False
        step, last = between(front.node(k - 1), front.node(k)), nodes.count - 1
        way = float(nodes.columns.ways[last] + np.hypot(step[0], step[1]))
        nodes.append(k, compose(nodes.columns.poses[last], step), way, front.views[k])
        nodes.tie(last + 1, k - 1, step, _step_information(step, front.information[k], front.node(k - 1)[2]))
        if k < 2 * _CHUNK or k % _CHUNK:
            return False
        found = self._search(nodes.count - 1)
        self.loops += found
        self._tied += found
        if found:
            self._close()
        if self.visits is not None:
            self._drop_known(self.visits)
        return bool(found)

    def fitted(self) -> Floats:
        """(N, 3) poses of the nodes, as all that is known fits best."""
        return optimized(self.poses, self._edges(), 10) if self._tied else self.poses.copy()

    def loop_edges(self, first: int = 0) -> Edges:
        """The loops from the node in place ``first`` and later ones, as edges."""
        least = self.nodes.columns.numbers[first] if self._tied else 0
        loops = [one for one in self._tied if one.later >= least]
        if not loops:
            return Edges(np.zeros((0, 2), np.int64), np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0))
        motions, information = (np.array([getattr(one, n) for one in loops]) for n in ("motion", "information"))
        return Edges(self._ends(loops), motions, information, np.full(len(loops), _DOUBT))

    def _ends(self, loops: list[FoundLoop]) -> NDArray[np.int64]:
        """(L, 2) places of the nodes that loops tie."""
        return self.nodes.places(np.array([(one.earlier, one.later) for one in loops], np.int64).reshape(-1, 2))

    def way_edges(self, first: int = 1) -> Edges:
        """How the node in place ``first`` and each later one was measured from the one that it is tied to."""
        columns, places = self.nodes.columns, np.arange(first, max(self.nodes.count, first))
        pairs = np.stack([self.nodes.places(columns.sources[first:]), places], axis=1)
        return Edges(pairs, columns.steps[first:], columns.information[first:], np.full(len(places), np.inf))

    def _edges(self, first: int = 1) -> Edges:
        """The way from node to node and the loops, of the node in place ``first`` and later ones."""
        return joined([self.way_edges(first), self.loop_edges(first)])

    def _close(self) -> None:
        """Move the nodes to where the loops just found are met: the last ones alone, if that is enough."""
        poses, first = self.poses, max(self.nodes.count - _END, 1)
        moved, strained = optimized_end(poses, self._edges(first), first, 3)
        if strained and self._keyframes - self._moved_all > self.nodes.count / _SELDOM:
            moved, self._moved_all = optimized(poses, self._edges(), 4, settled=1e-3), self._keyframes
        poses[:] = moved

    def _unclosed(self, n: int) -> Floats:
        """(n,) how far each node before the last, n, is along the graph, where a loop is a short cut [m]."""
        columns = self.nodes.columns
        ways, loops = self.way_edges().pairs, self._ends(self._tied)
        length = np.where(np.diff(ways, axis=1)[:, 0] == 1, np.diff(columns.ways), 0.3)
        pairs, weights = np.concatenate([ways, loops]), np.concatenate([length + 0.02, np.full(len(loops), 0.3)])
        graph = coo_matrix((weights, (pairs[:, 0], pairs[:, 1])), shape=(n + 1, n + 1)).tocsr()
        away: Floats = np.asarray(dijkstra(graph, directed=False, indices=np.array([n]), limit=_FARTHEST))[0, :n]
        return away

    def _drop_known(self, visits: int) -> None:
        """Drop nodes that have left the end and stand where earlier visits have seen enough."""
        nodes, start = self.nodes, self._decided
        numbers = nodes.columns.numbers
        recent = takewhile(lambda one: one.later >= numbers[start] - 2 * _CHUNK, reversed(self._tied))
        later = np.array([one.later for one in recent if _met(one, nodes)], np.int64)
        places = []
        for place in range(start, nodes.count - _END):
            closed = len(later) > 0 and np.abs(later - numbers[place]).min() <= 2 * _CHUNK
            anchor = known_from(nodes.columns, start, place, visits) if closed else -1
            if anchor >= 0:
                places.append(place)
                self._drop(place, anchor)
        self._decided = max(nodes.count - _END, start) - len(places)
        nodes.remove(places)

    def _drop(self, place: int, anchor: int) -> None:
        """Tie what is measured from the node in a place to another one, and forget it."""
        columns = self.nodes.columns
        number, to = int(columns.numbers[place]), int(columns.numbers[anchor])
        seen = between(columns.poses[anchor], columns.poses[place])
        self.ties.append((number, to, seen))
        step, information = compose(seen, columns.steps[place + 1]), columns.information[place + 1]
        self.nodes.tie(place + 1, to, step, loosened(information, float(seen[2])))
        tied = []
        for one in self._tied:
            if one.earlier == number:
                one = replace(one, earlier=to, motion=compose(seen, one.motion))
            if one.later != number:
                tied.append(one)
        self._tied = tied
        self.front.release(number)

    def _search(self, k: int) -> list[FoundLoop]:
        """Loops from the last node, k, to up to three places."""
        poses, way, unclosed = self.poses, self.nodes.columns.ways, self._unclosed(k)
        radius = np.minimum(1.0 + 0.04 * unclosed, 8.0)
        away = np.hypot(poses[:k, 0] - poses[k, 0], poses[:k, 1] - poses[k, 1])
        turned = np.abs(wrapped(poses[:k, 2] - poses[k, 2]))
        views = viewed(poses, self.nodes.columns.views)
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
                if unclosed[target] < _TIED:
                    break
            free[max(target - 40, 0) : target + 40] = False
        return found

    def _verified(self, poses: Floats, views: Floats, k: int, target: int, radius: float) -> FoundLoop | None:
        """The loop from node k to the nodes around a target, if it holds."""
        store, fan, grid, numbers = self.front.store, self.front.fan, self.grid, self.nodes.columns.numbers
        slots, own = self.front.slots(numbers), self.front.slot(int(numbers[k]))
        near = np.arange(max(target - 10, 0), min(target + 11, k))
        for one in near:
            draw_scan(grid, store, int(slots[one]), poses[one], 1)
        window, loose = np.array([radius, 0.12 + 0.04 * radius]), np.array([max(radius, 0.5), 0.5])
        found = best_in_window(grid, store, own, poses[k], window, np.array([0.1, 0.035]), loose, 50)
        fine = np.array([0.1, 0.035]), np.array([0.05, 0.01]), np.array([10.0, 10.0])
        found = best_in_window(grid, store, own, found[:3], *fine, 90)
        for one in near:
            draw_scan(grid, store, int(slots[one]), poses[one], -1)
        if found[3] < 0.55:
            return None
        cost = np.hypot(*(poses[near, :2] - found[:2]).T) + np.abs(wrapped(poses[near, 2] - found[2]))
        seen = compose(found[:3], np.array([*self.nodes.columns.views[k], 0.0]))
        cost = np.minimum(cost, np.hypot(*(views[near] - seen[:2]).T) + 1.0)
        chosen = near[np.argsort(cost, kind="stable")[:5]]
        pose, system = found[:3].copy(), np.zeros(16)
        stride = max(fan.beams // 180, 1)
        align(store, fan, own, slots[chosen], poses[chosen], pose, np.full(3, 1.0), _ROUNDS, stride, system)
        share = system[10] / max(system[11], 1.0)
        points = np.count_nonzero(store.weights[own]) / stride
        if share < 0.6 or system[11] < 1.5 * points or np.hypot(*(pose[:2] - found[:2])) > 0.3:
            return None
        motion = between(poses[chosen[0]], pose)
        information = np.diag([1.0 / 0.05**2, 1.0 / 0.05**2, 1.0 / 0.01**2])
        return FoundLoop(int(numbers[k]), int(numbers[chosen[0]]), motion, information, float(share))


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


def _met(loop: FoundLoop, nodes: GraphNodes) -> bool:
    """Whether the nodes are where a loop says."""
    columns = nodes.columns
    earlier, later = nodes.places(np.array([loop.earlier, loop.later]))
    error = between(columns.poses[earlier], columns.poses[later]) - loop.motion
    return bool(np.hypot(error[0], error[1]) < 0.1 and abs(float(wrapped(error)[2])) < 0.05)
