"""Which arena an episode takes place in: one of a list, or another of a family every time."""

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, MapError
from lidarena.envs.arena.options import ArenaOptions, ArenaSpec
from lidarena.planning.potential_field.circle_grid import astar_path
from lidarena.planning.potential_field.field_scene import make_scene
from lidarena.planning.potential_field.regression_search import path_length
from lidarena.world.arenas import Arena, ArenaGenerator, arena_generator, draw_arena, load_arena
from lidarena.world.barn import barn_indices, load_barn
from lidarena.world.floorplan import Floorplan

FIRST_DRAWN = 2**31
"""Number of the first ``"random"`` arena or U trap that episodes draw; seeds that are given lie below."""
_NEXT_TRY = 2**32
"""Added to an arena's number where A* finds no path in it."""
_LEAST_OBSTACLE = 0.5
"""Obstacles have at least this radius in a 100 m room: Yang et al.'s are points, which no lidar sees [m]."""
_LEAST_ROBOT = 0.1
"""The robot has at least this radius in a 100 m room: rigid bodies have an extent, Yang et al.'s point has none [m]."""
BARN_SPEED = 2.0
"""At which BARN drives its reference paths [m/s]."""


@dataclass(frozen=True)
class Scenario:
    """An arena as the environment has it.

    Attributes:
        arena: Circles, start, goal, bounds and robot; no circle and no robot is a point.
        plan: What robot and lidar meet.
        optimal_time: What BARN scores a drive by: its reference path at 2 m/s [s]; infinite elsewhere.
    """

    arena: Arena
    plan: Floorplan
    optimal_time: float = math.inf


@dataclass(frozen=True)
class _Entry:
    """One of the arenas or families that the keywords name; ``numbers`` are a family's, () for any.

    A generator is a family: its number says what it draws with.
    """

    spec: ArenaSpec
    family: bool
    density: float | None = None
    numbers: tuple[int, ...] = ()
    generator: ArenaGenerator | None = None


class ScenarioGenerator:
    """Draws and loads the scenarios of one environment.

    Args:
        options: Checked keywords.
        radius: Of the robot [m]; None: each arena's own.

    Attributes:
        scale: Of all arenas, see :attr:`lidarena.world.arenas.Arena.scale`.
        radius: Of the robot, where arenas' own differ the largest [m].

    Raises:
        MapError: An arena that cannot be loaded, or whose start or goal is in an obstacle.
        ConfigError: Arenas of different scales.
    """

    def __init__(self, options: ArenaOptions, radius: float | None = None) -> None:
        self._options, self._radius = options, radius
        self._entries = [entry for spec in options.specs for entry in _entries_of(spec, options)]
        arenas = [self.scenario(k, self._number(entry, 0)).arena for k, entry in enumerate(self._entries)]
        self.radius = max(arena.robot_radius for arena in arenas)
        scales = {arena.scale for arena in arenas}
        if len(scales) > 1:
            raise ConfigError(
                f"the arenas have the scales {sorted(scales)}; those of one environment must have the same, since "
                "speed and lidar go with it"
            )
        self.scale = scales.pop()

    def draw(self, rng: np.random.Generator, seed: int | None) -> tuple[int, int]:
        """Choose the arena of an episode: its entry, and its number there.

        Args:
            rng: The world's generator.
            seed: That the world was reset with, if it was.
        """
        if self._options.pick == "by_seed" and seed is not None:
            position, entry = divmod(seed, len(self._entries))
            return entry, self._number(self._entries[entry], position)
        entry = int(rng.integers(len(self._entries))) if len(self._entries) > 1 else 0
        family = self._entries[entry]
        if not family.family:
            return entry, 0
        if family.numbers:
            return entry, family.numbers[int(rng.integers(len(family.numbers)))]
        return entry, FIRST_DRAWN + int(rng.integers(self._options.arenas))

    @staticmethod
    def _number(entry: _Entry, position: int) -> int:
        if not entry.family:
            return 0
        return entry.numbers[position % len(entry.numbers)] if entry.numbers else position

    def scenario(self, entry: int, number: int) -> Scenario:
        """Load an arena; one that was loaded before is not made again.

        Raises:
            MapError: See the class.
        """
        chosen, options = self._entries[entry], self._options
        if chosen.generator is not None:
            return self._generated(chosen.generator, number)
        spec = f"{chosen.spec}:{number}" if chosen.family else chosen.spec
        text = spec if isinstance(spec, str) else ""
        path = options.path if text.startswith("barn:") else None
        ends = tuple(None if end is None else tuple(end) for end in (options.start, options.goal))
        if isinstance(spec, Arena | Floorplan):
            return _laid_out(load_arena(spec, start=ends[0], goal=ends[1]), self._radius)
        scenario = _named_scenario(text, path, chosen.density, ends, self._radius)
        if options.solvable and chosen.spec == "random" and not _has_path(scenario.arena):
            return self.scenario(entry, number + _NEXT_TRY)
        return scenario

    def _generated(self, generator: ArenaGenerator, number: int) -> Scenario:
        drawn = draw_arena(generator, number)
        scenario = _laid_out(load_arena(drawn, start=self._options.start, goal=self._options.goal), self._radius)
        if scenario.arena.scale != getattr(self, "scale", scenario.arena.scale):
            raise MapError(
                f"arena {scenario.arena.name!r} has scale {scenario.arena.scale:g}; those of one environment must all "
                f"have {self.scale:g}, since speed and lidar go with it"
            )
        if self._options.solvable and not _has_path(scenario.arena):
            return self._generated(generator, number + _NEXT_TRY)
        return scenario


def _entries_of(spec: ArenaSpec, options: ArenaOptions) -> list[_Entry]:
    if spec == "random":
        return [_Entry(spec, True, share) for share in options.densities]
    if spec == "u_trap":
        return [_Entry(spec, True)]
    if spec == "barn":
        if options.path is None:
            raise ConfigError("arena 'barn' is read from a file; give its path, as in path='barn_even_150.npz'")
        return [_Entry(spec, True, numbers=tuple(barn_indices(options.path)))]
    generator = arena_generator(spec)
    if generator is not None:
        return [_Entry(spec, True, generator=generator)]
    fixed = isinstance(spec, str) and spec.startswith("random:") and "density=" not in spec
    return [_Entry(spec, False, options.densities[0] if fixed else None)]


@lru_cache(maxsize=8192)
def _named_scenario(
    spec: str,
    path: str | None,
    density: float | None,
    ends: tuple[tuple[float, ...] | None, ...],
    radius: float | None,
) -> Scenario:
    scenario = _laid_out(load_arena(spec, path=path, density=density, start=ends[0], goal=ends[1]), radius)
    if path is None:
        return scenario
    reference = load_barn(int(spec.partition(":")[2]), path).reference
    return replace(scenario, optimal_time=path_length(reference) / BARN_SPEED)


@lru_cache(maxsize=8192)
def _path_exists(name: str, circles: bytes, ends: tuple[float, ...], bounds: tuple[float, ...], radius: float) -> bool:
    rows = np.frombuffer(circles).reshape(-1, 3)
    return len(astar_path(rows, ends[:2], ends[2:], radius, bounds)) > 0


def _has_path(arena: Arena) -> bool:
    return _path_exists(
        arena.name, arena.circles.tobytes(), (*arena.start, *arena.goal), arena.bounds, arena.robot_radius
    )


def _laid_out(arena: Arena, radius: float | None) -> Scenario:
    """Give every circle and the robot an extent, refuse ends inside of obstacles, and draw the room."""
    circles = make_scene(arena.circles, arena.start, arena.goal, bounds=arena.bounds).discs
    circles[:, 2] = np.maximum(circles[:, 2], _LEAST_OBSTACLE * arena.scale if arena.plan is None else 0.0)
    circles.flags.writeable = False
    own = max(arena.robot_radius, _LEAST_ROBOT * arena.scale)
    arena = replace(arena, circles=circles, robot_radius=own if radius is None else radius)
    make_scene(arena.circles, arena.start, arena.goal, arena.robot_radius, arena.bounds)
    heading = float(np.arctan2(arena.goal[1] - arena.start[1], arena.goal[0] - arena.start[0]))
    start = (*arena.start, heading)
    if arena.plan is not None:
        return Scenario(arena, replace(arena.plan, start=start))
    return Scenario(arena, Floorplan(arena.name, _room(arena.bounds), circles, arena.bounds, start))


def vicinity(plan: Floorplan, x: float, y: float, reach: float) -> Floorplan:
    """The part of a floor plan within ``reach`` [m] of a point."""
    x1, y1, x2, y2 = plan.edges.T
    ex, ey = x2 - x1, y2 - y1
    share = np.clip(((x - x1) * ex + (y - y1) * ey) / np.maximum(ex * ex + ey * ey, 1e-300), 0.0, 1.0)
    near = np.hypot(x1 + share * ex - x, y1 + share * ey - y) <= reach
    circles = plan.circles
    close = np.hypot(circles[:, 0] - x, circles[:, 1] - y) - circles[:, 2] <= reach
    return Floorplan(plan.name, plan.edges[near], circles[close], plan.bounds, plan.start)


def _room(bounds: tuple[float, float, float, float]) -> NDArray[np.float64]:
    """The walls of a room (4, 4) x1, y1, x2, y2 with what is solid on their left, so clockwise."""
    x0, y0, x1, y1 = bounds
    return np.array([(x0, y0, x0, y1), (x0, y1, x1, y1), (x1, y1, x1, y0), (x1, y0, x0, y0)])
