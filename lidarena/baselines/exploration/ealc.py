"""Exploration with active loop closing (EALC): frontiers, interrupted by visits to where the robot has been before.

DA-SLAM compares with this method (Alcalde et al., section V-B); it goes back to Stachniss, Hähnel & Burgard,
"Exploration with active loop-closing for FastSLAM" (IROS 2004), as in ROS's ``explore``.
"""

import math
from typing import Any, Literal, get_args

import numpy as np

from lidarena.base.errors import ConfigError, suggest
from lidarena.baselines.exploration.driving import Terrain
from lidarena.baselines.exploration.frontier import FrontierPolicy
from lidarena.baselines.exploration.topological_graph import TopologicalGraph
from lidarena.baselines.registry import register
from lidarena.planning.grid.frontiers import nearest_cell

Uncertainty = Literal["d_optimality", "entropy"]
_OFF_NODE = 1.0  # a node farther than this from every reachable cell cannot be visited (m)


@register("ealc", family="exploration")
class EalcPolicy(FrontierPolicy):
    """Frontier exploration that closes loops on purpose.

    A topological graph keeps where the robot has been, and how uncertain its pose was there. At every planning instant
    the poses of interest are the nodes that are near in a straight line, far along the graph, and had less uncertainty
    than the robot has now. If there are any, the robot drives to the nearest and on along the nodes in the order in
    which they were made, until on reaching one its uncertainty is back at the level of the first, or for ``retrace``.
    When no frontier is left, it visits once more, the last first, the nodes whose uncertainty exceeded the mean, and is
    finished.

    The authors print "the entropy is higher than the entropy of x_t" for the nodes of interest. By that reading the
    visit is over on arrival, as the robot is more certain than the node already; ``as_printed=True`` does so.

    The authors' distances, 6 m and 20 m, assume larger buildings; here they are shares of the longer side of the map as
    known so far.

    Attributes:
        graph: The topological graph, for drawing.
        finished: Whether no frontier and nothing to visit is left.
    """

    def __init__(
        self,
        env: Any,
        *,
        near: float = 0.3,
        far: float = 0.6,
        retrace: float = 0.5,
        node_distance: float = 2.5,
        uncertainty: Uncertainty = "d_optimality",
        as_printed: bool = False,
        revisit: bool = True,
        min_frontier_size: float = 0.5,
        last_frontier_size: float = 0.2,
        persistence: float = 0.5,
    ) -> None:
        """Make it for an exploration environment.

        Args:
            env: The environment.
            near: Largest straight distance of a node of interest, as a share of the longer side of the known map.
            far: Least distance along the graph, as a share of the same.
            retrace: How far to drive on along the nodes at most, as a share of the same; 0 = only to the first.
            node_distance: Distance between nodes (m).
            uncertainty: What is compared: ``info["d_optimality"]`` or ``info["entropy"]``.
            as_printed: Whether nodes of interest must have *more* uncertainty than the robot.
            revisit: Whether uncertain nodes are visited once more at the end.
            min_frontier_size: As for ``frontier`` (m).
            last_frontier_size: As for ``frontier`` (m).
            persistence: As for ``frontier`` (m).

        Raises:
            ConfigError: for an option out of range.
        """
        for name, value in {"near": near, "far": far, "retrace": retrace, "node_distance": node_distance}.items():
            if not 0.0 <= value < math.inf:
                raise ConfigError(f"{name} = {value}, allowed are finite numbers >= 0")
        if uncertainty not in get_args(Uncertainty):
            raise ConfigError(f"unknown uncertainty {uncertainty!r}{suggest(str(uncertainty), get_args(Uncertainty))}")
        self._near, self._far, self._retrace, self._node_distance = near, far, retrace, node_distance
        self._key, self._as_printed, self._revisits = uncertainty, as_printed, revisit
        super().__init__(
            env,
            min_frontier_size=min_frontier_size,
            last_frontier_size=last_frontier_size,
            persistence=persistence,
        )

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; nothing here is random."""
        super().reset(seed)
        self.graph = TopologicalGraph(self._node_distance)
        self._uncertainty = math.nan
        self._tour: list[int] = []  # nodes to visit, the next one first
        self._level = -math.inf  # uncertainty at which the tour ends
        self._visited: set[int] = set()  # nodes that a tour has begun with
        self._has_revisited = False

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action.

        Args:
            observation: The environment's; only its beams are used.
            info: The environment's; what ``frontier`` uses, and ``d_optimality`` or ``entropy``.

        Raises:
            ConfigError: The environment's estimator has no entropy, which was to be compared.
        """
        if self._key not in info:
            raise ConfigError(f"the environment's estimator gives no {self._key}; choose uncertainty='d_optimality'")
        self._uncertainty = float(info[self._key])
        return super().act(observation, info)

    def _set_out(self, terrain: Terrain) -> bool:
        self.graph.update(self.driver.pose, self._uncertainty, terrain.around)
        if not self._tour:
            self._begin_tour(terrain)
        if self._go_on(terrain) or super()._set_out(terrain):
            return True
        if self._revisits and not self._has_revisited:
            self._has_revisited = True
            self._tour, self._level = self._uncertain_nodes(), -math.inf
        return self._go_on(terrain)

    def _begin_tour(self, terrain: Terrain) -> None:
        """Look for a loop to close."""
        if self._has_revisited:
            return
        interesting = self.nodes_of_interest(terrain)
        if interesting:
            first = min(interesting, key=lambda node: math.dist(self.graph.positions[node], self.driver.pose[:2]))
            self._visited.add(first)
            self._tour = self._track(first, self._retrace * _extent(terrain))
            self._level = self.graph.uncertainties[first]

    def _track(self, first: int, length: float) -> list[int]:
        """``first`` and the nodes made after it, as far as ``length`` (m)."""
        track = [first]
        for node in range(first + 1, len(self.graph.positions)):
            length -= math.dist(self.graph.positions[node], self.graph.positions[node - 1])
            if length < 0.0:
                break
            track.append(node)
        return track

    def nodes_of_interest(self, terrain: Terrain) -> list[int]:
        """Return the nodes that are near but far along the graph, and more certain than the robot is now."""
        extent = _extent(terrain)
        travelled = self.graph.distances()
        return [
            node
            for node, position in enumerate(self.graph.positions)
            if node not in self._visited
            and math.dist(position, self.driver.pose[:2]) < self._near * extent
            and travelled[node] > self._far * extent
            and (self.graph.uncertainties[node] > self._uncertainty) == self._as_printed
        ]

    def _uncertain_nodes(self) -> list[int]:
        """The nodes with more than the mean uncertainty, the last first."""
        mean = float(np.mean(self.graph.uncertainties))
        return [node for node in reversed(range(len(self.graph.positions))) if self.graph.uncertainties[node] > mean]

    def _go_on(self, terrain: Terrain) -> bool:
        """Drive on to the next node of the tour; whether there is one."""
        while self._tour:
            node = self._tour[0]
            if (
                math.dist(self.graph.positions[node], self.driver.pose[:2])
                <= self.driver.arrival + terrain.around.resolution
            ):
                self._tour.pop(0)
                if self._uncertainty <= self._level:
                    self._tour.clear()
            elif self._drive_to(node, terrain):
                return True
            else:
                self._tour.pop(0)
        return False

    def _drive_to(self, node: int, terrain: Terrain) -> bool:
        x, y = self.graph.positions[node]
        row, col = terrain.around.cell(x, y)
        cell = nearest_cell(terrain.reachable, row, col)
        if cell[0] < 0 or math.dist(cell, (row, col)) * terrain.around.resolution > _OFF_NODE:
            return False
        x, y = terrain.around.points(np.array([cell]))[0]
        goal = (float(x), float(y))
        if self._blacklist.is_given_up(goal) or not self.driver.go(goal, terrain):
            return False
        self._blacklist.pursue(goal, self._step)
        return not self.driver.arrived


def _extent(terrain: Terrain) -> float:
    """The longer side of the known map (m)."""
    return float(max(terrain.occupancy.shape) * terrain.around.resolution)
