"""The topological map of active loop closing (Stachniss, Hähnel & Burgard 2004): where the robot has been, coarsely."""

import heapq
import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lidarena.planning.grid.surroundings import Surroundings, in_sight


@dataclass
class TopologicalGraph:
    """Places that the robot has passed, joined where it drove from one to the other.

    A place becomes a node when every node is farther away than ``node_distance`` or out of sight.

    Attributes:
        node_distance: As above (m).
        positions: x, y of the nodes, in the order of their creation.
        uncertainties: Uncertainty of the pose when they were created.
        edges: Pairs (i, j), i < j.
        current: The node where the robot is, None before the first.
    """

    node_distance: float = 2.5
    positions: list[tuple[float, float]] = field(default_factory=list)
    uncertainties: list[float] = field(default_factory=list)
    edges: set[tuple[int, int]] = field(default_factory=set)
    current: int | None = None

    def update(self, pose: NDArray[np.float64], uncertainty: float, around: Surroundings) -> bool:
        """Note where the robot is.

        Args:
            pose: (3,) x, y, theta.
            uncertainty: Of the pose.
            around: What is known around it.

        Returns:
            Whether this has become a new node.
        """
        here = self._node_at(pose, around)
        is_new = here is None
        if here is None:
            here = len(self.positions)
            self.positions.append((float(pose[0]), float(pose[1])))
            self.uncertainties.append(uncertainty)
        if self.current is not None and self.current != here:
            self.edges.add((min(here, self.current), max(here, self.current)))
        self.current = here
        return is_new

    def _node_at(self, pose: NDArray[np.float64], around: Surroundings) -> int | None:
        """The nearest node in sight, the oldest of equals."""
        best, least = None, math.inf
        for node, position in enumerate(self.positions):
            away = math.dist(position, pose[:2])
            if away > self.node_distance or away >= least:
                continue
            if in_sight(around, pose, np.array(position)):
                best, least = node, away
        return best

    def distances(self) -> list[float]:
        """Return the length (m) of the shortest way along the edges from the current node to every node."""
        lengths = [math.inf] * len(self.positions)
        if self.current is None:
            return lengths
        lengths[self.current] = 0.0
        queue = [(0.0, self.current)]
        neighbours = self._neighbours()
        while queue:
            travelled, node = heapq.heappop(queue)
            if travelled > lengths[node]:
                continue
            for other in neighbours[node]:
                length = travelled + math.dist(self.positions[node], self.positions[other])
                if length < lengths[other]:
                    lengths[other] = length
                    heapq.heappush(queue, (length, other))
        return lengths

    def _neighbours(self) -> list[list[int]]:
        neighbours: list[list[int]] = [[] for _ in self.positions]
        for i, j in sorted(self.edges):
            neighbours[i].append(j)
            neighbours[j].append(i)
        return neighbours
