"""A task as arrays: what kernels, compiler and policies work with."""

import hashlib
import json
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, MapError
from lidarena.envs.workshop.task_file import AGENTS, TaskConfig, middle, read_task
from lidarena.envs.workshop.walking import TICK, is_free, make_walk_grid, way_length
from lidarena.temporal import STN
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import load_floorplan

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

HUMAN, ROBOT = 0, 1
"""Numbers of the agents."""


class TaskArrays(NamedTuple):
    """A task of ``n`` actions at ``L`` locations, the two homes last among these; agents are human and robot."""

    before: NDArray[np.bool_]
    """(n, n) ``[i, j]``: i must be finished before the work at j's last location begins"""
    capable: NDArray[np.bool_]
    """(2, n) who can do it"""
    lower: Floats
    """(2, n) least time of the work [s]"""
    upper: Floats
    """(2, n) greatest time of the work [s]"""
    stops: Ints
    """(n, S) locations, -1 behind the last one"""
    stop_count: Ints
    """(n,)"""
    share: Floats
    """(n, S) of the work at each location"""
    tail: Floats
    """(n,) usual time of the work from the action's beginning to the end of all that must come after [s]"""
    field: Ints
    """(L, 2) number of the point at which each agent stands there"""
    step: Floats
    """(2,) that each walks in a tick [m]"""
    radius: Floats
    """(2,) of each body [m]"""
    home: Ints
    """(2,) location where each begins"""
    trip: Floats
    """(2, n) time to walk from its first location to its last one, alone on the floor [s]"""


class WorkshopTask:
    """A task on a floor, checked and ready.

    Args:
        config: What the file holds.
        name: What it is called.
        speed: Of the robot instead of the file's [m/s].
        radius: Of the robot instead of the file's [m].

    Attributes:
        config: As given.
        name: As given.
        actions: Names, in the order of their numbers.
        locations: Names, the homes last.
        plan: The floor.
        arrays: Everything by numbers.
        grid: The ways to all locations.
        walks: (2, L, L) time that each takes from one location to another, alone on the floor [s].
        deadline: For everything [s].

    Raises:
        ConfigError: A location that stands in a wall or cannot be reached, or constraints that contradict each other.
        MapError: A floor that cannot be used.
    """

    def __init__(
        self, config: TaskConfig, name: str = "task", speed: float | None = None, radius: float | None = None
    ) -> None:
        self.config, self.name = config, name
        self.actions = tuple(config.actions)
        self.locations = (*config.locations, *(f"{agent}'s home" for agent in AGENTS))
        self.deadline = float(config.deadline)
        robot = config.agents["robot"]
        self.speeds = (config.agents["human"].speed, speed or robot.speed)
        self.radii = (config.agents["human"].radius, radius or robot.radius)
        self.plan = _floor(config, name)
        self.arrays, points = self._numbered()
        self.grid = make_walk_grid(self.plan, points, max(self.radii))
        self._check_places()
        self.walks = self._walk_alone()
        stops = self.arrays.stops
        for k in range(stops.shape[1] - 1):
            further = stops[:, k + 1] >= 0
            self.arrays.trip[:, further] += self.walks[:, stops[further, k], stops[further, k + 1]]
        self._check_constraints()

    @property
    def title(self) -> str:
        """For pictures."""
        return self.config.title or self.name

    def _numbered(self) -> tuple[TaskArrays, Floats]:
        config, count = self.config, len(self.actions)
        numbers = {name: k for k, name in enumerate(self.locations)}
        entries = list(config.actions.values())
        most = max(len(action.at) for action in entries)
        stops, share = np.full((count, most), -1, np.int64), np.zeros((count, most))
        lower, upper = np.full((2, count), np.nan), np.full((2, count), np.nan)
        before = np.zeros((count, count), np.bool_)
        for j, action in enumerate(entries):
            length = len(action.at)
            stops[j, :length] = [numbers[place] for place in action.at]
            share[j, :length] = action.shares or [1.0 / length] * length
            for agent, (low, high) in action.duration.items():
                lower[AGENTS.index(agent), j], upper[AGENTS.index(agent), j] = low, high
            for earlier in action.after:
                before[self.actions.index(earlier), j] = True
        field, points = self._points()
        arrays = TaskArrays(
            before, np.isfinite(lower), lower, upper, stops, (stops >= 0).sum(axis=1), share,
            _tails(config, before), field, TICK * np.array(self.speeds), np.array(self.radii),
            np.array([len(self.locations) - 2, len(self.locations) - 1]), np.zeros((2, count)),
        )  # fmt: skip
        return arrays, points

    def _points(self) -> tuple[Ints, Floats]:
        """Number of each agent's point at each location (L, 2), and the points (F, 2) [m]."""
        places: list[tuple[float, float]] = []
        field = np.zeros((len(self.locations), 2), np.int64)
        homes = [self.config.agents["human"].home, self.config.agents["robot"].home]
        for number, place in enumerate([*self.config.locations.values(), *homes]):
            for k, agent in enumerate(AGENTS):
                x, y = place[agent] if isinstance(place, dict) else place  # type: ignore[index]
                if (x, y) not in places:
                    places.append((x, y))
                field[number, k] = places.index((x, y))
        return field, np.array(places, np.float64)

    def _check_places(self) -> None:
        arrays, grid = self.arrays, self.grid
        for number, name in enumerate(self.locations):
            for k, agent in enumerate(AGENTS):
                x, y = grid.points[arrays.field[number, k]].tolist()
                start = grid.points[arrays.field[arrays.home[k], k]]
                if not is_free(grid, x, y):
                    raise ConfigError(
                        f"task {self.name!r}: the location {name!r} at ({x:g}, {y:g}) leaves no room for the {agent}, "
                        f"whose radius is {self.radii[k]:g} m"
                    )
                if not np.isfinite(way_length(grid, arrays.field[number, k], start[0], start[1])):
                    raise ConfigError(
                        f"task {self.name!r}: the {agent} cannot reach the location {name!r} at ({x:g}, {y:g}) from "
                        "its home"
                    )

    def _walk_alone(self) -> Floats:
        field, points, count = self.arrays.field, self.grid.points, len(self.locations)
        walks = np.zeros((2, count, count))
        for agent, i, j in np.ndindex(2, count, count):
            x, y = points[field[i, agent]]
            walks[agent, i, j] = way_length(self.grid, field[j, agent], x, y) / self.speeds[agent]
        return walks

    def base_network(self) -> STN:
        """Precedence, least and greatest durations and constraints, whoever does what; without the deadline."""
        network = STN(["begin"], name=self.name)
        for j, name in enumerate(self.actions):
            network.add_point(f"{name}.start")
            network.add_point(f"{name}.end")
            low = float(np.nanmin(self.arrays.lower[:, j]))
            network.add_requirement("begin", f"{name}.start", 0.0)
            network.add_requirement(f"{name}.start", f"{name}.end", low)
        for i, j in np.argwhere(self.arrays.before).tolist():
            network.add_requirement(f"{self.actions[i]}.end", f"{self.actions[j]}.end", self._last_work(j))
        for constraint in self.config.constraints:
            network.add_requirement(constraint.start, constraint.end, constraint.lower, constraint.upper)
        return network

    def _last_work(self, action: int) -> float:
        """Least time of the work at an action's last location [s]."""
        last = int(self.arrays.stop_count[action]) - 1
        return float(np.nanmin(self.arrays.lower[:, action]) * self.arrays.share[action, last])

    def _check_constraints(self) -> None:
        cycle = self.base_network().negative_cycle()
        if cycle is not None:
            raise ConfigError(f"task {self.name!r}: the constraints contradict each other: {cycle}")

    @property
    def key(self) -> str:
        """Of the content, for the cache: 32 hexadecimal digits."""
        content = json.dumps(
            [self.config.model_dump(mode="json"), self.speeds, self.radii, self.plan.edges.tolist()], sort_keys=True
        )
        return hashlib.sha256(content.encode()).hexdigest()[:32]


def _floor(config: TaskConfig, name: str) -> Floorplan:
    floor = config.floor
    if floor.map is not None:
        return load_floorplan(floor.map)
    assert floor.bounds is not None
    x0, y0, x1, y1 = floor.bounds
    if not (x0 < x1 and y0 < y1):
        raise MapError(f"the floor of task {name!r} has bounds {floor.bounds}, where x_min < x_max, y_min < y_max")
    boxes = [[[a, b], [c, b], [c, d], [a, d]] for a, b, c, d in floor.boxes]
    start = (*config.agents["robot"].home, 0.0)
    walls = [[x0, y0, x1, y0], [x1, y0, x1, y1], [x1, y1, x0, y1], [x0, y1, x0, y0], *floor.walls]
    return Floorplan.from_shapes(name, (x0, y0, x1, y1), walls, boxes, start=start)  # type: ignore[arg-type]


def _tails(config: TaskConfig, before: NDArray[np.bool_]) -> Floats:
    usual = np.array([min(middle(b) for b in action.duration.values()) for action in config.actions.values()])
    tail = usual.copy()
    for _ in usual:  # as often as a chain can be long
        behind = np.where(before, tail[None, :], 0.0).max(axis=1)
        tail = usual + behind
    return tail


def load_task(spec: Any, speed: float | None = None, radius: float | None = None) -> WorkshopTask:
    """Load a task; one that was loaded before is not built again.

    Args:
        spec: See :func:`lidarena.envs.workshop.task_file.read_task`; a ``WorkshopTask`` is passed through.
        speed: Of the robot instead of the task's [m/s].
        radius: Of the robot instead of the task's [m].

    Raises:
        ConfigError: See ``read_task`` and ``WorkshopTask``.
    """
    if isinstance(spec, WorkshopTask):
        return spec
    config = read_task(spec)
    name = spec.rpartition("/")[2].removesuffix(".yaml").removesuffix(".yml") if isinstance(spec, str) else "task"
    return _built(config.model_dump_json(by_alias=True), name, speed, radius)


@lru_cache(maxsize=16)
def _built(content: str, name: str, speed: float | None, radius: float | None) -> WorkshopTask:
    return WorkshopTask(TaskConfig.model_validate_json(content), name, speed, radius)
