"""Floor plans drawn afresh: mazes, rooms, furnished rooms, caves, warehouses, and a mixture of them."""

from collections.abc import Callable, Mapping
from functools import lru_cache

import numpy as np

from lidarena.base.errors import MapError, suggest
from lidarena.world.floorplan import Floorplan
from lidarena.world.map_options import read_options
from lidarena.world.random_plans import cave, furniture, mazes, rooms, warehouse
from lidarena.world.random_plans.options import COMMON, checked_options, largest_sides, tightest_sizes

__all__ = ["KINDS", "MIXED", "RandomPlans", "options_of", "random_plan", "random_plans"]

Draw = Callable[[np.random.Generator, Mapping[str, float], str], Floorplan]
KINDS: dict[str, tuple[Draw, Mapping[str, tuple[float, float]]]] = {
    "maze": (mazes.random_maze, mazes.OPTIONS),
    "rooms": (rooms.random_rooms, rooms.OPTIONS),
    "furnished": (furniture.random_furnished, furniture.OPTIONS),
    "cave": (cave.random_cave, cave.OPTIONS),
    "warehouse": (warehouse.random_warehouse, warehouse.OPTIONS),
}
"""How each kind is drawn, and its own options with their ranges."""
MIXED = "mixed"
"""The kind that draws one of the others."""


def options_of(kind: str) -> dict[str, tuple[float, float]]:
    """Return the options of a kind with their ranges.

    Raises:
        MapError: There is no such kind.
    """
    if kind == MIXED:
        return dict(COMMON)
    if kind not in KINDS:
        raise MapError(f"there is no kind of random plans {kind!r}{suggest(kind, [*KINDS, MIXED])}")
    return COMMON | dict(KINDS[kind][1])


def random_plan(kind: str, rng: np.random.Generator, **options: float) -> Floorplan:
    """Draw a floor plan; the same state of the generator gives the same plan.

    Every place that is wide enough for a robot of 0.12 m radius can be reached from every other.

    Args:
        kind: One of ``KINDS``, or ``"mixed"``.
        rng: What everything is drawn from.
        **options: ``width`` and ``height`` [m], or ``area``, or ``area_min`` and ``area_max`` [m²] (30 to 120), and
            the kind's own: see ``options_of``.

    Raises:
        MapError: There is no such kind or option, one is out of range, or nothing fits into the size.
    """
    options_of(kind)
    if kind == MIXED:
        checked_options(kind, options, {})
        kind = tuple(KINDS)[int(rng.integers(len(KINDS)))]
    draw, own = KINDS[kind]
    return draw(rng, checked_options(kind, options, own), f"random:{kind}")


class RandomPlans:
    """Draws a plan of a kind for every episode: what ``map="random:KIND"`` stands for.

    Args:
        kind: One of ``KINDS``, or ``"mixed"``.
        options: As in ``random_plan``.

    Attributes:
        size: Width and height of the largest plan that may be drawn [m].

    Raises:
        MapError: There is no such kind or option, one is out of range, or nothing fits into the smallest plans.
    """

    def __init__(self, kind: str, options: Mapping[str, float]) -> None:
        options_of(kind)
        own = {} if kind == MIXED else KINDS[kind][1]
        self.kind, self.options = kind, checked_options(kind, options, own)
        self.size = largest_sides(self.options)
        self.__name__ = f"random:{kind}"
        self._try_tightest()

    def _try_tightest(self) -> None:
        """Draw plans of the sizes into which the least fits: better refused now than in the middle of a training."""
        chosen = {name: value for name, value in self.options.items() if name not in COMMON}
        for width, height in tightest_sizes(self.options):
            for kind in KINDS if self.kind == MIXED else (self.kind,):
                draw, _ = KINDS[kind]
                draw(np.random.default_rng(0), chosen | {"width": width, "height": height}, self.__name__)

    def __call__(self, rng: np.random.Generator) -> Floorplan:
        """Draw a plan."""
        return random_plan(self.kind, rng, **self.options)


@lru_cache(maxsize=64)
def random_plans(spec: str) -> RandomPlans:
    """Return what draws the plans of a spec such as ``"random:rooms"`` or ``"random:maze?area_max=60&loops=0.2"``.

    Raises:
        MapError: There is no such kind or option, one is out of range, or nothing fits into the smallest plans.
    """
    kind, _, text = spec.removeprefix("random:").partition("?")
    return RandomPlans(kind, read_options(spec, text, list(options_of(kind))))
