"""The graph of poses as an environment's estimator, ``slam="graph"``."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import EstimatorError
from lidarena.base.keyword_checks import check_range
from lidarena.slam.estimator import MapGrid, ScanSpec
from lidarena.slam.graph.adjustment import adjusted
from lidarena.slam.graph.mapper import MapParameters, Mapper
from lidarena.slam.graph.optimization import Edges, marginal
from lidarena.slam.graph.traced_keyframes import TracedKeyframes
from lidarena.slam.planar import between, compose, wrapped

Floats = NDArray[np.float64]

_SETTLING = 2
"""Rounds of matching all keyframes with their neighbours, whenever that is due."""
_CONFIDENCE = 0.0025
"""Factor on the covariances of the fit, which believes few of a scan's points, for logs of worse lasers than the
simulated ones: with this the error is as large as its covariance says (``benchmarks/filter_accuracy.py --slam graph``).
"""
_MATCHED = np.array([2e-7, 2e-7, 5e-8])
"""Variances that the match of a single scan adds [m², m², rad²]."""
_DRIFT = np.array([2e-7, 2e-7, 5e-8])
"""Variances that each keyframe since the last fit adds [m², m², rad²]."""


class GraphEstimator:
    """One world's estimator: scans are matched, loops closed and all keyframes fitted to each other again and again.

    It is deterministic; see ``lidarena.slam.estimator.WorldEstimator`` for what an estimator is.

    Args:
        lidar: What its scans are.
        adjust_every: Keyframes from one fit of all to the next.

    Attributes:
        pose: (3,) where the robot is.
        covariance: (3, 3) of it: the marginal covariance of the last fit's last pose, given where the robot began, and
            what has been added since.
        map: (rows, columns) the keyframes' scans, traced from where the last fit puts them.
        loops: Loops that were closed.

    Raises:
        ConfigError: An option out of range.
        EstimatorError: The beams are not evenly spaced.
    """

    def __init__(self, lidar: ScanSpec, *, adjust_every: int = 6) -> None:
        check_range("adjust_every", adjust_every, 1, 1000, whole=True)
        self._lidar, self._every = lidar, adjust_every
        angles = np.unwrap(lidar.angles)
        steps = np.diff(angles)
        if len(angles) < 2 or not np.allclose(steps, steps[0], atol=1e-3):
            raise EstimatorError(f"slam='graph' needs evenly spaced beams, not the {len(angles)} of this lidar")
        self._angles = angles
        self.pose, self.covariance = np.zeros(3), np.zeros((3, 3))
        self.loops = 0

    def reset(self, pose: Floats, grid: MapGrid) -> None:
        """Begin an episode."""
        self._mapper = Mapper(self._angles, self._lidar.max_range, parameters=MapParameters(visits=None))
        self._odometry, self.pose = pose.copy(), pose.copy()
        self._traced = TracedKeyframes(grid, self._lidar)
        self.map = self._traced.occupancy
        self._nodes, self._marginal, self._fitted = np.zeros((0, 3)), np.zeros((3, 3)), 0
        self._past: list[tuple[Floats, NDArray[np.float32], float]] = []
        self.covariance, self.loops = np.diag(_MATCHED), 0

    def update(self, odometry: Floats, scan: NDArray[np.float32], time: float) -> None:
        """Take in what was measured in one decision period."""
        self._past.append((odometry, scan, time))
        self._odometry = compose(self._odometry, odometry)
        if not np.any(scan > 0.0):  # no scan was taken: the wheels tell the way on
            self.pose = compose(self.pose, odometry)
            self.covariance = self.covariance + np.diag(_DRIFT)
            return
        front, before = self._mapper.front, len(self._mapper.front.keyframes)
        self._mapper.add(time, self._odometry, scan)
        taken = len(front.keyframes) > before
        if taken:
            self._nodes = np.concatenate([self._nodes, self._here()[None]])
            self._traced.add(scan, self._nodes[-1])
            closed, self.loops = len(self._mapper.back.loops) > self.loops, len(self._mapper.back.loops)
            if closed or len(self._nodes) - self._fitted >= self._every:
                self._fit(closed)
        self.pose = self._here()
        lately = len(self._nodes) - self._fitted
        self.covariance = self._marginal + np.diag(_MATCHED * (not taken) + _DRIFT * lately)

    def _here(self) -> Floats:
        """(3,) where the last scan was taken: as it was matched, seen from the last keyframe that was fitted."""
        front, last = self._mapper.front, len(self._nodes) - 1
        if last < 0:
            return np.array(front.poses[-1])
        here: Floats = compose(self._nodes[last], between(front.node(last), front.poses[-1]))
        here[2] = wrapped(here[2])
        return here

    def _fit(self, closed: bool) -> None:
        """Fit all keyframes to each other; from where the loops put them if one was closed just now."""
        front, nodes = self._mapper.front, self._nodes
        if len(nodes) > 1:
            if closed:
                nodes = self._mapper.back.fitted()
            self._nodes, edges = adjusted(front, nodes, _SETTLING)
            self._marginal = _CONFIDENCE * _global(self._nodes, edges)
            self._traced.move(self._nodes)
        self._fitted = len(self._nodes)

    def get_state(self) -> dict[str, NDArray[Any]]:
        """Everything that was measured, from which the same is made again."""
        past = self._past
        return {
            "odometry": np.array([each[0] for each in past]).reshape(-1, 3),
            "scans": np.array([each[1] for each in past], np.float32).reshape(-1, len(self._angles)),
            "times": np.array([each[2] for each in past]),
        }

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Continue after ``reset`` from what was measured before."""
        for odometry, scan, time in zip(state["odometry"], state["scans"], state["times"], strict=True):
            self.update(odometry, scan, float(time))


def _global(nodes: Floats, edges: Edges) -> Floats:
    """(3, 3) marginal covariance of the last node in the frame of the world."""
    return marginal(nodes, edges, len(nodes) - 1)
