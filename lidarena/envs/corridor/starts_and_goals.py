"""Where the robots of a team start and where they go: predefined, random but solvable, given, or from a scenario."""

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, ScenarioError, TeamError
from lidarena.base.random_streams import uniform
from lidarena.envs.corridor.options import CorridorOptions
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.grid_graph import UNREACHABLE, GridGraph
from lidarena.planning.team.plan import plan_team
from lidarena.planning.team.well_formed import is_well_formed
from lidarena.planning.team.widest_way import narrowest_place
from lidarena.world.floorplan import Floorplan
from lidarena.world.movingai import load_movingai
from lidarena.world.scenario import load_scenario
from lidarena.world.team_drawings import team_places

CELL = 0.2
"""Side of the cells that teams are planned on, Bennewitz & Burgard's [m]."""
FINER = (0.1, 0.05, 0.025)
"""Sides of the cells where robots fit through doors and corridors that those of ``CELL`` do not show [m]."""
_CENTRED = (0.02, 0.012, 0.0)
"""Room beside the robots for which finer cells must show a way, tried in this order [m]: coarse ones lead along a wall.
On the finest cells there is a way with the second wherever a robot has 2.5 cm on either side."""
_MOST_CELLS = 2**21
LEAST_ROOM = 0.2
"""Random places leave every robot at least a disc of this radius [m]."""
_SPACING = 2
"""Random places lie on every so many cells."""
_DRAWS, _QUICK_DRAWS = 300, 20
"""So often places are drawn; first such that are known to be solvable at a glance, then such that a planner solves."""
_ORDERS = 10

Ends = tuple[NDArray[np.float64], NDArray[np.float64]]


class StartGoalSampler:
    """Starts and goals for the episodes of one floor plan.

    Args:
        options: Checked keywords.
        plan: The floor plan.

    Attributes:
        grid: Cells of the floor plan that are blocked, as fine as it takes to get everyone to the goal.

    Raises:
        ConfigError: The map has no predefined places, or fewer than there are robots.
        ScenarioError: The scenario is missing, torn, of another map or too short.
        TeamError: A start or goal is in a wall, shared, overlapping or out of reach, or a robot fits through no door.
    """

    def __init__(self, options: CorridorOptions, plan: Floorplan) -> None:
        self._options, self._plan = options, plan
        self._fixed = self._given()
        self._candidates = np.empty(0, np.int64)
        for self._strict in (True, False):
            for cell, beside in self._choices():
                self._beside = beside
                self.grid = FloorGrid.of(plan, cell, exact=cell < CELL)
                try:
                    self._look_at()
                    return
                except TeamError as error:
                    refusal = error
        raise refusal

    def _choices(self) -> list[tuple[float, float]]:
        """Sides of cells to try, as far as memory allows, and the room beside the robots that they must show [m]."""
        low_x, low_y, high_x, high_y = self._plan.bounds
        area = (high_x - low_x) * (high_y - low_y)
        finer = [cell for cell in FINER if area / cell**2 <= _MOST_CELLS]
        return [(CELL, 0.0), *((cell, beside) for beside in _CENTRED for cell in finer)]

    def _look_at(self) -> None:
        """Find out where robots can start and go on the grid; raises if they cannot."""
        options = self._options
        if self._fixed is not None:
            self._check(*self._fixed)
            return
        room = max(LEAST_ROOM, options.robot.radius + 0.05)
        self._graph = self.grid.graph(room)
        known = team_places(self._plan.name)
        predefined = self._mode() == "predefined" and known is not None and known.drawn
        self._candidates = self._predefined() if predefined else self._anywhere()

    def draw(self, rng: np.random.Generator) -> Ends:
        """Starts and goals (robots, 2) each of an episode [m].

        Raises:
            TeamError: No solvable problem was found.
        """
        if self._fixed is not None:
            return self._fixed
        robots = self._options.robots
        for draw in range(_DRAWS):
            if len(self._candidates) < robots:
                break
            starts, goals = (rng.choice(self._candidates, robots, replace=False) for _ in range(2))
            apart = self._fits(starts) and self._fits(goals) and (starts != goals).all()
            if apart and (is_well_formed(self._graph, starts, goals) or self._planned(starts, goals, draw)):
                return self._points(starts), self._points(goals)
        raise TeamError(
            f"no solvable starts and goals for {robots} robots were found in map {self._plan.name!r}; "
            "fewer robots, a smaller radius or a larger map are needed"
        )

    def draw_goal(self, goals: NDArray[np.float64], robot: int, stream: NDArray[np.uint64]) -> NDArray[np.float64]:
        """Another goal (2,) [m] for one of a team's robots, apart from everybody's goals.

        Args:
            goals: (robots, 2) of the team [m].
            robot: Its number.
            stream: (4,) random stream.

        Raises:
            TeamError: The map has no other place.
        """
        points = self._points(self._candidates)
        away = np.hypot(*(points[:, None] - goals[None]).transpose(2, 0, 1))
        apart = max(self._graph.apart, 1.0) * self.grid.resolution - 1e-6
        free = np.flatnonzero((away.min(axis=1) >= apart) & (away[:, robot] > 0.0))
        if not len(free):
            raise TeamError(
                f"map {self._plan.name!r} has {len(points)} places for goals, and none is left for robot {robot} to go "
                "on to; fewer robots, a smaller radius or a larger map are needed"
            )
        chosen: NDArray[np.float64] = points[free[int(uniform(stream) * len(free))]]
        return chosen

    def _planned(self, starts: NDArray[np.int64], goals: NDArray[np.int64], draw: int) -> bool:
        """Whether a planner finds a plan, where too little room is left for problems that need none to tell."""
        if draw < _QUICK_DRAWS:
            return False
        ends = self._graph.cells[starts], self._graph.cells[goals]
        return plan_team(self._graph, *ends, "prioritized_search", time_limit=math.inf, iterations=_ORDERS).solved

    def _points(self, places: NDArray[np.int64]) -> NDArray[np.float64]:
        return self.grid.points(self._graph.cells[places])

    def _fits(self, places: NDArray[np.int64]) -> bool:
        cells = self._graph.cells[places].astype(np.float64)
        away = np.hypot(*(cells[:, None] - cells[None]).transpose(2, 0, 1)) + 1e9 * np.eye(len(cells))
        return bool(away.min() >= max(self._graph.apart, 1.0) - 1e-9)

    def _mode(self) -> str:
        if self._options.places is not None:
            return self._options.places
        return "random" if team_places(self._plan.name) is None else "predefined"

    def _given(self) -> Ends | None:
        """Starts and goals that are the same in every episode; None where they are drawn."""
        options = self._options
        if options.starts is not None and options.goals is not None:
            return self._from_keywords(options.starts, "starts"), self._from_keywords(options.goals, "goals")
        mode = self._mode()
        if options.lifelong and mode.endswith(".scen"):
            raise ConfigError(f"goals = {options.goals!r} are drawn, but places = {mode!r} gives the robots theirs")
        if mode.endswith(".scen"):
            return self._from_scenario(mode)
        known = team_places(self._plan.name)
        if mode != "predefined":
            return None
        if known is None:
            raise ConfigError(f"map {self._plan.name!r} has no predefined places; places='random' draws some")
        if options.robots > len(known.starts):
            raise ConfigError(
                f"robots = {options.robots}, but map {self._plan.name!r} has starts for {len(known.starts)}; "
                f"at most {len(known.starts)} robots or places='random' are allowed"
            )
        if known.drawn or options.lifelong:
            return None
        return known.starts[: options.robots], known.goals[: options.robots]

    def _from_keywords(self, given: object, name: str) -> NDArray[np.float64]:
        try:
            points = np.asarray(given, np.float64)
        except (TypeError, ValueError):
            points = np.empty(0)
        if points.shape != (self._options.robots, 2) or not np.isfinite(points).all():
            raise ConfigError(
                f"{name} = {given!r} must be {self._options.robots} points x, y in metres, one for each of the robots"
            )
        return points

    def _from_scenario(self, path: str) -> Ends:
        spec = self._options.map
        file, _, options = spec.partition("?") if isinstance(spec, str) else ("", "", "")
        if not file.endswith(".map"):
            raise ScenarioError(f"scenario {path!r} needs the MovingAI .map that it belongs to, not map {spec!r}")
        free = load_movingai(file)
        scenario = load_scenario(path, free, self._options.robots, Path(file).name)
        cell = float(options.partition("=")[2] or 1.0)  # the only option of such a map, which has been loaded already
        starts, goals = (cells[:, ::-1].astype(np.float64) + 0.5 for cells in scenario)
        return starts * cell, goals * cell

    def _predefined(self) -> NDArray[np.int64]:
        known = team_places(self._plan.name)
        assert known is not None
        cells = self.grid.cells(known.starts)
        places = self._graph.index[cells[:, 0], cells[:, 1]].astype(np.int64)
        if (places < 0).any():
            x, y = known.starts[int(np.argmax(places < 0))]
            raise TeamError(
                f"a robot of radius {self._options.robot.radius} m does not fit at the place ({x:g}, {y:g}) of map "
                f"{self._plan.name!r}; a smaller radius is needed"
            )
        self._check_doors(places)
        return places

    def _check_doors(self, places: NDArray[np.int64]) -> None:
        """Refuse robots that are wider than the doors between some predefined places."""
        if (self._graph.ahead(int(places[0]))[places] >= UNREACHABLE).any():
            raise TeamError(
                f"robots of radius {self._options.robot.radius} m are wider than the doors of map {self._plan.name!r}; "
                "a smaller radius is needed"
            )

    def _anywhere(self) -> NDArray[np.int64]:
        """Places of the largest part that the robots can drive about in, on a lattice."""
        graph, left = self._graph, np.ones(len(self._graph), np.bool_)
        largest = np.empty(0, np.int64)
        while left.any():
            part = np.flatnonzero(graph.ahead(int(np.argmax(left))) < UNREACHABLE)
            left[part] = False
            largest = part if len(part) > len(largest) else largest
        on_lattice = largest[(graph.cells[largest] % _SPACING == 0).all(axis=1)]
        chosen = on_lattice if len(on_lattice) >= 4 * self._options.robots else largest
        if len(chosen) < self._options.robots:
            raise TeamError(
                f"map {self._plan.name!r} has no room for {self._options.robots} robots of radius "
                f"{self._options.robot.radius} m"
            )
        return chosen

    def _check(self, starts: NDArray[np.float64], goals: NDArray[np.float64]) -> None:
        """Refuse places that no team can have."""
        radius = self._options.robot.radius
        for kind, points in (("start", starts), ("goal", goals)):
            for robot, clearance in enumerate(self._plan.clearance(points)):
                if clearance < radius:
                    where = "is in a wall" if clearance <= 0 else f"is {clearance:.2f} m from a wall"
                    x, y = points[robot]
                    raise TeamError(
                        f"the {kind} ({x:g}, {y:g}) of robot {robot} {where} of map {self._plan.name!r}; "
                        f"a robot of radius {radius} m does not fit"
                    )
            self._check_apart(kind, points)
        self._check_reachable(starts, goals)

    def _check_apart(self, kind: str, points: NDArray[np.float64]) -> None:
        for i in range(len(points)):
            for j in range(i):
                away = math.dist(points[i], points[j])
                if away == 0.0:
                    raise TeamError(f"robots {j} and {i} share the {kind} ({points[i, 0]:g}, {points[i, 1]:g})")
                if away < 2 * self._options.robot.radius:
                    raise TeamError(
                        f"the {kind}s of robots {j} and {i} overlap: they are {away:.2f} m apart, "
                        f"their radii need {2 * self._options.robot.radius:g} m"
                    )

    def _check_reachable(self, starts: NDArray[np.float64], goals: NDArray[np.float64]) -> None:
        graph, points = (self.grid.graph(radius) for radius in (self._options.robot.radius + self._beside, 0.0))
        for robot, (start, goal) in enumerate(zip(starts, goals, strict=True)):
            if _leads(graph, self.grid, start, goal, self._strict):
                continue
            x, y = goal
            reason = "no free way connects them"
            if _leads(points, self.grid, start, goal, False):
                reason = f"with a radius of {self._options.robot.radius} m it is wider than every door on the way"
                narrow = narrowest_place(self._plan, self.grid.resolution, start, goal)
                if narrow is not None:
                    (at_x, at_y), width = narrow
                    reason += f"; the widest way is {width:.2f} m wide at ({at_x:.2f}, {at_y:.2f})"
            raise TeamError(f"robot {robot} cannot reach its goal ({x:g}, {y:g}) from its start: {reason}")


def _leads(
    graph: GridGraph, grid: FloorGrid, start: NDArray[np.float64], goal: NDArray[np.float64], strict: bool
) -> bool:
    """Whether a way leads from the place nearest to ``start`` to the one nearest to ``goal``.

    ``strict``: only where robots can stand in the very cells that planners take for the two.
    """
    if strict:
        here, there = (graph.place(cell) for cell in grid.standing([start, goal], graph))
    else:
        here, there = (_nearest(graph, grid, point) for point in (start, goal))
    return here >= 0 and there >= 0 and bool(graph.ahead(there)[here] < UNREACHABLE)


def _nearest(graph: GridGraph, grid: FloorGrid, point: NDArray[np.float64]) -> int:
    """The place nearest to a point, -1 if none is within two cells."""
    away = np.hypot(*(grid.points(graph.cells) - point).T)
    nearest = int(np.argmin(away)) if len(away) else -1
    return nearest if nearest >= 0 and away[nearest] <= 2 * grid.resolution else -1
