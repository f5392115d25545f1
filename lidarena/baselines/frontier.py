"""Frontier exploration: ROS's explore_lite on the SLAM map, driven with the environment's own actions."""

import math
from typing import Any

import numpy as np

from lidarena.baselines.driving import Driver, Terrain
from lidarena.baselines.registry import register
from lidarena.baselines.robot import Robot
from lidarena.planning.frontiers import Frontier, find_frontiers, nearest_cell
from lidarena.world.refusals import ConfigError

_SAME_GOAL = 0.25  # goals nearer to each other than this, in x and in y, are one (m); explore_lite's five cells
_FAR_GOAL = 3.0  # a frontier whose nearest reachable cell is farther away than this is behind something (m)
_SAME_FRONTIER = 1.0  # a frontier with a cell so near to the goal is the one that was driven to (m)
_TRIES = 3


@register("frontier", family="exploration")
class FrontierPolicy:
    """Drives to the frontier with the least cost (almost always the largest) until there is none left.

    The search and its cost are explore_lite's (:mod:`lidarena.planning.frontiers`). A goal is planned again once a
    second, on arrival, and when something new stands in the way; it is given up for good after ``progress_timeout``
    without progress, if nothing leads there, or if the frontier is still there ``arrival_patience`` after arrival.

    explore_lite stops when only frontiers below ``min_frontier_size`` are left, which leaves pockets behind furniture
    and in corners unseen. Here a second pass then fetches those down to ``last_frontier_size``; set it to
    ``min_frontier_size`` for explore_lite's own behaviour.

    Attributes:
        finished: Whether no frontier is left; the robot then keeps turning to the left.
        frontiers: Those of the last planning instant, the best first, in cells of ``terrain``.
    """

    def __init__(
        self,
        env: Any,
        *,
        min_frontier_size: float = 0.5,
        last_frontier_size: float = 0.2,
        potential_scale: float = 1e-3,
        gain_scale: float = 1.0,
        planner_period: float = 1.0,
        progress_timeout: float = 30.0,
        arrival_patience: float = 2.0,
        persistence: float = 0.5,
    ) -> None:
        """Make it for an exploration environment.

        Args:
            env: The environment.
            min_frontier_size: Smallest frontier of the first pass (m).
            last_frontier_size: Smallest frontier of the second pass (m).
            potential_scale: Weight of the distance in a frontier's cost.
            gain_scale: Weight of its size.
            planner_period: Time between two planning instants (s).
            progress_timeout: A goal is given up after this time without progress (s).
            arrival_patience: How long to look around at a goal whose frontier does not vanish (s).

            persistence: How much less another frontier must cost (m) for the robot to turn away from the one it is
                driving to, as long as that one has not vanished; 0 = explore_lite.

        Raises:
            ConfigError: for an option that is negative or not finite.
        """
        options = {
            "min_frontier_size": min_frontier_size,
            "last_frontier_size": last_frontier_size,
            "potential_scale": potential_scale,
            "gain_scale": gain_scale,
            "planner_period": planner_period,
            "progress_timeout": progress_timeout,
            "arrival_patience": arrival_patience,
            "persistence": persistence,
        }
        for name, value in options.items():
            if not 0.0 <= value < math.inf:
                raise ConfigError(f"{name} = {value}, allowed are finite numbers >= 0")
        self._sizes = sorted({min_frontier_size, min(last_frontier_size, min_frontier_size)}, reverse=True)
        self._persistence = persistence
        self._scales = (potential_scale, gain_scale)
        robot = Robot(env)
        self._every = max(1, round(planner_period / robot.period))
        self._timeout = math.ceil(progress_timeout / robot.period)
        self._patience = math.ceil(arrival_patience / robot.period)
        self.driver = Driver(robot)
        self.reset()

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; nothing here is random."""
        self.driver.reset()
        self.finished = False
        self.frontiers: list[Frontier] = []
        self._given_up: list[tuple[float, float]] = []
        self._failed: list[tuple[tuple[float, float], int]] = []
        self._step = self._planned_at = self._progress_at = self._last_found_at = 0
        self._target: tuple[float, float] | None = None
        self._arrived_at: int | None = None
        self._shortest = math.inf

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action.

        Args:
            observation: The environment's; only its beams are used.
            info: The environment's; ``map``, ``resolution``, ``origin`` and ``pose`` are used.
        """
        self._step += 1
        self.driver.sense(observation, info)
        if not self.finished and self._is_due():
            self._planned_at = self._step
            self._plan()
        return self.driver.action()

    def _is_due(self) -> bool:
        if self._step - self._planned_at >= self._every or self._step == 1:
            return True
        return self.driver.must_plan or (self.driver.arrived and self._arrived_at is None)

    def _plan(self) -> None:
        self._watch_progress()
        terrain = self.driver.survey()
        if terrain is None:
            return
        for size in self._sizes:
            self.frontiers = self._search(terrain, size)
            for frontier in self.frontiers:
                if self._set_out(frontier, terrain):
                    self._last_found_at = self._step
                    return
        self.driver.stop()
        self.finished = self._step - self._last_found_at >= self._patience  # SLAM may be a scan behind

    def _search(self, terrain: Terrain, size: float) -> list[Frontier]:
        found = find_frontiers(
            terrain.occupancy, terrain.cell, terrain.around.resolution, size, *self._scales, goals=terrain.reachable
        )
        if self._target is None or not found:
            return found
        row, col = terrain.around.cell(*self._target)
        apart = [math.sqrt(((frontier.cells - (row, col)) ** 2).sum(axis=1).min()) for frontier in found]
        kept = int(np.argmin(apart))
        if apart[kept] * terrain.around.resolution > _SAME_FRONTIER:
            return found
        return sorted(found, key=lambda f: f.cost - (self._persistence if f is found[kept] else 0.0))

    def _set_out(self, frontier: Frontier, terrain: Terrain) -> bool:
        """Set out for a frontier: to its middle, or if that is of no use to its cell nearest to the robot."""
        nearest = frontier.cells[np.argmin(((frontier.cells - np.array(terrain.cell)) ** 2).sum(axis=1))]
        for cell, wanted in (
            (frontier.goal, frontier.centroid),
            (nearest_cell(terrain.reachable, float(nearest[0]), float(nearest[1])), (nearest[0], nearest[1])),
        ):
            if math.dist(cell, wanted) * terrain.around.resolution > _FAR_GOAL:
                continue
            x, y = terrain.around.points(np.array([cell]))[0]
            goal = (float(x), float(y))
            if self._is_given_up(goal):
                continue
            if self.driver.go(goal, terrain):
                self._note_goal(goal)
                return True
            self._note_failure(goal)
        return False

    def _note_failure(self, goal: tuple[float, float]) -> None:
        """Give a goal up that cannot be set out for at three planning instants: one may be due to a bad pose."""
        steps = [step for other, step in self._failed if _is_same(goal, other)]
        if not steps or self._step - steps[-1] >= self._every:
            self._failed.append((goal, self._step))
            if len(steps) + 1 >= _TRIES:
                self._given_up.append(goal)
        self._last_found_at = self._step

    def _is_given_up(self, goal: tuple[float, float]) -> bool:
        return any(_is_same(goal, other) for other in self._given_up)

    def _note_goal(self, goal: tuple[float, float]) -> None:
        if self._target is None or not _is_same(goal, self._target):
            self._target, self._arrived_at = goal, None
            self._progress_at, self._shortest = self._step, math.inf

    def _watch_progress(self) -> None:
        """Give the goal up if it has been reached in vain or comes no nearer."""
        if self.driver.goal is None:
            return
        remaining = self.driver.remaining
        if remaining < self._shortest - 0.05:
            self._shortest, self._progress_at = remaining, self._step
        if self.driver.arrived and self._arrived_at is None:
            self._arrived_at = self._step
        in_vain = self._arrived_at is not None and self._step - self._arrived_at >= self._patience
        if in_vain or self._step - self._progress_at >= self._timeout:
            self._given_up.append(self.driver.goal)


def _is_same(goal: tuple[float, float], other: tuple[float, float]) -> bool:
    return abs(goal[0] - other[0]) < _SAME_GOAL and abs(goal[1] - other[1]) < _SAME_GOAL
