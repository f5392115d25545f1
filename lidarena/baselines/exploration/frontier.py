"""Frontier exploration: ROS's explore_lite on the SLAM map, driven with the environment's own actions."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import check_range
from lidarena.baselines.exploration.driving import Driver, Terrain
from lidarena.baselines.exploration.goal_tracker import Goal, GoalBlacklist, is_same
from lidarena.baselines.exploration.robot_interface import Robot
from lidarena.baselines.registry import register
from lidarena.planning.driving.explorer import ENDINGS, EXPLORED, FRUITLESS, OUT_OF_REACH, UNFINISHED
from lidarena.planning.grid.frontiers import Frontier, find_frontiers, nearest_cell

_FAR_GOAL = 3.0  # a frontier whose nearest reachable cell is farther away than this is behind something (m)
_SAME_FRONTIER = 1.0  # a frontier with a cell so near to the goal is the one that was driven to (m)
_BESIDE = 1.0  # a goal so near that still cannot be driven to is too narrow a place (m)
_HOLLOW = 1.5  # a frontier whose middle is farther than this from all its cells runs around known ground (m)
_VIEW = 2.0  # a frontier longer than so many ranges of the lidar is worth no more than one of this length
_TURNING = 0.8  # metres that a radian of turning is worth where a frontier runs around the robot
_TRIED = 8  # places of such a frontier that are tried at one planning instant, at most
_ENCLOSED = 20.0  # so long it waits where frontiers are left, but no way to them: another pose may open one (s)
_GROWTH = 0.001  # growth of the known map that justifies a second pass


def _known(terrain: Terrain) -> int:
    """Cells of the map that are known."""
    return int(np.count_nonzero(terrain.occupancy >= 0))


def _checked_robot(env: Any, options: Mapping[str, float], clearance: float | None) -> Robot:
    """The environment's robot, once the options are found to make sense.

    Raises:
        ConfigError: See ``FrontierPolicy``.
    """
    for name, value in options.items():
        if not 0.0 <= value < math.inf:
            raise ConfigError(f"{name} = {value}, allowed are finite numbers >= 0")
    robot = Robot(env)
    if clearance is not None:
        check_range("clearance", clearance, robot.spec.bumper, 10.0)
    return robot


@register("frontier", family="exploration")
class FrontierPolicy:
    """Drives to the frontier with the least cost (almost always the largest) until there is none left.

    The search and its cost are explore_lite's (:mod:`lidarena.planning.grid.frontiers`). A goal is planned again once a
    second, on arrival, and when something new stands in the way; it is given up for good after ``progress_timeout``
    without progress, if nothing leads there, or if the frontier is still there ``arrival_patience`` after arrival.

    Two things differ from explore_lite, each with an option that takes it back. explore_lite stops when only frontiers
    below ``min_frontier_size`` are left, and so leaves pockets behind furniture and in corners unseen: here a second
    pass then fetches those down to ``last_frontier_size``, the nearest first (``last_frontier_size=0.5`` for
    explore_lite). And explore_lite turns round whenever another frontier has become a cell larger, which costs a robot
    that needs ten seconds for turning round dear: here another one must be better by ``persistence`` (0 for
    explore_lite).

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
        last_pass_timeout: float = 60.0,
        clearance: float | None = None,
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
            last_pass_timeout: The second pass ends when this time (s) has not added 0.1% to the map.
            clearance: How far the robot's way keeps from walls (m): frontiers behind narrower doors are out of reach.
                None: the ``clearance`` of the environment's robot, by which completeness counts as well, or else 0.22
                for DA-SLAM's robot and more for larger ones.

        Raises:
            ConfigError: for an option that is negative or not finite, or a clearance at which the robot collides.
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
            "last_pass_timeout": last_pass_timeout,
        }
        robot = _checked_robot(env, options, clearance)
        self._sizes = sorted({min_frontier_size, min(last_frontier_size, min_frontier_size)}, reverse=True)
        self._scales = (potential_scale, gain_scale)
        self._persistence = persistence
        self._view = _VIEW * robot.sight
        self._every = max(1, round(planner_period / robot.period))
        self._timeout = math.ceil(progress_timeout / robot.period)
        self._patience = math.ceil(arrival_patience / robot.period)
        self._enclosed = math.ceil(_ENCLOSED / robot.period)
        self._last_pass = math.ceil(last_pass_timeout / robot.period)
        self.driver = Driver(robot, clearance)
        self.reset()

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; nothing here is random."""
        self.driver.reset()
        self.finished, self._ending = False, UNFINISHED
        self.frontiers: list[Frontier] = []
        self._blacklist = GoalBlacklist(self._timeout, self._patience)
        self._step = self._planned_at = self._wanted_at = 0
        self._known, self._grown_at = 0, 0

    @property
    def ending(self) -> str:
        """Why the exploration has ended, one of ``ENDINGS``; empty before it has."""
        return ENDINGS[self._ending] if self.finished else ""

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action.

        Args:
            observation: The environment's; only its beams are used.
            info: The environment's; ``map``, ``resolution``, ``origin`` and ``pose`` are used. Once it has finished,
                ``ending`` tells why.
        """
        self._step += 1
        self.driver.sense(observation, info)
        if not self.finished and self._is_due():
            self._planned_at = self._step
            self._plan()
        if self.finished:
            info["ending"] = self.ending
        return self.driver.action()

    def _is_due(self) -> bool:
        if self.driver.retreats:
            return False
        if self._step - self._planned_at >= self._every or self._step == 1:
            return True
        return self.driver.must_plan or (self.driver.arrived and self._blacklist.arrived_at is None)

    def _plan(self) -> None:
        """Choose a goal and set out for it; explore_lite's makePlan."""
        if self.driver.goal is not None:
            self._blacklist.watch(self.driver.remaining, self.driver.arrived, self._step)
        terrain = self.driver.survey()
        if terrain is not None and self._set_out(terrain):
            self._wanted_at = self._step
            return
        self.driver.stop()
        if terrain is None:
            return
        out_of_reach = self._ending == OUT_OF_REACH
        if out_of_reach and self._blacklist.pardon(_known(terrain)):
            self._wanted_at = self._step
            return
        # SLAM may be a scan behind, so that nothing left must stay so for a while
        waits = out_of_reach and self._are_some_apart(terrain)
        self.finished = self._step - self._wanted_at >= (self._enclosed if waits else self._patience)

    def _are_some_apart(self, terrain: Terrain) -> bool:
        """Whether there is any frontier to which no way comes near."""
        return any(next(self._goals(one, terrain), None) is None for one in self.frontiers)

    def _is_enclosed(self, terrain: Terrain) -> bool:
        """Whether nothing can be reached for a while, and the map shows no way to where the robot came from either."""
        waited = self._step - self._wanted_at >= self._patience
        return waited and self._are_some_apart(terrain) and self.driver.is_cut_off(terrain)

    def _goes_back(self, terrain: Terrain) -> bool:
        """Whether there are frontiers, and the robot drives back to where it came from."""
        known = _known(terrain)
        if not self.frontiers or not self._blacklist.may_retreat(known) or not self.driver.retreat():
            return False
        self._blacklist.note_retreat(known)
        return True

    def _set_out(self, terrain: Terrain) -> bool:
        """Set out for the best frontier; whether there is still one that is worth it."""
        for size in self._sizes:
            self.frontiers = self._search(terrain, size)
            if self._is_last(size) and self._is_exhausted(terrain):
                self._ending = FRUITLESS
                return False
            if self.driver.is_caught and self._goes_back(terrain):
                return True
            if self._pursue(self.frontiers, terrain):
                return True
        self._ending = OUT_OF_REACH if self.frontiers else EXPLORED
        if self._is_enclosed(terrain) and self._goes_back(terrain):
            return True
        return self.driver.is_cornered and bool(self.frontiers)

    def _pursue(self, frontiers: Sequence[Frontier], terrain: Terrain) -> bool:
        """Set out for the first of some frontiers that can be driven to; whether there is one."""
        for frontier in frontiers:
            for goal in self._goals(frontier, terrain):
                if self._blacklist.is_given_up(goal):
                    continue
                if self.driver.go(goal, terrain):
                    self._blacklist.pursue(goal, self._step)
                    return True
                if self.driver.is_cornered:
                    continue  # nothing can be said of this goal; any other that leads out of here is welcome
                if not self._blacklist.fail(goal, math.dist(goal, self.driver.pose[:2]) < _BESIDE):
                    self.driver.stop()
                    return True  # turn on the spot and try again, rather than drive elsewhere and come back
        return False

    def _search(self, terrain: Terrain, size: float) -> list[Frontier]:
        """The frontiers of one pass, the best first."""
        resolution = terrain.around.resolution
        found = find_frontiers(
            terrain.occupancy, terrain.cell, resolution, size, *self._scales, goals=terrain.reachable
        )
        kept = self._pursued(found, terrain)

        def cost(frontier: Frontier) -> float:
            own = frontier.min_distance * resolution if self._is_last(size) else frontier.cost
            if not self._is_last(size):  # what is longer than the lidar sees at once is worth no detour
                own += self._scales[1] * max(frontier.size * resolution - self._view, 0.0)
            return own - (self._persistence if frontier is kept else 0.0)

        return sorted(found, key=cost)

    def _is_last(self, size: float) -> bool:
        """Whether the pass for frontiers of a size (m) is the second one."""
        return size < self._sizes[0]

    def _is_exhausted(self, terrain: Terrain) -> bool:
        """Whether the map has hardly grown for too long."""
        known = _known(terrain)
        if known > (1.0 + _GROWTH) * self._known:
            self._known, self._grown_at = known, self._step
        return self._step - self._grown_at >= self._last_pass

    def _pursued(self, found: list[Frontier], terrain: Terrain) -> Frontier | None:
        """The frontier that is being driven to, as far as it can be recognised: the one nearest to the goal."""
        if self._blacklist.pursued is None or not found:
            return None
        cell = terrain.around.cell(*self._blacklist.pursued)
        apart = [math.sqrt(((frontier.cells - cell) ** 2).sum(axis=1).min()) for frontier in found]
        nearest = int(np.argmin(apart))
        return found[nearest] if apart[nearest] * terrain.around.resolution <= _SAME_FRONTIER else None

    def _goals(self, frontier: Frontier, terrain: Terrain) -> Iterator[Goal]:
        """Where to go for a frontier: to its middle, or if that is of no use to its cell nearest to the robot.

        The middle of one that runs around known ground, as in a hall wider than the lidar sees, is of no use: it lies
        in known ground, and the robot would drive back there again and again.
        """
        if self._runs_around(frontier, terrain.around.resolution):
            yield from self._ahead(frontier, terrain)
            return
        row, col = frontier.cells[np.argmin(((frontier.cells - np.array(terrain.cell)) ** 2).sum(axis=1))].tolist()
        for cell, wanted in (
            (frontier.goal, frontier.centroid),
            (nearest_cell(terrain.reachable, row, col), (row, col)),
        ):
            if math.dist(cell, wanted) * terrain.around.resolution <= _FAR_GOAL:
                x, y = terrain.around.points(np.array([cell]))[0]
                yield float(x), float(y)

    def _ahead(self, frontier: Frontier, terrain: Terrain) -> Iterator[Goal]:
        """Where a frontier is near to the robot, the nearest place first, of equally near ones what lies ahead."""
        offsets = frontier.cells - np.array(terrain.cell)
        away = np.hypot(offsets[:, 0], offsets[:, 1]) * terrain.around.resolution
        turn = np.arctan2(offsets[:, 0], offsets[:, 1]) - self.driver.pose[2]
        turn = np.abs((turn + math.pi) % (2.0 * math.pi) - math.pi)
        order = np.argsort(away + _TURNING * turn, kind="stable")
        tried: list[Goal] = []
        left = _TRIED
        for (row, col), place in zip(frontier.cells[order], terrain.around.points(frontier.cells[order]), strict=True):
            if any(is_same((place[0], place[1]), other) for other in tried):
                continue
            tried.append((place[0], place[1]))
            x, y = terrain.around.points(np.array([nearest_cell(terrain.reachable, row, col)]))[0].tolist()
            if not self._blacklist.is_given_up((x, y)):
                yield x, y
                left -= 1
            if not left:
                return

    def _runs_around(self, frontier: Frontier, resolution: float) -> bool:
        """Whether a frontier is longer than the lidar sees at once and its middle is far from all of it."""
        if frontier.size * resolution <= self._view:
            return False
        offsets = frontier.cells - np.array(frontier.centroid)
        return bool(math.sqrt((offsets**2).sum(axis=1).min()) * resolution > _HOLLOW)
