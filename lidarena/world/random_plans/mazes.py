"""Random mazes: the generated mazes, with everything about them drawn."""

from collections.abc import Mapping

import numpy as np

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan
from lidarena.world.maze import MAX_CORRIDOR, MAX_THICKNESS, MIN_CORRIDOR, MIN_THICKNESS, generate_maze
from lidarena.world.random_plans.options import draw_size

OPTIONS = {
    "corridor": (MIN_CORRIDOR, MAX_CORRIDOR),
    "loops": (0.0, 1.0),
    "dead_ends": (0.0, 1.0),
    "thickness": (MIN_THICKNESS, MAX_THICKNESS),
}
"""As in ``generate_maze``; what is not given is drawn."""


def random_maze(rng: np.random.Generator, options: Mapping[str, float], name: str) -> Floorplan:
    """Draw a maze with corridors of 0.9 to 1.6 m, up to a third of its inner walls open, any share of dead ends.

    Raises:
        MapError: Fewer than two corridors fit in either direction.
    """
    width, height = draw_size(rng, options)
    corridor = options.get("corridor", min(float(rng.uniform(0.9, 1.6)), 0.5 * (min(width, height) - 0.35)))
    loops = options.get("loops", float(rng.uniform(0.0, 0.33)))
    dead_ends = options.get("dead_ends", float(rng.uniform(0.0, 1.0)))
    thickness = options.get("thickness", 0.1)
    try:
        return generate_maze(int(rng.integers(2**62)), width, height, corridor, loops, dead_ends, thickness, name=name)
    except MapError as error:
        raise MapError(f"map {name!r} cannot be drawn: {error}") from None
