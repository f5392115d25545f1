"""The floor plans that come with the package, by name."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from lidarena.world.drawings import env1, env2, env3, env4
from lidarena.world.floorplan import Floorplan, Pose
from lidarena.world.map_server import load_map
from lidarena.world.team_drawings import blocked, office, passing, unstructured

MAPS = Path(__file__).parent / "maps"
"""Where the shipped ``map_server`` files lie; ``LICENSES.md`` beside them says where each is from."""


class _Shipped(NamedTuple):
    file: str
    start: Pose


_DRAWN: dict[str, Callable[[], Floorplan]] = {
    "env1": env1,
    "env2": env2,
    "env3": env3,
    "env4": env4,
    "office": office,
    "unstructured": unstructured,
    "passing": passing,
    "blocked": blocked,
}
_SHIPPED = {
    "turtlebot3_world": _Shipped("turtlebot3_world.yaml", (-2.0, -0.5, 0.0)),
    "aws_small_house": _Shipped("aws_small_house.yaml", (3.5, 1.0, 0.0)),
    "willow": _Shipped("willow.yaml", (17.5, 19.0, 0.0)),
    "willow_lobby": _Shipped("willow_lobby.yaml", (17.5, 19.0, 0.0)),
}


def names() -> list[str]:
    """Names of the floor plans that come with the package."""
    return [*_DRAWN, *_SHIPPED]


def builtin_floorplan(name: str) -> Floorplan:
    """Return a floor plan that comes with the package.

    ``env1`` … ``env4`` are drawn (see ``drawings``), so are ``office``, ``unstructured``, ``passing`` and ``blocked``
    for teams (see ``team_drawings``). The others were mapped by robots: ``turtlebot3_world`` and
    ``aws_small_house`` in simulation, ``willow`` in the building of Willow Garage; ``willow_lobby`` is a part of it,
    14.0 m wide and 13.5 m high, around a meeting room between a lobby and a corridor.

    Raises:
        KeyError: There is no such name.
    """
    if name in _DRAWN:
        return _DRAWN[name]()
    shipped = _SHIPPED[name]
    grid = load_map(MAPS / shipped.file)
    return Floorplan.from_grid(name, grid.solid, grid.resolution, grid.origin, shipped.start)
