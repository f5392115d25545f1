"""Arenas: rooms with circles, a start and a goal, for reaching goals among obstacles."""

import math
import os
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lidarena.base.errors import MapError, suggest
from lidarena.world import barn
from lidarena.world.floorplan import Bounds, Floorplan
from lidarena.world.load import load_floorplan
from lidarena.world.map_options import read_options, read_seed
from lidarena.world.plan_generators import generator_name, plan_generator
from lidarena.world.random_arenas import DENSITY, random_arena_shapes, u_trap_shapes

Point = tuple[float, float]

PRINTED = ((10.0, 90.0), (40.0, 45.0), (65.0, 45.0), (74.0, 74.0))
"""The obstacles that Yang et al. print (m); the text's "…" hides the trap near (15, 15)."""
YANG_RADIUS = 0.8
"""Of these obstacles (m). Yang et al.'s are points, which no lidar sees, and a point robot slips through the trap."""
YANG_BOUNDS = (-5.0, -5.0, 95.0, 95.0)
"""The 100 m room, moved by 5 m: the printed start (0, 0) would stand in its corner."""

_FAMILIES = ("yang", "gnron", "u_trap", "random", "barn")
_SPECS = ("yang", "yang:arc", "yang:u", "gnron", "u_trap:SEED", "random:SEED", "barn:INDEX")


@dataclass(frozen=True)
class Arena:
    """A room with circles, a start and a goal.

    Attributes:
        name: What messages and pictures call it.
        circles: ``(K, 3)`` as x, y, radius [m].
        start: x, y [m].
        goal: x, y [m].
        bounds: The room, x_min, y_min, x_max, y_max [m]; its walls are obstacles.
        robot_radius: Of the robot that belongs here [m]; 0 is Yang et al.'s point.
        plan: The floor plan that it was made of, whose edges the circles cover; None for all others.
    """

    name: str
    circles: NDArray[np.float64]
    start: Point
    goal: Point
    bounds: Bounds
    robot_radius: float = 0.0
    plan: Floorplan | None = None

    @property
    def scale(self) -> float:
        """The power of ten nearest to the longer side over Yang et al.'s 100 m; floor plans are drawn at a tenth."""
        side = max(self.bounds[2] - self.bounds[0], self.bounds[3] - self.bounds[1])
        return 0.1 if self.plan is not None else 10.0 ** round(math.log10(side / 100.0))

    def floorplan(self, thickness: float = 1.0, least_radius: float = 0.0) -> Floorplan:
        """Draw the arena as a floor plan: the circles, and walls around the bounds.

        Args:
            thickness: Of the walls, which stand outside of the bounds [m].
            least_radius: Smaller circles are drawn with this radius [m]; a lidar sees no point.
        """
        x0, y0, x1, y1 = self.bounds
        a, b = -thickness / 2, thickness / 2
        walls = [
            (x0 + a, y0 + a, x1 + b, y0 + a),
            (x1 + b, y0 + a, x1 + b, y1 + b),
            (x1 + b, y1 + b, x0 + a, y1 + b),
            (x0 + a, y1 + b, x0 + a, y0 + a),
        ]
        circles = self.circles.copy()
        circles[:, 2] = np.maximum(circles[:, 2], least_radius)
        heading = float(np.arctan2(self.goal[1] - self.start[1], self.goal[0] - self.start[0]))
        outer = (x0 - thickness, y0 - thickness, x1 + thickness, y1 + thickness)
        return Floorplan.from_shapes(
            self.name, outer, walls, circles=circles, thickness=thickness, start=(*self.start, heading)
        )


ArenaGenerator = Callable[[np.random.Generator], Arena | Floorplan]
"""Draws an arena or a floor plan, with nothing random but from the generator that it is given."""


def arena_generator(spec: object) -> ArenaGenerator | None:
    """Return the generator that a user's ``arena=`` names, a callable or ``"module:callable"``; None for all else.

    Raises:
        ConfigError: There is no such module, or no such name in it.
        MapError: What is named cannot be called.
    """
    known = isinstance(spec, Arena) or (isinstance(spec, str) and spec.partition(":")[0] in (*_FAMILIES, "maze"))
    return None if known else plan_generator(spec)


def draw_arena(generator: ArenaGenerator, number: int) -> Arena | Floorplan:
    """Draw the arena of a number, always the same one.

    Raises:
        MapError: What is drawn is neither an arena nor a floor plan.
    """
    drawn = generator(np.random.default_rng(number))
    if not isinstance(drawn, Arena | Floorplan):
        raise MapError(
            f"arena generator {generator_name(generator)!r} returned an object of type "
            f"{type(drawn).__name__}; an Arena or a Floorplan is needed"
        )
    return drawn


def load_arena(
    spec: str | Arena | Floorplan,
    *,
    path: str | os.PathLike[str] | None = None,
    density: float | None = None,
    start: ArrayLike | None = None,
    goal: ArrayLike | None = None,
) -> Arena:
    """Load an arena.

    Args:
        spec: ``"yang"`` (Fig. 8's printed obstacles), ``"yang:arc"``, ``"yang:u"`` (with a trap at (12, 12)),
            ``"gnron"`` (Fig. 1), ``"u_trap:SEED"``, ``"random:SEED"`` or ``"random:SEED?density=0.2"``,
            ``"barn:INDEX"``, any floor plan that :func:`lidarena.world.load.load_floorplan` takes, or an arena.
        path: The BARN file, for ``"barn:INDEX"``.
        density: Share of the room that circles cover, for ``"random:SEED"``.
        start: x, y instead of the arena's own [m].
        goal: x, y instead of the arena's own [m]; a floor plan has none and needs it.

    Raises:
        MapError: The arena does not exist, its file is torn or lacks it, or a value is out of range.
    """
    arena = _find(spec, path, density, goal)
    ends = {name: _point(name, value) for name, value in (("start", start), ("goal", goal)) if value is not None}
    return replace(arena, **ends)  # type: ignore[arg-type]


def _find(
    spec: str | Arena | Floorplan,
    path: str | os.PathLike[str] | None,
    density: float | None,
    goal: ArrayLike | None,
) -> Arena:
    if isinstance(spec, Arena):
        return spec
    text = spec if isinstance(spec, str) else ""
    family, colon, rest = text.partition(":")
    if density is not None and not text.startswith("random:"):
        raise MapError(f"arena {text!r} has no density; only 'random:SEED' has one")
    if path is not None and not text.startswith("barn:"):
        raise MapError(f"arena {text!r} is not read from a file; only 'barn:INDEX' is")
    if text in ("yang", "yang:arc", "yang:u"):
        return _yang(rest)
    if text == "gnron":
        return Arena(text, np.array([[0.5, 0.0, 0.0]]), (-4.0, 0.0), (0.0, 0.0), (-5.0, -5.0, 5.0, 5.0))
    if family == "u_trap" and colon:
        circles, begin, end, bounds, radius = u_trap_shapes(read_seed(text, rest, "u_trap:7"))
        return Arena(text, circles, begin, end, bounds, radius)
    if family == "random" and colon:
        return _random(text, rest, density)
    if family == "barn" and colon:
        return _barn(text, rest, path)
    if family in _FAMILIES:
        raise MapError(f"arena {text!r} is not known{suggest(text, _SPECS)}")
    return _from_floorplan(spec, goal)


def _yang(variant: str) -> Arena:
    points = [np.array(PRINTED)]
    if variant:
        degrees, count = (120.0, 9) if variant == "arc" else (200.0, 15)
        angles = np.radians(45.0 + np.linspace(-degrees / 2, degrees / 2, count))
        points.append(12.0 + 6.0 * np.column_stack([np.cos(angles), np.sin(angles)]))
    centres = np.vstack(points)
    circles = np.column_stack([centres, np.full(len(centres), YANG_RADIUS)])
    return Arena(f"yang:{variant}" if variant else "yang", circles, (0.0, 0.0), (70.0, 70.0), YANG_BOUNDS)


def _random(spec: str, rest: str, density: float | None) -> Arena:
    number, _, options = rest.partition("?")
    given = read_options(spec, options, ["density"])
    if density is not None and given:
        raise MapError(f"arena {spec!r} gives its density twice; once is allowed")
    share = given.get("density", DENSITY) if density is None else float(density)
    circles, begin, end, bounds, radius = random_arena_shapes(read_seed(spec, number, "random:7"), share)
    return Arena(spec, circles, begin, end, bounds, radius)


def _barn(spec: str, number: str, path: str | os.PathLike[str] | None) -> Arena:
    if path is None:
        raise MapError(f"arena {spec!r} is read from a file; give its path, as in path='barn_even_150.npz'")
    world = barn.load_barn(read_seed(spec, number, "barn:0"), path)
    return Arena(spec, world.circles, barn.START, barn.GOAL, barn.BOUNDS, barn.ROBOT_RADIUS)


def _from_floorplan(spec: str | Floorplan, goal: ArrayLike | None) -> Arena:
    try:
        plan = load_floorplan(spec)
    except MapError as error:
        if isinstance(spec, str) and " is not known" in str(error):
            raise MapError(f"arena {spec!r} is not known{suggest(spec, [*_SPECS, 'any floor plan'])}") from error
        raise
    if goal is None:
        raise MapError(f"floor plan {plan.name!r} has no goal of its own; give goal=(x, y) in metres")
    circles = np.vstack([plan.circles, edge_circles(plan)])
    return Arena(plan.name, circles, plan.start[:2], _point("goal", goal), plan.bounds, 0.1, plan)


def edge_circles(plan: Floorplan, radius: float = 0.05) -> NDArray[np.float64]:
    """Cover the edges of a floor plan with overlapping circles, for planners that know circles only.

    Args:
        plan: The floor plan.
        radius: Of the circles [m]; nothing passes between them, and they stand out by as much.

    Returns:
        ``(K, 3)`` as x, y, radius [m].
    """
    rows = [np.empty((0, 3))]
    for x1, y1, x2, y2 in plan.edges:
        count = int(np.ceil(np.hypot(x2 - x1, y2 - y1) / radius)) + 1
        rows.append(np.column_stack([np.linspace(x1, x2, count), np.linspace(y1, y2, count), np.full(count, radius)]))
    return np.vstack(rows)


def _point(name: str, value: ArrayLike) -> Point:
    try:
        x, y = (float(v) for v in np.asarray(value, dtype=np.float64))
    except (TypeError, ValueError):
        x = y = np.nan
    if not np.isfinite([x, y]).all():
        raise MapError(f"{name} is {value!r}; finite x, y in metres are needed")
    return (x, y)
