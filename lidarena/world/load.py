"""Floor plans from what users write in ``map=``: a name, a file, or a maze to be generated."""

import os
import warnings
from functools import lru_cache
from pathlib import Path

from lidarena.base.errors import MapError, suggest
from lidarena.world import builtin
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.map_options import read_options, read_seed
from lidarena.world.map_server import load_map, read_description
from lidarena.world.maze import generate_maze
from lidarena.world.movingai import movingai_floorplan
from lidarena.world.plan_generators import PlanGenerator, draw_plan, plan_generator

MapSpec = str | os.PathLike[str] | Floorplan | PlanGenerator
"""What ``map=`` takes, see ``load_floorplan``."""

_MAZE_OPTIONS = {
    "width": "width_m",
    "height": "height_m",
    "corridor": "corridor",
    "loops": "loops",
    "dead_ends": "dead_ends",
    "thickness": "thickness",
}
_ALLOWED = ["maze:SEED", "random:KIND", "a path to a .yaml or .map file", "module:callable of a generator"]
_Stamp = tuple[tuple[int, int], ...]


def names() -> list[str]:
    """Names of the floor plans that come with the package."""
    return builtin.names()


def load_floorplan(spec: MapSpec, start: Pose | None = None) -> Floorplan:
    """Load a floor plan; one that was loaded before is not read again unless its files have changed.

    Args:
        spec: A built-in name (see ``names``); the path of a ROS ``map_server`` ``.yaml``; the path of a MovingAI
            ``.map``, if wanted with the side of a cell in metres as in ``"den520d.map?cell=0.5"``; or
            ``"maze:SEED"``, if wanted with options as in
            ``"maze:7?width=10&height=8&corridor=1.2&loops=0.2&dead_ends=0.5&thickness=0.1"`` (see ``generate_maze``).
            A ``Floorplan`` is passed through. Of ``"random:KIND"`` (see ``random_plan``), of a generator of one's own
            (see ``PlanGenerator``) or its ``"module:callable"`` the plan with the number 0 is taken.
        start: Start pose x, y, theta instead of the plan's own [m, m, rad]. A map from a file has none of its own: it
            is the roomiest place of its largest connected part, and a warning tells if there are several parts.

    Raises:
        MapError: The plan does not exist, its file is damaged, an option is out of range, nothing in it is free, or
            the start stands in a wall.
    """
    plan = _find(spec)
    if start is not None:
        return plan.with_start(start)
    if len(plan.parts) > 1 and str(spec).endswith((".yaml", ".yml")):
        others = ", ".join(f"{area:.0f}" for area in plan.parts[1:4]) + (", …" if len(plan.parts) > 4 else "")
        warnings.warn(
            f"map {plan.name!r} has {len(plan.parts)} parts between which there is no way for a robot; the start is in "
            f"the largest, of {plan.parts[0]:.0f} m² (the others: {others} m²); give start to choose another",
            stacklevel=2,
        )
    return plan


def generator_of(spec: object) -> PlanGenerator | None:
    """Return the generator that a user's ``map=`` names; None if it is a single plan.

    Raises:
        ConfigError: A ``"module:callable"`` that there is not.
        MapError: One that cannot be called.
    """
    if isinstance(spec, str) and (spec in builtin.names() or spec.startswith("maze:")):
        return None
    return plan_generator(spec)


def _find(spec: MapSpec) -> Floorplan:
    if isinstance(spec, Floorplan):
        return spec
    generator = generator_of(spec)
    return _load(_as_text(spec)) if generator is None else draw_plan(generator, 0)


def _as_text(spec: object) -> str:
    text = os.fspath(spec) if isinstance(spec, str | os.PathLike) else None
    if not isinstance(text, str) or not text or "\0" in text:
        raise MapError(f"map {spec!r} is no name; a built-in name, a .yaml or .map file or 'maze:SEED' is needed")
    return text


def _load(spec: str) -> Floorplan:
    if spec in builtin.names():
        return _builtin(spec)
    if spec.startswith("maze:"):
        return _maze(spec)
    path, _, options = spec.partition("?")
    if path.endswith(".map"):
        cell = read_options(spec, options, ["cell"]).get("cell", 1.0)
        return _movingai(path, cell, _stamp(path))
    if spec.endswith((".yaml", ".yml")):
        return _map_server(spec, _stamp(spec, os.fspath(read_description(spec).image)))
    if spec.endswith((".pgm", ".png")):
        raise MapError(f"map {spec!r} is a picture; give the .yaml file beside it, which says how large its cells are")
    raise MapError(f"map {spec!r} is not known{suggest(spec, _ALLOWED + names())}")


@lru_cache(maxsize=32)
def _builtin(name: str) -> Floorplan:
    return builtin.builtin_floorplan(name)


@lru_cache(maxsize=256)
def _maze(spec: str) -> Floorplan:
    seed, _, options = spec.removeprefix("maze:").partition("?")
    number = read_seed(spec, seed, "maze:7")
    values = {_MAZE_OPTIONS[key]: value for key, value in read_options(spec, options, list(_MAZE_OPTIONS)).items()}
    return generate_maze(number, **values, name=spec)


@lru_cache(maxsize=32)
def _map_server(path: str, stamp: _Stamp) -> Floorplan:
    """Read a map; the stamp of its files is the cache's key."""
    grid = load_map(path)
    return Floorplan.from_grid(Path(path).stem, grid.solid, grid.resolution, grid.origin)


@lru_cache(maxsize=32)
def _movingai(path: str, cell: float, stamp: _Stamp) -> Floorplan:
    return movingai_floorplan(path, cell)


def _stamp(*paths: str) -> _Stamp:
    """When files were written and how long they are; () for what is not there, which the reader then refuses."""
    try:
        return tuple((status.st_mtime_ns, status.st_size) for status in map(os.stat, paths))
    except OSError:
        return ()
